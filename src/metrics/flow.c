/* SPDX-License-Identifier: BSD-3-Clause */
/* What a map says about a flow, without truth.  docs/math.md (Q4)-(Q7). */
#include <math.h>

#include "base/image.h"
#include "metrics/metrics.h"

typedef struct region {
    size_t count;
    double mean, variance;
} region;

static region measure(const float *map, const uint8_t *labels, size_t pixels, uint8_t label) {
    region r = {0};
    double sum = 0, squares = 0;
    for (size_t i = 0; i < pixels; i++)
        if (labels[i] == label) sum += (double)map[i], r.count++;
    r.mean = sum / (double)r.count;
    for (size_t i = 0; i < pixels; i++)
        if (labels[i] == label) squares += ((double)map[i] - r.mean) * ((double)map[i] - r.mean);
    r.variance = squares / (double)r.count;
    return r;
}

/* Central difference at index `i` of a line with `n` points; one-sided at its ends. */
static double slope(const float *line, int32_t i, int32_t n, int32_t stride) {
    const ptrdiff_t low = i > 0 ? i - 1 : 0, high = i < n - 1 ? i + 1 : n - 1;
    if (high == low) return 0;
    return ((double)line[high * stride] - (double)line[low * stride]) / (double)(high - low);
}

static double mean_gradient(const float *map, const uint8_t *labels, int32_t width,
                            int32_t height) {
    double sum = 0;
    size_t count = 0;
    for (int32_t y = 0; y < height; y++) {
        const ptrdiff_t row = (ptrdiff_t)y * width;
        for (int32_t x = 0; x < width; x++) {
            if (labels[row + x] != PTIE_JET) continue;
            sum += hypot(slope(map + row, x, width, 1), slope(map + x, y, height, width));
            count++;
        }
    }
    return sum / (double)count;
}

ptie_status ptie_metrics_flow(ptie_flow_metrics *out, const float *map, const uint8_t *labels,
                              int32_t width, int32_t height) {
    PTIE_TRY(ptie_image_finite(map, width, height, "map"));
    const size_t pixels = (size_t)width * (size_t)height;
    const region jet = measure(map, labels, pixels, PTIE_JET);
    const region background = measure(map, labels, pixels, PTIE_BACKGROUND);
    if (jet.count == 0 || background.count == 0)
        return PTIE_FAIL(
            PTIE_EINVAL,
            "labels: a region is empty (expected pixels of both, found %zu of the jet and "
            "%zu of the background)",
            jet.count, background.count);
    *out = (ptie_flow_metrics){
        .mgm = mean_gradient(map, labels, width, height),
        .sbr = jet.mean / background.mean,
        .bns = sqrt(background.variance),
        .cnr = fabs(jet.mean - background.mean) / sqrt(jet.variance + background.variance),
        .mean_jet = jet.mean,
        .mean_background = background.mean,
    };
    return PTIE_OK;
}
