/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/preprocess.h>: arguments checked, then inward. */
#include <ptie/preprocess.h>

#include <math.h>

#include "api/params.h"
#include "prep/prep.h"
#include "prep/resample.h"

static ptie_status check_image(const void *image, const char *name, int32_t width, int32_t height,
                               const char *where) {
    PTIE_TRY(ptie_check_pointer(image, where, name));
    PTIE_TRY(ptie_check_integer(width, 1, 32768, where, "width_px"));
    return ptie_check_integer(height, 1, 32768, where, "height_px");
}

ptie_status ptie_flat_gain(float *gain, const float *reference, const uint8_t *mask, int32_t width_px,
                           int32_t height_px, double floor) {
    static const char where[] = "ptie_flat_gain";
    PTIE_TRY(ptie_check_pointer(gain, where, "gain"));
    PTIE_TRY(check_image(reference, "reference", width_px, height_px, where));
    PTIE_TRY(ptie_check_number(floor, 1e-6, 1, where, "floor"));
    return ptie_prep_flat_gain(gain, reference, mask, width_px, height_px, floor);
}

static ptie_status check_splitter(const ptie_splitter_params *p, const char *where) {
    PTIE_TRY(ptie_check_integer(p->width_px, 2, 32768, where, "width_px"));
    PTIE_TRY(ptie_check_integer(p->height_px, 2, 32768, where, "height_px"));
    PTIE_TRY(ptie_check_integer(p->layout, PTIE_LAYOUT_SEPARATE, PTIE_LAYOUT_QUADRANTS, where, "layout"));
    PTIE_TRY(ptie_check_integer(p->demosaic, PTIE_DEMOSAIC_NONE, PTIE_DEMOSAIC_FOURIER, where, "demosaic"));
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

ptie_status ptie_splitter_run(const ptie_splitter *splitter, float *const *channel, const float *image,
                              void *scratch) {
    static const char where[] = "ptie_splitter_run";
    PTIE_TRY(ptie_check_pointer(splitter, where, "splitter"));
    PTIE_TRY(ptie_check_pointer(channel, where, "channel"));
    PTIE_TRY(ptie_check_pointer(image, where, "image"));
    PTIE_TRY(ptie_check_scratch(scratch, where));
    ptie_prep_split(splitter, channel, image, scratch);
    return PTIE_OK;
}

ptie_status ptie_resampler_create(ptie_resampler **out, int32_t width_px, int32_t height_px, ptie_similarity place) {
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

ptie_status ptie_resampler_run(const ptie_resampler *resampler, float *out, const float *plane, void *scratch) {
    static const char where[] = "ptie_resampler_run";
    PTIE_TRY(ptie_check_pointer(resampler, where, "resampler"));
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    PTIE_TRY(ptie_check_pointer(plane, where, "plane"));
    PTIE_TRY(ptie_check_scratch(scratch, where));
    ptie_prep_resample(resampler, out, plane, scratch);
    return PTIE_OK;
}
