/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/camera.h>: arguments checked, then inward. */
#include <ptie/camera.h>

#include "api/params.h"
#include "optics/camera.h"

ptie_status ptie_camera_create(ptie_camera **out, const ptie_camera_params *params, int32_t width_px,
                               int32_t height_px, double pixel_m, uint64_t seed) {
    static const char where[] = "ptie_camera_create";
    ptie_camera_params own;
    ptie_camera_params_init(&own);
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    *out = NULL;
    PTIE_TRY(ptie_params_read(&own, sizeof own, params, where));
    PTIE_TRY(ptie_camera_check(&own, where));
    PTIE_TRY(ptie_check_integer(width_px, 2, 32768, where, "width_px"));
    PTIE_TRY(ptie_check_integer(height_px, 2, 32768, where, "height_px"));
    PTIE_TRY(ptie_check_number(pixel_m, 1e-9, 1, where, "pixel_m"));
    return ptie_camera_plan(out, &own, width_px, height_px, pixel_m, seed);
}

int32_t ptie_camera_sensors(const ptie_camera *camera) {
    return camera ? camera->sensors : 0;
}

size_t ptie_camera_scratch_bytes(const ptie_camera *camera) {
    return camera ? ptie_camera_scratch(camera) : 0;
}

ptie_status ptie_camera_light(const ptie_camera *camera, float *i_zero) {
    static const char where[] = "ptie_camera_light";
    PTIE_TRY(ptie_check_pointer(camera, where, "camera"));
    PTIE_TRY(ptie_check_pointer(i_zero, where, "i_zero"));
    ptie_camera_illuminate(camera, i_zero);
    return PTIE_OK;
}

ptie_status ptie_camera_expose(const ptie_camera *camera, float *const *counts, const float *plus,
                               const float *minus, ptie_exposure exposure, int64_t frame, void *scratch) {
    static const char where[] = "ptie_camera_expose";
    PTIE_TRY(ptie_check_pointer(camera, where, "camera"));
    PTIE_TRY(ptie_check_pointer(counts, where, "counts"));
    PTIE_TRY(ptie_check_scratch(scratch, where));
    PTIE_TRY(ptie_check_integer(exposure, PTIE_EXPOSE_FLOW, PTIE_EXPOSE_TARGET, where, "exposure"));
    PTIE_TRY(ptie_check_integer(frame, 0, INT64_C(1000000000000), where, "frame"));
    for (int32_t s = 0; s < camera->sensors; s++) PTIE_TRY(ptie_check_pointer(counts[s], where, "counts"));
    if (exposure != PTIE_EXPOSE_DARK) {
        PTIE_TRY(ptie_check_pointer(plus, where, "plus"));
        PTIE_TRY(ptie_check_pointer(minus, where, "minus"));
    }
    ptie_camera_capture(camera, counts, plus, minus, exposure, frame, scratch);
    return PTIE_OK;
}
