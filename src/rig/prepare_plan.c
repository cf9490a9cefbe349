/* SPDX-License-Identifier: BSD-3-Clause */
/* What a preparation needs before the first frame: sizes, registration, dark, no-flow reference,
 * mask. */
#include "rig/prepare_plan.h"

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "io/recording.h"
#include "prep/prep.h"
#include "prep/resample.h"
#include "rig/channels.h"
#include "rig/planes.h"

/* Darker than this share of the mean, a reference is not divided by: beyond, it is noise that would
 * be amplified. */
#define FLAT_FLOOR 0.05

/* An opaque mask from the light: of so many frames where there is no reference, without specks and
   pinholes up to 4 pixels, and wider by what diffraction at an edge spoils. */
enum { MASK_FRAMES = 8, MASK_CLEAN_PX = 2, MASK_MARGIN_PX = 2 };

static ptie_status plan_channels(ptie_prepare *p, const ptie_source_shape *source) {
    p->width = source->width_px;
    p->height = source->height_px;
    p->channels = ptie_channel_count(p->rig.layout);
    if (p->channels == 0) return PTIE_OK;
    for (int32_t c = 0; c < p->channels; c++) ptie_channel_name(p->channel_name[c], &p->rig, c);
    ptie_splitter_params params = {.struct_size = sizeof params,
                                   .width_px = source->width_px,
                                   .height_px = source->height_px,
                                   .layout = p->rig.layout,
                                   .demosaic = p->rig.demosaic,
                                   .roi_x_px = p->rig.roi_x,
                                   .roi_y_px = p->rig.roi_y};
    PTIE_TRY(ptie_prep_splitter(&p->splitter, &params));
    (void)ptie_splitter_channels(p->splitter, &p->width, &p->height);
    return PTIE_OK;
}

static bool in_place(ptie_similarity s) {
    return s.shift_x_px == 0 && s.shift_y_px == 0 && s.magnification == 1 && s.rotation_rad == 0;
}

static ptie_status plan_registration(ptie_prepare *p) {
    for (int32_t i = 0; i < p->measured; i++) {
        const ptie_plane *plane = &p->rig.plane[p->role[i]];
        const ptie_similarity where = {plane->shift_x_px, plane->shift_y_px, plane->magnification,
                                       plane->rotation_rad};
        if (in_place(where)) continue;
        PTIE_TRY(ptie_prep_resampler(&p->resampler[i], p->width, p->height, where));
        uint8_t *inside;
        PTIE_TRY(ptie_alloc_status(&inside, p->pixels, 1, "run: registration"));
        ptie_resampler_inside(p->resampler[i], inside, 0);
        if (!p->seen) {
            p->seen = inside;
            continue;
        }
        for (size_t k = 0; k < p->pixels; k++) p->seen[k] &= inside[k];
        ptie_free(inside);
    }
    return PTIE_OK;
}

/* What a frame is after the last step: a sensor image, its channels, or planes. */
static void describe(ptie_prepare *p, const ptie_source_shape *source) {
    ptie_prepare_shape *s = &p->shape;
    const int32_t binning = p->last == PTIE_STEP_MASK ? p->rig.binning : 1;
    *s = (ptie_prepare_shape){.width_px = p->width / binning,
                              .height_px = p->height / binning,
                              .planes = p->last < PTIE_STEP_MIX ? p->measured : p->planes,
                              .pixel_m = ptie_rig_pixel_m(&p->rig) / p->rig.binning * binning};
    for (int32_t i = 0; i < s->planes; i++) s->name[i] = ptie_role_names[p->role[i]];
    if (p->channels > 0 && p->last == PTIE_STEP_SPLIT) {
        s->planes = p->channels;
        for (int32_t i = 0; i < s->planes; i++) s->name[i] = p->channel_name[i];
    }
    if (p->channels > 0 && p->last == PTIE_STEP_DARK)
        *s =
            (ptie_prepare_shape){source->width_px, source->height_px, 1, p->rig.pixel_m, {"image"}};
}

static ptie_status plan_sizes(ptie_prepare *p, const ptie_source_shape *source) {
    double z_m[PTIE_ROLES];
    p->images = source->images;
    p->sensor_pixels = (size_t)source->width_px * (size_t)source->height_px;
    p->planes = ptie_rig_planes(&p->rig, p->role, z_m);
    p->measured = p->planes - p->rig.one_plane;
    PTIE_TRY(plan_channels(p, source));
    p->pixels = (size_t)p->width * (size_t)p->height;
    describe(p, source);
    if (p->shape.width_px >= 2 && p->shape.height_px >= 2) return PTIE_OK;
    return PTIE_FAIL(PTIE_ESIZE, "run: frame too small to bin %d x %d (found %d x %d px)",
                     p->rig.binning, p->rig.binning, p->width, p->height);
}

static ptie_status alloc_maps(float **maps, int32_t count, size_t pixels) {
    for (int32_t i = 0; i < count; i++)
        PTIE_TRY(ptie_alloc_status(&maps[i], pixels, sizeof(float), "run"));
    return PTIE_OK;
}

static void free_maps(float **maps) {
    for (int32_t i = 0; i < PTIE_ROLES; i++) ptie_free(maps[i]);
}

/* The still parts of a rig while they are read. */
typedef struct still {
    ptie_prepare *plan;
    ptie_source *source;
    ptie_source_shape shape;
    float *image[PTIE_ROLES], *plane[PTIE_ROLES];
    unsigned char *scratch;
} still;

static ptie_status planes_after(still *s, ptie_step last) {
    const float *const *images = (const float *const *)s->image;
    return ptie_prepare_raw(s->plan, images, s->plane, last, s->scratch);
}

/* The mean of all reference frames: a set of one plane compares with it, others are divided by
 * theirs. */
static ptie_status use_reference(still *s) {
    ptie_prepare *p = s->plan;
    PTIE_TRY(ptie_source_mean(s->image, &s->shape, &p->rig, p->rig.reference));
    if (p->rig.one_plane) {
        PTIE_TRY(planes_after(s, p->last));
        PTIE_TRY(ptie_alloc_status(&p->reference, p->pixels, sizeof(float), "run: reference"));
        memcpy(p->reference, s->plane[0], p->pixels * sizeof(float));
        return PTIE_OK;
    }
    if (!p->rig.flat_field || p->last < PTIE_STEP_FLAT) return PTIE_OK;
    PTIE_TRY(planes_after(s, PTIE_STEP_MIX));
    PTIE_TRY(alloc_maps(p->flat, p->measured, p->pixels));
    for (int32_t i = 0; i < p->measured; i++)
        PTIE_TRY(
            ptie_prep_flat_gain(p->flat[i], s->plane[i], NULL, p->width, p->height, FLAT_FLOOR));
    return PTIE_OK;
}

static ptie_status read_mask(still *s, uint8_t *mask) {
    const ptie_prepare *p = s->plan;
    ptie_recording *recording;
    PTIE_TRY(ptie_io_open(&recording, p->rig.mask));
    const ptie_recording_info *info = ptie_io_info(recording);
    ptie_status status = PTIE_OK;
    if (info->width_px != p->width || info->height_px != p->height)
        status = PTIE_FAIL(
            PTIE_ESIZE,
            "%s: mask differs from the planes in size (expected %d x %d px, found %d x %d)",
            p->rig.mask, p->width, p->height, info->width_px, info->height_px);
    if (status == PTIE_OK) status = ptie_io_read(recording, 0, s->plane[0]);
    for (size_t i = 0; i < p->pixels && status == PTIE_OK; i++) mask[i] = s->plane[0][i] != 0;
    ptie_io_close(recording);
    return status;
}

/* The light of all planes together, without flow if the rig has a reference. */
static ptie_status find_light(still *s, float *light) {
    const ptie_prepare *p = s->plan;
    if (p->rig.reference[0])
        PTIE_TRY(ptie_source_mean(s->image, &s->shape, &p->rig, p->rig.reference));
    else
        PTIE_TRY(ptie_source_average(s->source, s->image, MASK_FRAMES));
    PTIE_TRY(planes_after(s, PTIE_STEP_REGISTRATION));
    for (size_t i = 0; i < p->pixels; i++) light[i] = 0;
    for (int32_t k = 0; k < p->measured; k++)
        for (size_t i = 0; i < p->pixels; i++) light[i] += s->plane[k][i];
    return PTIE_OK;
}

static ptie_status threshold_mask(still *s, uint8_t *mask) {
    const ptie_prepare *p = s->plan;
    float *light;
    PTIE_TRY(ptie_alloc_status(&light, p->pixels, sizeof *light, "run: mask"));
    ptie_status status = find_light(s, light);
    if (status == PTIE_OK)
        status = ptie_prep_opaque_mask(mask, light, p->width, p->height, p->rig.mask_below,
                                       MASK_CLEAN_PX, MASK_MARGIN_PX);
    ptie_free(light);
    return status;
}

static ptie_status find_mask(still *s) {
    ptie_prepare *p = s->plan;
    uint8_t *mask;
    if (!p->rig.mask[0] && p->rig.mask_below == 0) return PTIE_OK;
    PTIE_TRY(ptie_alloc_status(&mask, p->pixels, 1, "run: mask"));
    ptie_status status = p->rig.mask[0] ? read_mask(s, mask) : threshold_mask(s, mask);
    if (status == PTIE_OK)
        p->light = mask;
    else
        ptie_free(mask);
    return status;
}

/* A bin counts if all of its pixels do. */
static ptie_status bin_mask(uint8_t **out, const uint8_t *mask, const ptie_prepare *p) {
    const ptie_prepare_shape *shape = &p->shape;
    const int32_t n = p->rig.binning;
    if (!mask) return PTIE_OK;
    PTIE_TRY(
        ptie_alloc_status(out, (size_t)shape->width_px * (size_t)shape->height_px, 1, "run: mask"));
    for (int32_t y = 0; y < shape->height_px; y++)
        for (int32_t x = 0; x < shape->width_px; x++) {
            uint8_t all = 1;
            for (int32_t i = 0; i < n * n; i++)
                all &= mask[((ptrdiff_t)y * n + i / n) * p->width + (ptrdiff_t)x * n + i % n];
            (*out)[(ptrdiff_t)y * shape->width_px + x] = all;
        }
    return PTIE_OK;
}

static ptie_status read_stills(still *s) {
    ptie_prepare *p = s->plan;
    PTIE_TRY(alloc_maps(s->image, p->images, p->sensor_pixels));
    PTIE_TRY(alloc_maps(s->plane, p->planes, p->pixels));
    PTIE_TRY(ptie_alloc_status(&s->scratch, ptie_prepare_scratch_bytes(p), 1, "run: scratch"));
    if (p->rig.dark[0]) {
        PTIE_TRY(alloc_maps(p->dark, p->images, p->sensor_pixels));
        PTIE_TRY(ptie_source_mean(p->dark, &s->shape, &p->rig, p->rig.dark));
    }
    if (p->last < PTIE_STEP_MIX) return PTIE_OK;
    if (p->last >= PTIE_STEP_GAIN) PTIE_TRY(find_mask(s)); /* while there is no flat field */
    if (p->rig.reference[0]) PTIE_TRY(use_reference(s));
    if (p->last < PTIE_STEP_MASK) return PTIE_OK;
    PTIE_TRY(bin_mask(&p->binned_light, p->light, p));
    return bin_mask(&p->binned_seen, p->seen, p);
}

static ptie_status build(ptie_prepare *p, ptie_source *source) {
    still s = {.plan = p, .source = source, .shape = ptie_source_get_shape(source)};
    if (p->rig.one_plane && !p->rig.reference[0])
        return PTIE_FAIL(PTIE_EINVAL, "run: no-flow reference is missing (expected --reference, or "
                                      "'reference' in the rig's [recording])");
    PTIE_TRY(plan_sizes(p, &s.shape));
    if (p->last >= PTIE_STEP_REGISTRATION) PTIE_TRY(plan_registration(p));
    ptie_status status = read_stills(&s);
    free_maps(s.image);
    free_maps(s.plane);
    ptie_free(s.scratch);
    return status;
}

ptie_status ptie_prepare_until(ptie_prepare **out, ptie_source *source, const ptie_rig *rig,
                               ptie_step last) {
    *out = NULL;
    ptie_prepare *p;
    PTIE_TRY(ptie_alloc_status(&p, 1, sizeof *p, "run"));
    p->rig = *rig;
    p->last = last;
    ptie_status status = build(p, source);
    if (status == PTIE_OK)
        *out = p;
    else
        ptie_prepare_free(p);
    return status;
}

ptie_status ptie_prepare_create(ptie_prepare **out, ptie_source *source, const ptie_rig *rig) {
    return ptie_prepare_until(out, source, rig, PTIE_STEP_MASK);
}

void ptie_prepare_free(ptie_prepare *p) {
    if (!p) return;
    for (int32_t i = 0; i < PTIE_ROLES; i++) ptie_resampler_free(p->resampler[i]);
    free_maps(p->dark);
    free_maps(p->flat);
    ptie_splitter_free(p->splitter);
    ptie_free(p->reference);
    ptie_free(p->light);
    ptie_free(p->seen);
    ptie_free(p->binned_light);
    ptie_free(p->binned_seen);
    ptie_free(p);
}

ptie_prepare_shape ptie_prepare_get_shape(const ptie_prepare *p) {
    return p->shape;
}

const uint8_t *ptie_prepare_mask(const ptie_prepare *p) {
    return p->binned_light;
}

const uint8_t *ptie_prepare_seen(const ptie_prepare *p) {
    return p->binned_seen;
}
