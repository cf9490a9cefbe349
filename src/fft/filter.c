/* SPDX-License-Identifier: BSD-3-Clause */
/* Isotropic filters on a spectrum. */
#include "base/clones.h"
#include "fft/plan.h"

size_t ptie_fft_filter_floats(const ptie_fft *fft) {
    return (size_t)ptie_fft_columns(fft) * (size_t)fft->height;
}

void ptie_fft_filter_fill(const ptie_fft *fft, float *filter, double pixel_m,
                          double (*response)(double k2, const void *context), const void *context) {
    const int32_t columns = ptie_fft_columns(fft);
    for (int32_t y = 0; y < fft->height; y++) {
        const double ky = ptie_fft_wavenumber(fft, 1, y, pixel_m);
        for (int32_t x = 0; x < columns; x++) {
            const double kx = ptie_fft_wavenumber(fft, 0, x, pixel_m);
            *filter++ = (float)response(kx * kx + ky * ky, context);
        }
    }
}

PTIE_CLONES void ptie_fft_filter_to(const ptie_fft *fft, float *out, const float *spectrum, const float *filter) {
    const size_t entries = ptie_fft_filter_floats(fft);
    if (ptie_fft_entry_floats(fft) == 1) {
        for (size_t i = 0; i < entries; i++) out[i] = spectrum[i] * filter[i];
        return;
    }
    for (size_t i = 0; i < entries; i++) {
        out[2 * i] = spectrum[2 * i] * filter[i];
        out[2 * i + 1] = spectrum[2 * i + 1] * filter[i];
    }
}

void ptie_fft_filter_apply(const ptie_fft *fft, float *spectrum, const float *filter) {
    ptie_fft_filter_to(fft, spectrum, spectrum, filter);
}

/* A half spectrum leaves out the conjugate of every column but the first and, for an even width,
   the last. */
int32_t ptie_fft_multiplicity(const ptie_fft *fft, int32_t column) {
    if (fft->kind != PTIE_FFT_REAL) return 1;
    return column == 0 || 2 * column == fft->width ? 1 : 2;
}

double ptie_fft_filter_power(const ptie_fft *fft, const float *filter) {
    const int32_t columns = ptie_fft_columns(fft);
    double sum = 0;
    for (int32_t y = 0; y < fft->height; y++)
        for (int32_t x = 0; x < columns; x++, filter++)
            sum += ptie_fft_multiplicity(fft, x) * (double)*filter * (double)*filter;
    return sum / ((double)fft->width * fft->height);
}

double ptie_fft_share(const ptie_fft *fft, int32_t column, int32_t row) {
    const double pixels = (double)fft->width * fft->height;
    if (fft->kind != PTIE_FFT_MIRROR) return ptie_fft_multiplicity(fft, column) / pixels;
    return 1 / (pixels * (column == 0 ? 4 : 2) * (row == 0 ? 4 : 2)); /* sum of (2 cos)^2: 4 n or 2 n */
}
