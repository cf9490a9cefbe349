/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/prepare.h>: arguments checked, then inward. */
#include <ptie/prepare.h>

#include "api/context.h"
#include "api/params.h"
#include "api/rig.h"
#include "run/prepare_planes.h"

void ptie_prepare_params_init(ptie_prepare_params *params) {
    *params = (ptie_prepare_params){
        .struct_size = sizeof *params, .until = PTIE_STEP_MASK, .frames = {.step = 1}};
}

ptie_status ptie_prepare_planes(ptie_ctx *ctx, const ptie_prepare_params *params,
                                ptie_progress progress) {
    static const char where[] = "ptie_prepare_planes";
    ptie_prepare_params own;
    ptie_rig rig;
    ptie_prepare_params_init(&own);
    PTIE_TRY(ptie_check_pointer(ctx, where, "ctx"));
    PTIE_TRY(ptie_params_read(&own, sizeof own, params, where));
    PTIE_TRY(ptie_check_pointer(own.output, where, "output"));
    PTIE_TRY(ptie_check_integer(own.frames.first, 0, INT64_MAX, where, "frames.first"));
    PTIE_TRY(ptie_check_integer(own.frames.end, 0, INT64_MAX, where, "frames.end"));
    PTIE_TRY(ptie_check_integer(own.frames.step, 1, INT64_MAX, where, "frames.step"));
    PTIE_TRY(
        ptie_check_integer((int64_t)own.until, PTIE_STEP_DARK, PTIE_STEP_MASK, where, "until"));
    PTIE_TRY(ptie_rig_take(&rig, own.rig, where));
    PTIE_TRY(ptie_rig_replace(rig.reference, own.reference, where));
    PTIE_TRY(ptie_rig_replace(rig.dark, own.dark, where));
    PTIE_TRY(ptie_rig_replace(rig.mask, own.mask, where));
    own.rig = &rig;
    return ptie_prepare_recording(ctx->engine.pool, &own, progress);
}
