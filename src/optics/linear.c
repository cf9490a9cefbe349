/* SPDX-License-Identifier: BSD-3-Clause */
/* Linear TIE: dI/dz = -(lambda / 2 pi) lap(phi) for unit intensity.  docs/math.md (M1)-(M3). */
#include <string.h>

#include "optics/plan.h"

#define TWO_PI 6.283185307179586476925

double ptie_linear_response(double k2, const void *context) {
    const ptie_optics_params *p = &((const ptie_optics *)context)->params;
    return p->wavelength_m * p->defocus_m / TWO_PI * k2; /* the symbol of the Laplacian is -k^2 */
}

void ptie_linear_signal_spectral(const ptie_optics *optics, const float *phase_rad,
                                 const ptie_optics_work *work) {
    memcpy(work->image, phase_rad, ptie_fft_image_floats(optics->fft) * sizeof *phase_rad);
    ptie_fft_forward(optics->fft, work->spectrum, work->image);
    ptie_fft_filter_apply(optics->fft, work->spectrum, optics->signal);
    ptie_fft_inverse(optics->fft, work->image, work->spectrum);
}

/* Index of the neighbour beyond either end.  The mirror of DCT-II lies half a pixel outside: the
   pixel beyond the edge equals the edge. */
static int32_t neighbour(int32_t i, int32_t n, ptie_boundary boundary) {
    if (boundary == PTIE_PERIODIC) return (i + n) % n;
    return i < 0 ? 0 : i >= n ? n - 1 : i;
}

/* 5-point sum over one row, in double because it is a difference of nearly equal numbers. */
static void stencil_row(float *signal, const float *above, const float *row, const float *below,
                        int32_t width, ptie_boundary boundary, double scale) {
    for (int32_t x = 0; x < width; x++) {
        const int32_t left = neighbour(x - 1, width, boundary);
        const int32_t right = neighbour(x + 1, width, boundary);
        const double sum =
            (double)above[x] + (double)below[x] + (double)row[left] + (double)row[right];
        signal[x] = (float)(scale * (sum - 4 * (double)row[x]));
    }
}

void ptie_linear_signal_stencil(const ptie_optics *optics, const float *phase_rad,
                                const ptie_optics_work *work) {
    const ptie_optics_params *p = &optics->params;
    const int32_t w = p->width_px, h = p->height_px;
    const double scale = -p->wavelength_m * p->defocus_m / (TWO_PI * p->pixel_m * p->pixel_m);
    for (int32_t y = 0; y < h; y++) {
        const ptrdiff_t above = neighbour(y - 1, h, p->boundary);
        const ptrdiff_t below = neighbour(y + 1, h, p->boundary);
        stencil_row(work->image + (ptrdiff_t)y * w, phase_rad + above * w,
                    phase_rad + (ptrdiff_t)y * w, phase_rad + below * w, w, p->boundary, scale);
    }
}
