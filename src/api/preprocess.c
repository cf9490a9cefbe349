/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/preprocess.h>: arguments checked, then inward. */
#include <ptie/preprocess.h>

#include "api/params.h"
#include "base/image.h"
#include "prep/prep.h"
#include "prep/resample.h"
#include "prep/surface.h"

static ptie_status check_image(const void *image, const char *name, int32_t width, int32_t height,
                               const char *where) {
    PTIE_TRY(ptie_check_pointer(image, where, name));
    PTIE_TRY(ptie_check_integer(width, 1, 32768, where, "width_px"));
    return ptie_check_integer(height, 1, 32768, where, "height_px");
}

ptie_status ptie_flat_gain(float *gain, const float *reference, const uint8_t *mask,
                           int32_t width_px, int32_t height_px, double floor) {
    static const char where[] = "ptie_flat_gain";
    PTIE_TRY(ptie_check_pointer(gain, where, "gain"));
    PTIE_TRY(check_image(reference, "reference", width_px, height_px, where));
    PTIE_TRY(ptie_check_number(floor, 1e-6, 1, where, "floor"));
    return ptie_prep_flat_gain(gain, reference, mask, width_px, height_px, floor);
}

static ptie_status check_splitter(const ptie_splitter_params *p, const char *where) {
    PTIE_TRY(ptie_check_integer(p->width_px, 2, 32768, where, "width_px"));
    PTIE_TRY(ptie_check_integer(p->height_px, 2, 32768, where, "height_px"));
    PTIE_TRY(ptie_check_integer(p->layout, PTIE_LAYOUT_SEPARATE, PTIE_LAYOUT_QUADRANTS, where,
                                "layout"));
    PTIE_TRY(ptie_check_integer(p->demosaic, PTIE_DEMOSAIC_NONE, PTIE_DEMOSAIC_FOURIER, where,
                                "demosaic"));
    PTIE_TRY(ptie_check_integer(p->roi_x_px, 0, 32768, where, "roi_x_px"));
    return ptie_check_integer(p->roi_y_px, 0, 32768, where, "roi_y_px");
}

ptie_status ptie_splitter_create(ptie_splitter **out, const ptie_splitter_params *params) {
    static const char where[] = "ptie_splitter_create";
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    *out = NULL;
    ptie_splitter_params known;
    ptie_splitter_params_init(&known);
    PTIE_TRY(ptie_params_read(&known, sizeof known, params, where));
    PTIE_TRY(check_splitter(&known, where));
    return ptie_prep_splitter(out, &known);
}

size_t ptie_splitter_scratch_bytes(const ptie_splitter *splitter) {
    return splitter ? ptie_prep_splitter_scratch(splitter) : 0;
}

ptie_status ptie_splitter_run(const ptie_splitter *splitter, float *const *channel,
                              const float *image, void *scratch) {
    static const char where[] = "ptie_splitter_run";
    PTIE_TRY(ptie_check_pointer(splitter, where, "splitter"));
    PTIE_TRY(ptie_check_pointer(channel, where, "channel"));
    PTIE_TRY(ptie_check_pointer(image, where, "image"));
    PTIE_TRY(ptie_check_scratch(scratch, where));
    ptie_prep_split(splitter, channel, image, scratch);
    return PTIE_OK;
}

ptie_status ptie_resampler_create(ptie_resampler **out, int32_t width_px, int32_t height_px,
                                  ptie_similarity place) {
    static const char where[] = "ptie_resampler_create";
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    *out = NULL;
    PTIE_TRY(ptie_check_integer(width_px, 4, 32768, where, "width_px"));
    PTIE_TRY(ptie_check_integer(height_px, 4, 32768, where, "height_px"));
    PTIE_TRY(ptie_check_number(place.shift_x_px, -32768, 32768, where, "shift_x_px"));
    PTIE_TRY(ptie_check_number(place.shift_y_px, -32768, 32768, where, "shift_y_px"));
    PTIE_TRY(ptie_check_number(place.magnification, 0.5, 2, where, "magnification"));
    PTIE_TRY(ptie_check_number(place.rotation_rad, -3.15, 3.15, where, "rotation_rad"));
    return ptie_prep_resampler(out, width_px, height_px, place);
}

size_t ptie_resampler_scratch_bytes(const ptie_resampler *resampler) {
    return resampler ? ptie_prep_resampler_scratch(resampler) : 0;
}

ptie_status ptie_resampler_run(const ptie_resampler *resampler, float *out, const float *plane,
                               void *scratch) {
    static const char where[] = "ptie_resampler_run";
    PTIE_TRY(ptie_check_pointer(resampler, where, "resampler"));
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    PTIE_TRY(ptie_check_pointer(plane, where, "plane"));
    PTIE_TRY(ptie_check_scratch(scratch, where));
    ptie_prep_resample(resampler, out, plane, scratch);
    return PTIE_OK;
}

ptie_status ptie_register(ptie_registration *out, const float *fixed, const float *moving,
                          const uint8_t *mask, int32_t width_px, int32_t height_px) {
    static const char where[] = "ptie_register";
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    PTIE_TRY(ptie_check_pointer(fixed, where, "fixed"));
    PTIE_TRY(ptie_check_pointer(moving, where, "moving"));
    PTIE_TRY(ptie_check_integer(width_px, 64, 32768, where, "width_px"));
    PTIE_TRY(ptie_check_integer(height_px, 64, 32768, where, "height_px"));
    return ptie_prep_register(out, fixed, moving, mask, width_px, height_px);
}

ptie_status ptie_opaque_mask(uint8_t *mask, const float *reference, int32_t width_px,
                             int32_t height_px, double below, int32_t clean_px, int32_t margin_px) {
    static const char where[] = "ptie_opaque_mask";
    PTIE_TRY(ptie_check_pointer(mask, where, "mask"));
    PTIE_TRY(check_image(reference, "reference", width_px, height_px, where));
    PTIE_TRY(ptie_check_number(below, 0, 1, where, "below"));
    PTIE_TRY(ptie_check_integer(clean_px, 0, 1024, where, "clean_px"));
    PTIE_TRY(ptie_check_integer(margin_px, 0, 1024, where, "margin_px"));
    return ptie_prep_opaque_mask(mask, reference, width_px, height_px, below, clean_px, margin_px);
}

static ptie_status check_surface(const ptie_surface_params *p, const char *where) {
    PTIE_TRY(ptie_check_integer(p->width_px, 4, 32768, where, "width_px"));
    PTIE_TRY(ptie_check_integer(p->height_px, 4, 32768, where, "height_px"));
    PTIE_TRY(ptie_check_integer(p->degree, 1, PTIE_SURFACE_DEGREE, where, "degree"));
    PTIE_TRY(ptie_check_integer(p->rounds, 0, 50, where, "rounds"));
    return ptie_check_number(p->reject, 1, 100, where, "reject");
}

ptie_status ptie_surface_create(ptie_surface **out, const ptie_surface_params *params,
                                const uint8_t *mask) {
    static const char where[] = "ptie_surface_create";
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    *out = NULL;
    ptie_surface_params known;
    ptie_surface_params_init(&known);
    PTIE_TRY(ptie_params_read(&known, sizeof known, params, where));
    PTIE_TRY(check_surface(&known, where));
    return ptie_prep_surface(out, &known, mask);
}

size_t ptie_surface_scratch_bytes(const ptie_surface *surface) {
    return surface ? ptie_prep_surface_scratch(surface) : 0;
}

ptie_status ptie_surface_remove(const ptie_surface *surface, float *map, void *scratch) {
    static const char where[] = "ptie_surface_remove";
    PTIE_TRY(ptie_check_pointer(surface, where, "surface"));
    PTIE_TRY(ptie_check_pointer(map, where, "map"));
    PTIE_TRY(ptie_check_scratch(scratch, where));
    return ptie_prep_surface_remove(surface, map, scratch);
}

ptie_status ptie_pin_region(float *map, int32_t width_px, int32_t height_px, ptie_rect region) {
    PTIE_TRY(check_image(map, "map", width_px, height_px, "ptie_pin_region"));
    PTIE_TRY(ptie_rect_check(region, width_px, height_px, "without flow"));
    ptie_prep_pin(map, width_px, height_px, region);
    return PTIE_OK;
}
