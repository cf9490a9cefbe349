/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/measure.h"

#include <math.h>

#include "base/image.h"
#include "metrics/metrics.h"

static const char *const names[PTIE_RUN_METRICS] = {"mgm", "sbr", "bns", "cnr", "rmse_rad", "correlation",
                                                   "signal_kept", "residual"};

const char *ptie_run_metric_name(int which) {
    return names[which];
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

ptie_status ptie_run_measure(double *value, const float *map, const float *truth, const uint8_t *labels,
                             int32_t width_px, int32_t height_px) {
    for (int i = 0; i < PTIE_RESIDUAL; i++) value[i] = (double)NAN;
    PTIE_TRY(ptie_image_finite(map, width_px, height_px, "map"));
    if (labels) {
        ptie_flow_metrics flow;
        PTIE_TRY(ptie_metrics_flow(&flow, map, labels, width_px, height_px));
        value[PTIE_MGM] = flow.mgm;
        value[PTIE_SBR] = flow.sbr;
        value[PTIE_BNS] = flow.bns;
        value[PTIE_CNR] = flow.cnr;
    }
    if (truth)
        compare_with_truth(value, map, truth, (size_t)width_px * (size_t)height_px);
    return PTIE_OK;
}

/* Over the frames that have the metric: without flow a ratio may be 0/0. */
static ptie_stat over_frames(const double *values, int64_t frames) {
    double mean = 0, squares = 0;
    int64_t count = 0;
    for (int64_t t = 0; t < frames; t++) {
        if (!isfinite(values[t * PTIE_RUN_METRICS])) continue;
        mean += values[t * PTIE_RUN_METRICS];
        count++;
    }
    if (count == 0) return (ptie_stat){(double)NAN, (double)NAN};
    mean /= (double)count;
    for (int64_t t = 0; t < frames; t++) {
        if (!isfinite(values[t * PTIE_RUN_METRICS])) continue;
        double off = values[t * PTIE_RUN_METRICS] - mean;
        squares += off * off;
    }
    /* n - 1: the frames are a sample of the flow.  One frame has no deviation. */
    return (ptie_stat){mean, count > 1 ? sqrt(squares / (double)(count - 1)) : 0};
}

ptie_run_row ptie_run_summarise(const double *values, int64_t frames) {
    return (ptie_run_row){.mgm = over_frames(values + PTIE_MGM, frames),
                          .sbr = over_frames(values + PTIE_SBR, frames),
                          .bns = over_frames(values + PTIE_BNS, frames),
                          .cnr = over_frames(values + PTIE_CNR, frames),
                          .rmse_rad = over_frames(values + PTIE_RMSE_RAD, frames),
                          .correlation = over_frames(values + PTIE_CORRELATION, frames),
                          .signal_kept = over_frames(values + PTIE_SIGNAL_KEPT, frames),
                          .residual = over_frames(values + PTIE_RESIDUAL, frames)};
}
