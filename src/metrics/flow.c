/* SPDX-License-Identifier: BSD-3-Clause */
/* What a map says about a flow, without truth.  docs/math.md (Q4)-(Q7). */
#include <math.h>

#include "base/clones.h"
#include "base/image.h"
#include "metrics/metrics.h"

/* Sums are taken in lanes and the lanes added in order: the compiler vectorises that, and every instruction set
   gives the same bits. */
enum { LANES = 16 };

typedef struct sums {
    double value[LANES];
} sums;

static double total(const sums *s) {
    double all = 0;
    for (int l = 0; l < LANES; l++) all += s->value[l];
    return all;
}

PTIE_INLINE double deviation(float value, uint8_t has, uint8_t label, double level) {
    return has == label ? (double)value - level : 0;
}

/* Adds (map - level)^power over a region, power 1 or 2. */
PTIE_CLONES static void add_powers(sums *s, const float *map, const uint8_t *labels, size_t pixels,
                                   uint8_t label, double level, int power) {
    const size_t whole = pixels / LANES * LANES;
    for (size_t i = 0; i < whole; i += LANES)
        for (size_t l = 0; l < LANES; l++) {
            const double d = deviation(map[i + l], labels[i + l], label, level);
            s->value[l] += power == 1 ? d : d * d;
        }
    for (size_t i = whole; i < pixels; i++) {
        const double d = deviation(map[i], labels[i], label, level);
        s->value[i - whole] += power == 1 ? d : d * d;
    }
}

typedef struct region {
    size_t count;
    double mean, variance;
} region;

static region measure(const float *map, const uint8_t *labels, size_t pixels, uint8_t label) {
    region r = {0};
    sums first = {{0}}, second = {{0}};
    for (size_t i = 0; i < pixels; i++) r.count += labels[i] == label;
    add_powers(&first, map, labels, pixels, label, 0, 1);
    r.mean = total(&first) / (double)r.count;
    add_powers(&second, map, labels, pixels, label, r.mean, 2);
    r.variance = total(&second) / (double)r.count;
    return r;
}

/* Three rows around a line of the map; at an edge of the map two of them are the same. */
typedef struct stencil {
    const float *above, *here, *below;
    double per_row; /* 1 / rows between above and below; 0 for a map of one row */
} stencil;

/* Length of the gradient at x from central differences, one-sided at the edges. */
PTIE_INLINE double gradient(const stencil *s, ptrdiff_t left, ptrdiff_t x, ptrdiff_t right) {
    const double dx = right > left ? ((double)s->here[right] - (double)s->here[left]) / (double)(right - left) : 0;
    const double dy = ((double)s->below[x] - (double)s->above[x]) * s->per_row;
    return sqrt(dx * dx + dy * dy);
}

/* Adds the gradients of a line's points inside the jet. */
PTIE_CLONES static void add_gradients(sums *sum, const stencil *s, const uint8_t *labels, ptrdiff_t width) {
    if (labels[0] == PTIE_JET) sum->value[0] += gradient(s, 0, 0, width > 1);
    ptrdiff_t x = 1;
    for (; x + LANES < width; x += LANES)
        for (ptrdiff_t l = 0; l < LANES; l++)
            sum->value[l] += labels[x + l] == PTIE_JET ? gradient(s, x + l - 1, x + l, x + l + 1) : 0;
    for (; x < width; x++)
        if (labels[x] == PTIE_JET) sum->value[0] += gradient(s, x - 1, x, x + (x + 1 < width));
}

static double mean_gradient(const float *map, const uint8_t *labels, ptrdiff_t width, ptrdiff_t height,
                            size_t jet_pixels) {
    sums sum = {{0}};
    for (ptrdiff_t y = 0; y < height; y++) {
        const ptrdiff_t up = y > 0 ? y - 1 : 0, down = y < height - 1 ? y + 1 : y;
        const stencil s = {map + up * width, map + y * width, map + down * width,
                           down > up ? 1.0 / (double)(down - up) : 0};
        add_gradients(&sum, &s, labels + y * width, width);
    }
    return total(&sum) / (double)jet_pixels;
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
        .mgm = mean_gradient(map, labels, width, height, jet.count),
        .sbr = jet.mean / background.mean,
        .bns = sqrt(background.variance),
        .cnr = fabs(jet.mean - background.mean) / sqrt(jet.variance + background.variance),
        .mean_jet = jet.mean,
        .mean_background = background.mean,
    };
    return PTIE_OK;
}
