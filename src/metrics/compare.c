/* SPDX-License-Identifier: BSD-3-Clause */
/* An estimate against the truth, pixel by pixel.  docs/math.md (Q1), (Q2), (Q8), (Q10), (Q11). */
#include <math.h>

#include "base/image.h"
#include "metrics/metrics.h"

static double mean(const float *values, size_t count) {
    double sum = 0;
    for (size_t i = 0; i < count; i++) sum += (double)values[i];
    return sum / (double)count;
}

/* Centred sums of two images; 0 / 0 = NaN where one is constant. */
typedef struct moments {
    double aa, bb, ab;
} moments;

static moments centred(const float *a, const float *b, size_t count) {
    const double mean_a = mean(a, count), mean_b = mean(b, count);
    moments m = {0};
    for (size_t i = 0; i < count; i++) {
        const double u = (double)a[i] - mean_a, v = (double)b[i] - mean_b;
        m.aa += u * u, m.bb += v * v, m.ab += u * v;
    }
    return m;
}

ptie_status ptie_metrics_compare(ptie_comparison *out, const float *estimate, const float *truth,
                                 int32_t width, int32_t height, double range) {
    PTIE_TRY(ptie_image_finite(estimate, width, height, "estimate"));
    PTIE_TRY(ptie_image_finite(truth, width, height, "truth"));
    double ssim;
    PTIE_TRY(ptie_metrics_ssim(&ssim, estimate, truth, width, height, range));
    const size_t count = (size_t)width * (size_t)height;
    double absolute = 0, squares = 0;
    for (size_t i = 0; i < count; i++) {
        const double d = (double)estimate[i] - (double)truth[i];
        absolute += fabs(d), squares += d * d;
    }
    const double mse = squares / (double)count;
    const moments m = centred(estimate, truth, count);
    *out = (ptie_comparison){
        .psnr_db = 10 * log10(range * range / mse),
        .mae = absolute / (double)count,
        .rmse = sqrt(mse),
        .ssim = ssim,
        .correlation = m.ab / sqrt(m.aa * m.bb),
        .signal_kept = m.ab / m.bb,
    };
    return PTIE_OK;
}

ptie_status ptie_metrics_residual(double *out, const float *reprojected, const float *measured,
                                  int32_t width, int32_t height) {
    PTIE_TRY(ptie_image_finite(reprojected, width, height, "reprojected"));
    PTIE_TRY(ptie_image_finite(measured, width, height, "measured"));
    const size_t count = (size_t)width * (size_t)height;
    const double mean_r = mean(reprojected, count), mean_m = mean(measured, count);
    double off = 0, all = 0;
    for (size_t i = 0; i < count; i++) {
        const double m = (double)measured[i] - mean_m, d = (double)reprojected[i] - mean_r - m;
        off += d * d, all += m * m;
    }
    *out = all > 0 ? sqrt(off / all) : (double)NAN;
    return PTIE_OK;
}
