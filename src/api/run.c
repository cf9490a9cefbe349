/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/run.h>: arguments checked, then inward. */
#include <ptie/run.h>

#include "api/context.h"
#include "api/params.h"
#include "run/denoise.h"
#include "run/rig.h"
#include "run/run.h"

void ptie_rig_init(ptie_rig *rig) {
    ptie_rig_defaults(rig);
}

ptie_status ptie_rig_load(ptie_rig *rig, const char *path) {
    PTIE_TRY(ptie_check_pointer(rig, "ptie_rig_load", "rig"));
    PTIE_TRY(ptie_check_pointer(path, "ptie_rig_load", "path"));
    ptie_rig read;
    PTIE_TRY(ptie_rig_read(&read, path));
    *rig = read;
    return PTIE_OK;
}

void ptie_run_params_init(ptie_run_params *params) {
    *params = (ptie_run_params){.struct_size = sizeof *params, .step = 1};
}

static ptie_status check_rig(const ptie_rig *rig) {
    static const char where[] = "ptie_run: rig";
    PTIE_TRY(ptie_check_positive(rig->wavelength_m, where, "wavelength_m"));
    PTIE_TRY(ptie_check_positive(rig->pixel_m, where, "pixel_m"));
    PTIE_TRY(ptie_check_number(rig->defocus_plus_m, -1e3, 1e3, where, "defocus_plus_m"));
    PTIE_TRY(ptie_check_number(rig->defocus_minus_m, -1e3, 1e3, where, "defocus_minus_m"));
    PTIE_TRY(ptie_check_number(rig->cutoff_m, 0, 1e6, where, "cutoff_m"));
    PTIE_TRY(ptie_check_integer((int64_t)rig->planes, PTIE_PLANES_PAIR, PTIE_PLANES_REFERENCE, where, "planes"));
    PTIE_TRY(ptie_check_integer(rig->polarity, -1, 1, where, "polarity"));
    PTIE_TRY(ptie_check_integer(rig->binning, 1, 64, where, "binning"));
    PTIE_TRY(ptie_check_integer((int64_t)rig->boundary, PTIE_PERIODIC, PTIE_MIRROR, where, "boundary"));
    if (rig->defocus_plus_m == 0 ||
        (rig->planes != PTIE_PLANES_REFERENCE && rig->defocus_minus_m >= rig->defocus_plus_m))
        return PTIE_FAIL(PTIE_EINVAL, "%s: defocus (expected plus above minus and not 0, found %g m and %g m)",
                         where, rig->defocus_plus_m, rig->defocus_minus_m);
    return PTIE_OK;
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
    PTIE_TRY(ptie_check_pointer(own.plus, where, "plus"));
    PTIE_TRY(ptie_check_pointer(own.output, where, "output"));
    PTIE_TRY(ptie_check_integer(own.first, 0, INT64_MAX, where, "first"));
    PTIE_TRY(ptie_check_integer(own.count, 0, INT64_MAX, where, "count"));
    PTIE_TRY(ptie_check_integer(own.step, 1, INT64_MAX, where, "step"));
    ptie_rig_init(&rig);
    PTIE_TRY(ptie_params_read(&rig, sizeof rig, own.rig, "ptie_run: rig"));
    PTIE_TRY(check_rig(&rig));
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
