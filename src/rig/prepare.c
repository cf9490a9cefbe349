/* SPDX-License-Identifier: BSD-3-Clause */
#include "rig/prepare_plan.h"

#include <string.h>

#include "base/memory.h"
#include "prep/prep.h"
#include "prep/resample.h"
#include "rig/planes.h"

/* The scratch of one run. */
typedef struct work {
    const float *image[PTIE_ROLES]; /* (sensor height, width) without dark */
    float *own_image[PTIE_ROLES];   /* where a dark image is taken off */
    float *channel[PTIE_CHANNELS]; /* (H, W) */
    float *plane[PTIE_ROLES];      /* (H, W) */
    void *step;                    /* of the splitter or a resampler */
} work;

static size_t larger(size_t a, size_t b) {
    return a > b ? a : b;
}

static work carve(const ptie_prepare *p, ptie_slicer *slicer) {
    work w = {0};
    size_t step = p->splitter ? ptie_prep_splitter_scratch(p->splitter) : 0;
    for (int32_t i = 0; i < p->measured; i++)
        if (p->resampler[i]) step = larger(step, ptie_prep_resampler_scratch(p->resampler[i]));
    if (p->light) step = larger(step, ptie_fill_scratch_bytes(p->width, p->height));
    for (int32_t i = 0; i < p->images; i++)
        w.own_image[i] = ptie_slice(slicer, p->sensor_pixels, sizeof(float));
    for (int32_t i = 0; i < p->channels; i++)
        w.channel[i] = ptie_slice(slicer, p->pixels, sizeof(float));
    for (int32_t i = 0; i < p->planes; i++)
        w.plane[i] = ptie_slice(slicer, p->pixels, sizeof(float));
    w.step = ptie_slice(slicer, step, 1);
    return w;
}

size_t ptie_prepare_scratch_bytes(const ptie_prepare *p) {
    ptie_slicer slicer = {0};
    carve(p, &slicer);
    return slicer.used;
}

static void subtract_dark(const ptie_prepare *p, work *w, const float *const *images) {
    for (int32_t i = 0; i < p->images; i++) {
        w->image[i] = images[i];
        if (!p->dark[i]) continue;
        memcpy(w->own_image[i], images[i], p->sensor_pixels * sizeof(float));
        ptie_subtract_dark(w->own_image[i], p->dark[i], p->sensor_pixels);
        w->image[i] = w->own_image[i];
    }
}

/* Planes as sums of channels, or as they came.  The reference of a set of one plane comes last and
   is not measured. */
static void mix(const ptie_prepare *p, const work *w) {
    for (int32_t i = 0; i < p->measured; i++) {
        if (p->channels == 0)
            memcpy(w->plane[i], w->image[i], p->pixels * sizeof(float));
        else
            ptie_mix_channels(w->plane[i], (const float *const *)w->channel,
                              p->rig.plane[p->role[i]].mix, p->channels, p->pixels);
    }
}

static void flatten(const ptie_prepare *p, const work *w) {
    for (int32_t i = 0; i < p->measured; i++)
        if (p->flat[i]) ptie_apply_gain(w->plane[i], p->flat[i], p->pixels);
}

static void apply_gains(const ptie_prepare *p, const work *w) {
    for (int32_t i = 0; i < p->measured; i++) {
        const double gain = p->rig.plane[p->role[i]].gain;
        if (gain != 1) ptie_scale_image(w->plane[i], gain, p->pixels);
    }
}

/* All planes to the mean of their means: the light that TIE moves about does not become more. */
static ptie_status match_means(const ptie_prepare *p, const work *w) {
    double mean[PTIE_ROLES], target = 0;
    for (int32_t i = 0; i < p->planes; i++) {
        mean[i] = ptie_masked_mean(w->plane[i], p->light, p->pixels);
        target += mean[i] / p->planes;
        if (!(mean[i] > 0))
            return PTIE_FAIL(PTIE_ENUMERIC,
                             "plane '%s': mean intensity is not positive (expected > 0, found %g)",
                             ptie_role_names[p->role[i]], mean[i]);
    }
    for (int32_t i = 0; i < p->planes; i++)
        ptie_scale_image(w->plane[i], target / mean[i], p->pixels);
    return PTIE_OK;
}

static void bring_to_grid(const ptie_prepare *p, const work *w) {
    for (int32_t i = 0; i < p->measured; i++)
        if (p->resampler[i]) ptie_prep_resample(p->resampler[i], w->plane[i], w->plane[i], w->step);
}

/* Images to planes, up to a step; `raw`: means are not matched. */
static ptie_status compute(const ptie_prepare *p, work *w, const float *const *images,
                           ptie_step last, bool raw) {
    subtract_dark(p, w, images);
    if (last < PTIE_STEP_SPLIT) return PTIE_OK;
    if (p->splitter) ptie_prep_split(p->splitter, w->channel, w->image[0], w->step);
    if (last < PTIE_STEP_MIX) return PTIE_OK;
    mix(p, w);
    if (p->reference) memcpy(w->plane[p->measured], p->reference, p->pixels * sizeof(float));
    if (last >= PTIE_STEP_FLAT) flatten(p, w);
    if (last >= PTIE_STEP_GAIN) apply_gains(p, w);
    if (!raw && last >= PTIE_STEP_GAIN && p->rig.match_gain) PTIE_TRY(match_means(p, w));
    if (last >= PTIE_STEP_REGISTRATION) bring_to_grid(p, w);
    return PTIE_OK;
}

ptie_status ptie_prepare_raw(const ptie_prepare *p, const float *const *images,
                             float *const *planes, ptie_step last, void *scratch) {
    work w = carve(p, &(ptie_slicer){.base = scratch});
    PTIE_TRY(compute(p, &w, images, last, true));
    for (int32_t i = 0; i < p->measured; i++)
        memcpy(planes[i], w.plane[i], p->pixels * sizeof(float));
    return PTIE_OK;
}

static void fill_opaque(const ptie_prepare *p, const work *w) {
    if (!p->light) return;
    for (int32_t i = 0; i < p->planes; i++)
        ptie_fill_masked(w->plane[i], p->light, p->width, p->height, w->step);
}

/* The map of a step before the last one, or binned. */
static void deliver(const ptie_prepare *p, const work *w, float *map, int32_t i) {
    const float *found = w->plane[i];
    if (p->last < PTIE_STEP_MIX) found = p->last == PTIE_STEP_SPLIT && p->splitter ? w->channel[i] : w->image[i];
    if (p->last == PTIE_STEP_MASK)
        ptie_bin(map, found, p->width, p->height, p->rig.binning);
    else
        memcpy(map, found, (size_t)p->shape.width_px * (size_t)p->shape.height_px * sizeof(float));
}

ptie_status ptie_prepare_run(const ptie_prepare *p, const float *const *images, float *const *maps,
                             void *scratch) {
    work w = carve(p, &(ptie_slicer){.base = scratch});
    if (p->last == PTIE_STEP_MASK && p->rig.binning == 1) { /* made where they are wanted */
        for (int32_t i = 0; i < p->planes; i++) w.plane[i] = maps[i];
        PTIE_TRY(compute(p, &w, images, p->last, false));
        fill_opaque(p, &w);
        return PTIE_OK;
    }
    PTIE_TRY(compute(p, &w, images, p->last, false));
    if (p->last == PTIE_STEP_MASK) fill_opaque(p, &w);
    for (int32_t i = 0; i < p->shape.planes; i++) deliver(p, &w, maps[i], i);
    return PTIE_OK;
}
