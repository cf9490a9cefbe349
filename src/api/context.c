/* SPDX-License-Identifier: BSD-3-Clause */
#include "api/context.h"

#include "api/params.h"
#include "base/memory.h"

void ptie_ctx_params_init(ptie_ctx_params *params) {
    *params = (ptie_ctx_params){.struct_size = sizeof *params, .cpu = "auto"};
}

ptie_status ptie_ctx_create(ptie_ctx **out, const ptie_ctx_params *params) {
    static const char where[] = "ptie_ctx_create";
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    *out = NULL;
    ptie_ctx_params own;
    ptie_ctx_params_init(&own);
    if (params) PTIE_TRY(ptie_params_read(&own, sizeof own, params, where));

    ptie_ctx *ctx;
    PTIE_TRY(ptie_alloc_status(&ctx, 1, sizeof *ctx, where));
    ptie_status status = ptie_engine_start(&ctx->engine, own.threads, own.cpu);
    if (status != PTIE_OK) {
        ptie_ctx_free(ctx);
        return status;
    }
    *out = ctx;
    return PTIE_OK;
}

void ptie_ctx_free(ptie_ctx *ctx) {
    if (!ctx) return;
    ptie_engine_stop(&ctx->engine);
    ptie_free(ctx);
}

int32_t ptie_ctx_threads(const ptie_ctx *ctx) {
    return ptie_pool_threads(ctx->engine.pool);
}

const char *ptie_ctx_cpu(const ptie_ctx *ctx) {
    return ptie_cpu_name(ctx->engine.level);
}

void *ptie_scratch_alloc(size_t bytes) {
    return ptie_alloc(bytes, 1);
}

void ptie_scratch_free(void *scratch) {
    ptie_free(scratch);
}
