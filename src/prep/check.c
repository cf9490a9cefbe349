/* SPDX-License-Identifier: BSD-3-Clause */
/* What a recording can be asked before it is trusted.  docs/math.md (P13), (P14). */
#include <math.h>

#include <ptie/preprocess.h>

#include "base/clones.h"

double ptie_chi(double wavelength_m, double defocus_m, double period_m) {
    return 3.14159265358979323846 * wavelength_m * fabs(defocus_m) / (period_m * period_m);
}

double ptie_mosaic_imbalance(const float *image, int32_t width_px, int32_t height_px) {
    double off = 0, all = 0;
    for (int32_t y = 0; y + 1 < height_px; y += 2) {
        const float *top = image + (ptrdiff_t)y * width_px, *bottom = top + width_px;
        for (int32_t x = 0; x + 1 < width_px; x += 2) {
            const double a = (double)top[x] + (double)bottom[x + 1],
                         b = (double)top[x + 1] + (double)bottom[x];
            off += fabs(a - b);
            all += a + b;
        }
    }
    return off / all;
}

double ptie_plane_spread(const float *const *plane, int32_t count, const uint8_t *mask,
                         size_t pixels) {
    double low = (double)INFINITY, high = -low, sum = 0;
    for (int32_t i = 0; i < count; i++) {
        const double mean = ptie_masked_mean(plane[i], mask, pixels);
        low = fmin(low, mean), high = fmax(high, mean), sum += mean;
    }
    return (high - low) / (sum / count);
}

PTIE_CLONES size_t ptie_count_saturated(const float *image, size_t pixels, double level) {
    const float limit = (float)level;
    size_t count = 0;
    for (size_t i = 0; i < pixels; i++) count += image[i] >= limit;
    return count;
}

ptie_trend ptie_trend_of(const double *values, size_t count) {
    const double n = (double)count, middle = (n - 1) / 2,
                 spread = n * (n * n - 1) / 12; /* sum (i - middle)^2 */
    double sum = 0, slope = 0, squares = 0;
    for (size_t i = 0; i < count; i++) sum += values[i], slope += ((double)i - middle) * values[i];
    slope /= spread;
    for (size_t i = 0; i < count; i++) {
        const double rest = values[i] - sum / n - slope * ((double)i - middle);
        squares += rest * rest;
    }
    return (ptie_trend){slope, sqrt(squares / (n - 2) / spread), sqrt(squares / n)};
}
