/* SPDX-License-Identifier: BSD-3-Clause */
#include "kernel/engine.h"

#include <assert.h>

#include "kernel/kernel.h"

extern const ptie_kernels ptie_kernels_scalar;
#ifdef PTIE_VEC_LEVELS
extern const ptie_kernels ptie_kernels_avx2, ptie_kernels_avx512;
#endif

const ptie_kernels *ptie_kernels_of(ptie_cpu_level level) {
    switch (level) {
    case PTIE_CPU_SCALAR: return &ptie_kernels_scalar;
#ifdef PTIE_VEC_LEVELS
    case PTIE_CPU_AVX2: return &ptie_kernels_avx2;
    case PTIE_CPU_AVX512: return &ptie_kernels_avx512;
#endif
    default: return NULL;
    }
}

ptie_status ptie_engine_start(ptie_engine *engine, int32_t threads, const char *cpu) {
    *engine = (ptie_engine){0};
    PTIE_TRY(ptie_cpu_choose(&engine->level, cpu));
    engine->kernels = ptie_kernels_of(engine->level);
    assert(engine->kernels); /* only levels that are built are detected */
    return ptie_pool_create(&engine->pool, threads);
}

void ptie_engine_stop(ptie_engine *engine) {
    ptie_pool_free(engine->pool);
    *engine = (ptie_engine){0};
}
