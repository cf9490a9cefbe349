/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/convert.h>: arguments checked, then inward. */
#include <ptie/convert.h>

#include "api/context.h"
#include "api/params.h"
#include "report/colormap.h"
#include "run/convert.h"

enum { LEVELS = 256 };

void ptie_convert_params_init(ptie_convert_params *params) {
    *params = (ptie_convert_params){.struct_size = sizeof *params, .frames = {.step = 1}, .played_hz = 25};
}

ptie_status ptie_convert(ptie_ctx *ctx, const ptie_convert_params *params, ptie_progress progress) {
    static const char where[] = "ptie_convert";
    ptie_convert_params own;
    ptie_convert_params_init(&own);
    PTIE_TRY(ptie_check_pointer(ctx, where, "ctx"));
    PTIE_TRY(ptie_params_read(&own, sizeof own, params, where));
    PTIE_TRY(ptie_check_pointer(own.input, where, "input"));
    PTIE_TRY(ptie_check_pointer(own.output, where, "output"));
    if (own.name) PTIE_TRY(ptie_check_name(own.name, where));
    PTIE_TRY(ptie_check_integer(own.frames.first, 0, INT64_MAX, where, "frames.first"));
    PTIE_TRY(ptie_check_integer(own.frames.end, 0, INT64_MAX, where, "frames.end"));
    PTIE_TRY(ptie_check_integer(own.frames.step, 1, INT64_MAX, where, "frames.step"));
    PTIE_TRY(ptie_check_number(own.low, -1e30, 1e30, where, "low"));
    PTIE_TRY(ptie_check_number(own.high, own.low, 1e30, where, "high"));
    PTIE_TRY(ptie_check_integer((int64_t)own.colours, PTIE_GRAY, PTIE_DIVERGING, where, "colours"));
    PTIE_TRY(ptie_check_number(own.played_hz, 1e-3, 1e3, where, "played_hz"));
    uint32_t colours[LEVELS];
    for (int i = 0; i < LEVELS; i++) colours[i] = ptie_colour(own.colours, i / (LEVELS - 1.0));
    return ptie_convert_recording(ctx->engine.pool, &own, own.colours == PTIE_GRAY ? NULL : colours,
                                  progress);
}
