/* SPDX-License-Identifier: BSD-3-Clause */
/* The separable window of SSIM and its adjoint (L3): columns first, into `row`, then along the row.
 */
#include "kernel/scalar/scalar.h"

enum { TAPS = PTIE_SSIM_WINDOW, MARGIN = PTIE_SSIM_WINDOW - 1 };

/* out[x] = sum of taps over row[x .. x + 10] */
static void along_row(float *out, const float *row, int32_t width, const float *taps) {
    for (int32_t x = 0; x < width; x++) {
        out[x] = 0;
        for (int k = 0; k < TAPS; k++) out[x] += taps[k] * row[x + k];
    }
}

void ptie_window_scalar(float *out, const float *in, int32_t width, int32_t height,
                        const float *taps, float *row) {
    for (int32_t y = 0; y < height - MARGIN; y++) {
        for (int32_t x = 0; x < width; x++) {
            row[x] = 0;
            for (int k = 0; k < TAPS; k++) row[x] += taps[k] * in[(ptrdiff_t)(y + k) * width + x];
        }
        along_row(out + (ptrdiff_t)y * (width - MARGIN), row, width - MARGIN, taps);
    }
}

void ptie_window_adjoint_scalar(float *out, const float *in, int32_t width, int32_t height,
                                const float *taps, float *row) {
    const int32_t in_width = width - MARGIN, in_height = height - MARGIN;
    for (int32_t x = 0; x < MARGIN; x++) row[x] = row[MARGIN + in_width + x] = 0;
    for (int32_t y = 0; y < height; y++) {
        for (int32_t x = 0; x < in_width; x++) {
            row[MARGIN + x] = 0;
            for (int k = 0; k < TAPS; k++)
                if (y - k >= 0 && y - k < in_height)
                    row[MARGIN + x] += taps[k] * in[(ptrdiff_t)(y - k) * in_width + x];
        }
        along_row(out + (ptrdiff_t)y * width, row, width, taps);
    }
}
