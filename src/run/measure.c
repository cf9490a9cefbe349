/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/measure.h"

#include <math.h>

#include "base/clones.h"
#include "base/image.h"
#include "metrics/metrics.h"

static const char *const maps[] = {"phase", "denoised", "truth"};
static const char *const metrics[] = {"mgm", "sbr", "bns", "cnr", "rmse_rad", "correlation", "signal_kept", "residual"};
static const char *const numbers[] = {"noise_rad", "saturated", "imbalance", "brightness", "background_rad"};

ptie_row_name ptie_run_row_name(int which) {
    if (which >= PTIE_ROW_OF_FRAME) return (ptie_row_name){"frame", numbers[which - PTIE_ROW_OF_FRAME]};
    return (ptie_row_name){maps[which / PTIE_RUN_METRICS], metrics[which % PTIE_RUN_METRICS]};
}

bool ptie_run_row_has(int which, bool denoised, bool truth) {
    if (which >= PTIE_ROW_OF_FRAME) return true;
    const int map = which / PTIE_RUN_METRICS, metric = which % PTIE_RUN_METRICS;
    const bool compared = metric == PTIE_RMSE_RAD || metric == PTIE_CORRELATION || metric == PTIE_SIGNAL_KEPT;
    if (compared && (map == PTIE_OF_TRUTH || !truth)) return false;
    return map == PTIE_OF_PHASE || (map == PTIE_OF_DENOISED ? denoised : truth);
}

/* Standard deviation of the difference, Pearson's correlation, and the slope on the truth: all blind to the
   means. */
static void compare_with_truth(double *value, const float *map, const float *truth, size_t count) {
    double mean_map = 0, mean_truth = 0, difference = 0, map2 = 0, truth2 = 0, cross = 0;
    for (size_t i = 0; i < count; i++) {
        mean_map += (double)map[i];
        mean_truth += (double)truth[i];
    }
    mean_map /= (double)count;
    mean_truth /= (double)count;
    for (size_t i = 0; i < count; i++) {
        double a = (double)map[i] - mean_map, b = (double)truth[i] - mean_truth;
        difference += (a - b) * (a - b);
        map2 += a * a;
        truth2 += b * b;
        cross += a * b;
    }
    value[PTIE_RMSE_RAD] = sqrt(difference / (double)count);
    value[PTIE_SIGNAL_KEPT] = truth2 > 0 ? cross / truth2 : (double)NAN;
    value[PTIE_CORRELATION] = map2 > 0 && truth2 > 0 ? cross / sqrt(map2 * truth2) : (double)NAN;
}

ptie_status ptie_run_measure(double *value, double *background_rad, const float *map, const float *truth,
                             const uint8_t *labels, int32_t width_px, int32_t height_px) {
    for (int i = 0; i < PTIE_RESIDUAL; i++) value[i] = (double)NAN;
    if (background_rad) *background_rad = (double)NAN;
    PTIE_TRY(ptie_image_finite(map, width_px, height_px, "map"));
    if (labels) {
        ptie_flow_metrics flow;
        PTIE_TRY(ptie_metrics_flow(&flow, map, labels, width_px, height_px));
        value[PTIE_MGM] = flow.mgm;
        value[PTIE_SBR] = flow.sbr;
        value[PTIE_BNS] = flow.bns;
        value[PTIE_CNR] = flow.cnr;
        if (background_rad) *background_rad = flow.mean_background;
    }
    if (truth)
        compare_with_truth(value, map, truth, (size_t)width_px * (size_t)height_px);
    return PTIE_OK;
}

/* Sums are taken in lanes, which vectorises and does not depend on the instruction set. */
enum { LANES = 16 };

static double total(const double lanes[LANES]) {
    double all = 0;
    for (int l = 0; l < LANES; l++) all += lanes[l];
    return all;
}

PTIE_CLONES double ptie_run_mean(const float *plane, size_t count) {
    double sum[LANES] = {0};
    const size_t whole = count / LANES * LANES;
    for (size_t i = 0; i < whole; i += LANES)
        for (size_t l = 0; l < LANES; l++) sum[l] += (double)plane[i + l];
    for (size_t i = whole; i < count; i++) sum[i - whole] += (double)plane[i];
    return total(sum) / (double)count;
}

PTIE_CLONES double ptie_run_share_above(const float *image, size_t count, double limit) {
    const float least = (float)limit;
    size_t above = 0;
    for (size_t i = 0; i < count; i++) above += image[i] >= least;
    return (double)above / (double)count;
}

/* Adds |second difference in x of the second difference in y| of a row's points; rows of (a / mean - b / mean). */
PTIE_CLONES static void add_roughness(double sum[LANES], const float *const a[3], const float *const b[3],
                                      float of_a, float of_b, ptrdiff_t width) {
    for (ptrdiff_t x = 1; x + LANES < width; x += LANES)
        for (ptrdiff_t l = 0; l < LANES; l++) {
            float d[3];
            for (int k = 0; k < 3; k++) {
                const ptrdiff_t at = x + l + k - 1;
                d[k] = of_a * (a[0][at] - 2 * a[1][at] + a[2][at]) - of_b * (b[0][at] - 2 * b[1][at] + b[2][at]);
            }
            sum[l] += (double)fabsf(d[0] - 2 * d[1] + d[2]);
        }
}

double ptie_run_plane_noise(ptie_lit_plane a, ptie_lit_plane b, int32_t width_px, int32_t height_px) {
    const ptrdiff_t width = width_px;
    const float of_a = (float)(1 / a.mean), of_b = (float)(1 / b.mean);
    const ptrdiff_t counted = (width - 2) / LANES * LANES;
    double sum[LANES] = {0};
    if (counted <= 0 || height_px < 3) return (double)NAN;
    for (ptrdiff_t y = 1; y < height_px - 1; y++) {
        const float *above_a = a.plane + (y - 1) * width, *above_b = b.plane + (y - 1) * width;
        const float *const rows_a[3] = {above_a, above_a + width, above_a + 2 * width};
        const float *const rows_b[3] = {above_b, above_b + width, above_b + 2 * width};
        add_roughness(sum, rows_a, rows_b, of_a, of_b, width);
    }
    /* The mask 1 -2 1 x 1 -2 1 has norm 6; E|normal| = sqrt(2/pi) sigma; two planes: sqrt 2. */
    const double mean = total(sum) / (double)(counted * (height_px - 2));
    return mean * sqrt(acos(-1) / 2) / (6 * sqrt(2));
}

void ptie_running_add(ptie_running *r, double value) {
    if (!isfinite(value)) return;
    const double before = value - r->mean;
    if (r->count++ == 0 || value > r->largest) r->largest = value;
    r->mean += before / (double)r->count;
    r->squares += before * (value - r->mean);
}

/* n - 1: the frames are a sample of the flow.  One frame has no deviation. */
ptie_stat ptie_running_stat(const ptie_running *r) {
    if (r->count == 0) return (ptie_stat){(double)NAN, (double)NAN};
    return (ptie_stat){r->mean, r->count > 1 ? sqrt(r->squares / (double)(r->count - 1)) : 0};
}
