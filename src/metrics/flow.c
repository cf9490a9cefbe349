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

/* Of a region: number of pixels, and sums of (map - level) and its square. */
typedef struct moments {
    sums count, first, second;
} moments;

/* Nothing of a pixel that is not in the region. */
PTIE_INLINE void add_pixel(moments *m, size_t lane, double value, bool in) {
    const double counted = in ? value : 0;
    m->count.value[lane] += in ? 1 : 0;
    m->first.value[lane] += counted;
    m->second.value[lane] += counted * counted;
}

/* Whether any of LANES labels is the region: most blocks are all in it or have nothing of it. */
PTIE_INLINE bool has_any(const uint8_t *labels, uint8_t region) {
    uint8_t any = 0;
    for (size_t l = 0; l < LANES; l++) any |= labels[l] == region;
    return any;
}

PTIE_CLONES static void add_region(moments *restrict m, const float *restrict map, const uint8_t *restrict labels,
                                   uint8_t region, size_t pixels, double level) {
    const size_t whole = pixels / LANES * LANES;
    for (size_t i = 0; i < whole; i += LANES) {
        if (!has_any(labels + i, region)) continue;
        for (size_t l = 0; l < LANES; l++) add_pixel(m, l, (double)map[i + l] - level, labels[i + l] == region);
    }
    for (size_t i = whole; i < pixels; i++) add_pixel(m, i - whole, (double)map[i] - level, labels[i] == region);
}

typedef struct region {
    double count, mean, variance;
} region;

static region region_of(const moments *m, double level) {
    const double count = total(&m->count), off = total(&m->first) / count;
    return (region){count, level + off, fmax(total(&m->second) / count - off * off, 0)};
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
PTIE_CLONES static void add_gradients(sums *restrict sum, const stencil *restrict s, const uint8_t *restrict labels,
                                      ptrdiff_t width) {
    if (labels[0] == PTIE_JET) sum->value[0] += gradient(s, 0, 0, width > 1);
    ptrdiff_t x = 1;
    for (; x + LANES < width; x += LANES) {
        if (!has_any(labels + x, PTIE_JET)) continue;
        for (ptrdiff_t l = 0; l < LANES; l++) {
            const double steepness = gradient(s, x + l - 1, x + l, x + l + 1);
            sum->value[l] += labels[x + l] == PTIE_JET ? steepness : 0;
        }
    }
    for (; x < width; x++)
        if (labels[x] == PTIE_JET) sum->value[0] += gradient(s, x - 1, x, x + (x + 1 < width));
}

static double mean_gradient(const float *map, const uint8_t *labels, ptrdiff_t width, ptrdiff_t height,
                            double jet_pixels) {
    sums sum = {{0}};
    for (ptrdiff_t y = 0; y < height; y++) {
        const ptrdiff_t up = y > 0 ? y - 1 : 0, down = y < height - 1 ? y + 1 : y;
        const stencil s = {map + up * width, map + y * width, map + down * width,
                           down > up ? 1.0 / (double)(down - up) : 0};
        add_gradients(&sum, &s, labels + y * width, width);
    }
    return total(&sum) / jet_pixels;
}

ptie_status ptie_metrics_flow(ptie_flow_metrics *out, const float *map, const uint8_t *labels,
                              int32_t width, int32_t height) {
    PTIE_TRY(ptie_image_finite(map, width, height, "map"));
    const size_t pixels = (size_t)width * (size_t)height;
    /* Sums about a level inside the map's values: squares of the values themselves could be far larger than the
       variance. */
    const double level = (double)map[0];
    moments of_jet = {0}, of_background = {0};
    add_region(&of_jet, map, labels, PTIE_JET, pixels, level);
    add_region(&of_background, map, labels, PTIE_BACKGROUND, pixels, level);
    const region jet = region_of(&of_jet, level), background = region_of(&of_background, level);
    if (jet.count == 0 || background.count == 0)
        return PTIE_FAIL(
            PTIE_EINVAL,
            "labels: a region is empty (expected pixels of both, found %.0f of the jet and "
            "%.0f of the background)",
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
