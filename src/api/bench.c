/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/bench.h>: arguments checked, then inward. */
#include <ptie/bench.h>

#include "api/context.h"
#include "api/params.h"
#include "base/memory.h"
#include "bench/bench.h"

void ptie_bench_params_init(ptie_bench_params *params) {
    *params = (ptie_bench_params){.struct_size = sizeof *params, .seconds = 1};
}

const char *ptie_bench_group(int32_t which) {
    return ptie_bench_group_name(which);
}

ptie_status ptie_bench_run(ptie_ctx *ctx, const ptie_bench_params *params,
                           ptie_bench_result **results, size_t *count, ptie_progress progress) {
    static const char where[] = "ptie_bench_run";
    PTIE_TRY(ptie_check_pointer(results, where, "results"));
    *results = NULL;
    PTIE_TRY(ptie_check_pointer(count, where, "count"));
    *count = 0;
    PTIE_TRY(ptie_check_pointer(ctx, where, "ctx"));
    ptie_bench_params own;
    ptie_bench_params_init(&own);
    if (params) PTIE_TRY(ptie_params_read(&own, sizeof own, params, where));
    PTIE_TRY(ptie_check_number(own.seconds, 1e-4, 3600, where, "seconds"));
    return ptie_bench_groups(&ctx->engine, &own, results, count, progress);
}

void ptie_bench_free(ptie_bench_result *results) {
    ptie_free(results);
}
