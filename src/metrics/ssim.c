/* SPDX-License-Identifier: BSD-3-Clause */
/* Structural similarity (Wang et al. 2004) with the 11 x 11 Gaussian window, sigma 1.5, over
   windows that lie inside the image.  docs/math.md (Q3). */
#include <math.h>

#include "base/memory.h"
#include "metrics/metrics.h"

enum {
    TAPS = 11,
    MOMENTS = 5 /* a, b, a^2, b^2, ab */
};

static void gaussian(double weights[TAPS]) {
    double sum = 0;
    for (int i = 0; i < TAPS; i++) {
        const double t = (i - TAPS / 2) / 1.5;
        sum += weights[i] = exp(-t * t / 2);
    }
    for (int i = 0; i < TAPS; i++) weights[i] /= sum;
}

/* Horizontally weighted moments of one row; moments: (MOMENTS, columns). */
static void filter_row(double *moments, const float *a, const float *b, size_t columns,
                       const double weights[TAPS]) {
    for (size_t x = 0; x < columns; x++) {
        double sum[MOMENTS] = {0};
        for (int i = 0; i < TAPS; i++) {
            const double u = (double)a[x + (size_t)i], v = (double)b[x + (size_t)i];
            const double product[MOMENTS] = {u, v, u * u, v * v, u * v};
            for (int m = 0; m < MOMENTS; m++) sum[m] += weights[i] * product[m];
        }
        for (int m = 0; m < MOMENTS; m++) moments[(size_t)m * columns + x] = sum[m];
    }
}

static double similarity(const double m[MOMENTS], double range) {
    const double c1 = 0.01 * range * 0.01 * range, c2 = 0.03 * range * 0.03 * range;
    const double var_a = m[2] - m[0] * m[0], var_b = m[3] - m[1] * m[1], cov = m[4] - m[0] * m[1];
    return (2 * m[0] * m[1] + c1) * (2 * cov + c2) /
           ((m[0] * m[0] + m[1] * m[1] + c1) * (var_a + var_b + c2));
}

/* Sum over one row of windows; ring: (TAPS, MOMENTS, columns), the topmost row in slot `top`. */
static double sum_row(const double *ring, int32_t top, size_t columns, const double weights[TAPS],
                      double range) {
    double row = 0;
    for (size_t x = 0; x < columns; x++) {
        double sum[MOMENTS] = {0};
        for (int i = 0; i < TAPS; i++) {
            const double *slot = ring + (size_t)((top + i) % TAPS) * MOMENTS * columns;
            for (int m = 0; m < MOMENTS; m++) sum[m] += weights[i] * slot[(size_t)m * columns + x];
        }
        row += similarity(sum, range);
    }
    return row;
}

ptie_status ptie_metrics_ssim(double *out, const float *a, const float *b, int32_t width,
                              int32_t height, double range) {
    *out = (double)NAN;
    if (width < TAPS || height < TAPS) return PTIE_OK;
    const size_t columns = (size_t)width - TAPS + 1, row_moments = MOMENTS * columns;
    double *ring, weights[TAPS], sum = 0;
    PTIE_TRY(ptie_alloc_status(&ring, TAPS * row_moments, sizeof *ring, "ssim"));
    gaussian(weights);
    for (int32_t y = 0; y < height; y++) {
        const size_t row = (size_t)y * (size_t)width;
        filter_row(ring + (size_t)(y % TAPS) * row_moments, a + row, b + row, columns, weights);
        if (y >= TAPS - 1) sum += sum_row(ring, (y + 1) % TAPS, columns, weights, range);
    }
    ptie_free(ring);
    *out = sum / ((double)columns * (height - TAPS + 1));
    return PTIE_OK;
}
