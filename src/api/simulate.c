/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/simulate.h>: arguments checked, then inward. */
#include <ptie/simulate.h>

#include <string.h>

#include "api/context.h"
#include "api/params.h"
#include "base/file.h"
#include "optics/camera.h"
#include "simulate/simulate.h"

#define MOST_FRAMES 100000000

void ptie_simulate_params_init(ptie_simulate_params *params) {
    ptie_optics_params optics;
    ptie_optics_params_init(&optics);
    *params = (ptie_simulate_params){
        .struct_size = sizeof *params,
        .frames = 20,
        .frame_rate_hz = 25e3,
        .defocus_m = optics.defocus_m,
        .boundary = optics.boundary,
        .propagation = optics.propagation,
        .noise = 0.05,
        .reference_frames = 32,
        .dark_frames = 32,
        .target_frames = 32,
    };
    ptie_flow_params_init(&params->flow);
}

/* Two planes side by side need HDF5; the ending keeps them apart from the rig. */
static ptie_status check_outputs(const ptie_simulate_params *p, const char *where) {
    PTIE_TRY(ptie_check_pointer(p->output, where, "output"));
    const char *ending = strrchr(p->output, '.');
    const bool one_image = p->camera && p->camera->layout == PTIE_CAMERA_MOSAIC;
    if (!one_image && (!ending || (strcmp(ending, ".h5") != 0 && strcmp(ending, ".hdf5") != 0)))
        return PTIE_FAIL(PTIE_EINVAL, "%s: cannot write two planes to this kind of file (expected .h5 or .hdf5)",
                         p->output);
    return ptie_output_differs(p->output, p->rig);
}

/* What the flow and the optics do not check themselves. */
static ptie_status check(const ptie_simulate_params *p, const char *where) {
    PTIE_TRY(check_outputs(p, where));
    PTIE_TRY(ptie_check_integer(p->reference_frames, 0, MOST_FRAMES, where, "reference_frames"));
    PTIE_TRY(ptie_check_integer(p->dark_frames, 0, MOST_FRAMES, where, "dark_frames"));
    PTIE_TRY(ptie_check_integer(p->target_frames, 0, MOST_FRAMES, where, "target_frames"));
    PTIE_TRY(ptie_check_integer(p->frames, 1, MOST_FRAMES, where, "frames"));
    PTIE_TRY(ptie_check_positive(p->frame_rate_hz, where, "frame_rate_hz"));
    PTIE_TRY(ptie_check_number(p->amplitude_rad, 0, 1e6, where, "amplitude_rad"));
    PTIE_TRY(ptie_check_number(p->noise, 0, 10, where, "noise"));
    PTIE_TRY(ptie_check_number(p->defocus_m, 1e-9, 1e3, where, "defocus_m"));
    PTIE_TRY(ptie_check_integer(p->boundary, PTIE_PERIODIC, PTIE_MIRROR, where, "boundary"));
    PTIE_TRY(ptie_check_integer(p->propagation, PTIE_TIE_SPECTRAL, PTIE_ANGULAR_SPECTRUM, where,
                                "propagation"));
    PTIE_TRY(ptie_check_integer(p->flow.width_px, 16, 32768, where, "flow.width_px"));
    PTIE_TRY(ptie_check_integer(p->flow.height_px, 16, 32768, where, "flow.height_px"));
    PTIE_TRY(ptie_check_number(p->flow.time_s, 0, 1e6, where, "flow.time_s"));
    PTIE_TRY(ptie_check_number(p->flow.time_s + (double)p->frames / p->frame_rate_hz, 0, 1e6, where,
                               "time of the last frame"));
    PTIE_TRY(ptie_check_number(p->flow.pixel_m, 1e-9, 1, where, "flow.pixel_m"));
    return ptie_check_number(p->flow.wavelength_m, 1e-12, 1e-2, where, "flow.wavelength_m");
}

ptie_status ptie_simulate(ptie_ctx *ctx, const ptie_simulate_params *params,
                          ptie_progress progress) {
    static const char where[] = "ptie_simulate";
    ptie_simulate_params own;
    ptie_camera_params camera;
    ptie_simulate_params_init(&own);
    ptie_camera_params_init(&camera);
    PTIE_TRY(ptie_check_pointer(ctx, where, "ctx"));
    PTIE_TRY(ptie_params_read(&own, sizeof own, params, where));
    if (own.camera) {
        PTIE_TRY(ptie_params_read(&camera, sizeof camera, own.camera, where));
        PTIE_TRY(ptie_camera_check(&camera, where));
        own.camera = &camera;
    }
    PTIE_TRY(check(&own, where));
    return ptie_simulate_run(ctx->engine.pool, &own, progress);
}
