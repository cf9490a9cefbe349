/* SPDX-License-Identifier: BSD-3-Clause */
#include "report/spectrum.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

ptie_status ptie_spectrum_create(ptie_spectrum *s, int32_t width_px, int32_t height_px, double pixel_m) {
    *s = (ptie_spectrum){.pixel_m = pixel_m, .width_px = width_px, .height_px = height_px};
    s->bins = (width_px < height_px ? width_px : height_px) / 2; /* two modes wide */
    const size_t pixels = (size_t)width_px * (size_t)height_px;
    PTIE_TRY(ptie_fft_create(&s->fft, PTIE_FFT_MIRROR, width_px, height_px));
    PTIE_TRY(ptie_alloc_status(&s->image, pixels, sizeof(float), "spectrum"));
    PTIE_TRY(ptie_alloc_status(&s->modes, ptie_fft_spectrum_floats(s->fft), sizeof(float), "spectrum"));
    PTIE_TRY(ptie_alloc_status(&s->sum, (size_t)s->bins, sizeof(double), "spectrum"));
    return ptie_alloc_status(&s->modes_in, (size_t)s->bins, sizeof(double), "spectrum");
}

void ptie_spectrum_free(ptie_spectrum *s) {
    ptie_fft_free(s->fft);
    ptie_free(s->image);
    ptie_free(s->modes);
    ptie_free(s->sum);
    ptie_free(s->modes_in);
    *s = (ptie_spectrum){0};
}

/* Up to the largest frequency along an axis. */
static double bin_width(const ptie_spectrum *s) {
    return M_PI / s->pixel_m / s->bins;
}

void ptie_spectrum_add(ptie_spectrum *s, const float *map) {
    memcpy(s->image, map, (size_t)s->width_px * (size_t)s->height_px * sizeof *map);
    ptie_fft_forward(s->fft, s->modes, s->image);
    for (int32_t y = 0; y < s->height_px; y++)
        for (int32_t x = 0; x < s->width_px; x++) {
            const double q = hypot(ptie_fft_wavenumber(s->fft, 0, x, s->pixel_m),
                                   ptie_fft_wavenumber(s->fft, 1, y, s->pixel_m));
            const int32_t bin = (int32_t)(q / bin_width(s));
            if (bin >= s->bins || (x == 0 && y == 0)) continue;
            const double mode = (double)s->modes[(ptrdiff_t)y * s->width_px + x];
            s->sum[bin] += mode * mode * ptie_fft_share(s->fft, x, y);
            if (s->maps == 0) s->modes_in[bin]++;
        }
    s->maps++;
}

double ptie_spectrum_q(const ptie_spectrum *s, int32_t bin) {
    return (bin + 0.5) * bin_width(s);
}

/* A mode's variance is its share of the sum of squares over the number of pixels; it stands for the four quadrants of
   (pi / (n p))^2, so the density is that times n^2 p^2. */
double ptie_spectrum_density(const ptie_spectrum *s, int32_t bin) {
    return s->sum[bin] / (s->maps * s->modes_in[bin]) * s->pixel_m * s->pixel_m;
}
