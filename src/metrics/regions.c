/* SPDX-License-Identifier: BSD-3-Clause */
/* Where the flow is and where it is not.  docs/math.md (Q9). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/image.h"
#include "base/mask.h"
#include "base/memory.h"
#include "metrics/metrics.h"

enum { BINS = 256 }; /* of the histogram under the Otsu threshold */

static const double SMALLEST_PART = 0.1;  /* of the jet, relative to its largest */
static const double CLEANING = 1.0 / 128; /* radius relative to the shorter side */
static const double DISTANCE = 0.05;      /* of the background from the jet, likewise */

static void fill_rect(uint8_t *labels, int32_t width, ptie_rect rect, uint8_t label) {
    for (int32_t y = rect.y_px; y < rect.y_px + rect.height_px; y++)
        memset(labels + (ptrdiff_t)y * width + rect.x_px, label, (size_t)rect.width_px);
}

ptie_status ptie_metrics_label_rects(uint8_t *labels, int32_t width, int32_t height, ptie_rect jet,
                                     ptie_rect background) {
    PTIE_TRY(ptie_rect_check(jet, width, height, "jet"));
    PTIE_TRY(ptie_rect_check(background, width, height, "background"));
    memset(labels, PTIE_NOWHERE, (size_t)width * (size_t)height);
    fill_rect(labels, width, background, PTIE_BACKGROUND);
    fill_rect(labels, width, jet, PTIE_JET);
    return PTIE_OK;
}

static int32_t bin_of(double magnitude, double largest) {
    const int32_t bin = (int32_t)(magnitude / largest * BINS);
    return bin < BINS ? bin : BINS - 1;
}

/* First bin above the threshold that separates the histogram into two classes with the greatest
   variance between them (Otsu 1979). */
static int32_t otsu(const double histogram[BINS]) {
    double total = 0, moment = 0, below = 0, moment_below = 0, best = -1;
    int32_t threshold = 1;
    for (int32_t i = 0; i < BINS; i++) total += histogram[i], moment += i * histogram[i];
    for (int32_t i = 0; i < BINS - 1; i++) {
        below += histogram[i], moment_below += i * histogram[i];
        const double above = total - below;
        if (below == 0 || above == 0) continue;
        const double step = moment_below / below - (moment - moment_below) / above;
        if (below * above * step * step > best)
            best = below * above * step * step, threshold = i + 1;
    }
    return threshold;
}

/* mask (out): 1 where |map - level| exceeds the threshold. */
static ptie_status threshold_map(uint8_t *mask, const float *map, size_t pixels, double level) {
    double histogram[BINS] = {0}, largest = 0;
    for (size_t i = 0; i < pixels; i++) largest = fmax(largest, fabs((double)map[i] - level));
    if (largest == 0)
        return PTIE_FAIL(PTIE_ENUMERIC, "map: is constant (expected a flow, found %g everywhere)",
                         level);
    for (size_t i = 0; i < pixels; i++) histogram[bin_of(fabs((double)map[i] - level), largest)]++;
    const int32_t threshold = otsu(histogram);
    for (size_t i = 0; i < pixels; i++)
        mask[i] = bin_of(fabs((double)map[i] - level), largest) >= threshold;
    return PTIE_OK;
}

typedef struct scratch {
    uint8_t *jet, *near_jet, *bytes; /* near_jet: the jet and what is too close to it */
    int32_t *size, *queue;
    float *border;
} scratch;

static scratch carve(ptie_slicer *slicer, int32_t width, int32_t height) {
    const size_t pixels = (size_t)width * (size_t)height;
    scratch s;
    s.jet = ptie_slice(slicer, pixels, sizeof *s.jet);
    s.near_jet = ptie_slice(slicer, pixels, sizeof *s.near_jet);
    s.bytes = ptie_slice(slicer, pixels, sizeof *s.bytes);
    s.size = ptie_slice(slicer, pixels, sizeof *s.size);
    s.queue = ptie_slice(slicer, pixels, sizeof *s.queue);
    s.border = ptie_slice(slicer, 2 * ((size_t)width + (size_t)height), sizeof *s.border);
    return s;
}

static int32_t radius(double share, int32_t width, int32_t height) {
    return (int32_t)ceil(share * (width < height ? width : height));
}

/* Opening removes specks, closing fills pinholes. */
static void clean(uint8_t *mask, int32_t width, int32_t height, const scratch *s) {
    const int32_t r = radius(CLEANING, width, height);
    ptie_mask_grow(mask, width, height, r, 0, s->bytes);
    ptie_mask_grow(mask, width, height, 2 * r, 1, s->bytes);
    ptie_mask_grow(mask, width, height, r, 0, s->bytes);
    ptie_mask_keep_large(mask, width, height, SMALLEST_PART, s->size, s->queue);
}

static ptie_status propose(uint8_t *labels, const float *map, int32_t width, int32_t height,
                           const scratch *s) {
    const size_t pixels = (size_t)width * (size_t)height;
    const double level = ptie_image_border_median(map, width, height, s->border);
    PTIE_TRY(threshold_map(s->jet, map, pixels, level));
    clean(s->jet, width, height, s);
    memcpy(s->near_jet, s->jet, pixels);
    ptie_mask_grow(s->near_jet, width, height, radius(DISTANCE, width, height), 1, s->bytes);
    size_t jet = 0, background = 0;
    for (size_t i = 0; i < pixels; i++) jet += s->jet[i], background += !s->near_jet[i];
    if (jet == 0 || background == 0)
        return PTIE_FAIL(PTIE_ENUMERIC,
                         "map: no regions to tell apart (expected a jet and room for a background, "
                         "found %zu and %zu pixels)",
                         jet, background);
    for (size_t i = 0; i < pixels; i++)
        labels[i] = s->jet[i] ? PTIE_JET : s->near_jet[i] ? PTIE_NOWHERE : PTIE_BACKGROUND;
    return PTIE_OK;
}

ptie_status ptie_metrics_propose(uint8_t *labels, const float *map, int32_t width, int32_t height) {
    PTIE_TRY(ptie_image_finite(map, width, height, "map"));
    ptie_slicer slicer = {0};
    carve(&slicer, width, height);
    PTIE_TRY(ptie_alloc_status(&slicer.base, slicer.used, 1, "regions"));
    slicer.used = 0;
    const scratch s = carve(&slicer, width, height);
    const ptie_status status = propose(labels, map, width, height, &s);
    ptie_free(slicer.base);
    return status;
}
