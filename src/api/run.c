/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/run.h>: arguments checked, then inward. */
#include <ptie/run.h>

#include "api/context.h"
#include "api/params.h"
#include "api/rig.h"
#include "run/denoise.h"
#include "run/run.h"

void ptie_run_params_init(ptie_run_params *params) {
    *params = (ptie_run_params){.struct_size = sizeof *params, .frames = {.step = 1}};
}

/* The rig that counts: the caller's, with the caller's files. */
static ptie_status read_rig(ptie_rig *rig, const ptie_run_params *params) {
    static const char where[] = "ptie_run: rig";
    PTIE_TRY(ptie_rig_take(rig, params->rig, where));
    PTIE_TRY(ptie_rig_replace(rig->reference, params->reference, where));
    PTIE_TRY(ptie_rig_replace(rig->dark, params->dark, where));
    return ptie_rig_replace(rig->mask, params->mask, where);
}

ptie_status ptie_run(ptie_ctx *ctx, const ptie_run_params *params, ptie_run_summary *summary,
                     ptie_progress progress) {
    static const char where[] = "ptie_run";
    PTIE_TRY(ptie_check_pointer(ctx, where, "ctx"));
    PTIE_TRY(ptie_check_pointer(summary, where, "summary"));
    ptie_run_params own;
    ptie_rig rig;
    ptie_run_params_init(&own);
    PTIE_TRY(ptie_params_read(&own, sizeof own, params, where));
    PTIE_TRY(ptie_check_pointer(own.output, where, "output"));
    PTIE_TRY(ptie_check_integer(own.frames.first, 0, INT64_MAX, where, "frames.first"));
    PTIE_TRY(ptie_check_integer(own.frames.end, 0, INT64_MAX, where, "frames.end"));
    PTIE_TRY(ptie_check_integer(own.frames.step, 1, INT64_MAX, where, "frames.step"));
    PTIE_TRY(read_rig(&rig, &own));
    own.rig = &rig;
    return ptie_run_pipeline(&ctx->engine, &own, summary, progress);
}

void ptie_denoise_params_init(ptie_denoise_params *params) {
    *params = (ptie_denoise_params){.struct_size = sizeof *params};
}

ptie_status ptie_denoise(ptie_ctx *ctx, const ptie_denoise_params *params, ptie_progress progress) {
    static const char where[] = "ptie_denoise";
    ptie_denoise_params own;
    ptie_denoise_params_init(&own);
    PTIE_TRY(ptie_check_pointer(ctx, where, "ctx"));
    PTIE_TRY(ptie_params_read(&own, sizeof own, params, where));
    PTIE_TRY(ptie_check_pointer(own.model, where, "model"));
    PTIE_TRY(ptie_check_pointer(own.input, where, "input"));
    PTIE_TRY(ptie_check_pointer(own.output, where, "output"));
    PTIE_TRY(ptie_check_integer(own.polarity, -1, 1, where, "polarity"));
    return ptie_denoise_recording(&ctx->engine, &own, progress);
}
