/* SPDX-License-Identifier: BSD-3-Clause */
/* What the layers above compute with: threads and a table of kernels.  A ptie_ctx is one of these.
 */
#ifndef PTIE_KERNEL_ENGINE_H
#define PTIE_KERNEL_ENGINE_H

#include "base/cpu.h"
#include "base/pool.h"

struct ptie_kernels; /* kernel/kernel.h */

typedef struct ptie_engine {
    ptie_pool *pool;
    const struct ptie_kernels *kernels;
    ptie_cpu_level level;
} ptie_engine;

/* threads: 0 = all.  cpu: as ptie_ctx_params.cpu. */
ptie_status ptie_engine_start(ptie_engine *engine, int32_t threads, const char *cpu);
void ptie_engine_stop(ptie_engine *engine); /* fine on a zeroed engine */

#endif
