/* SPDX-License-Identifier: BSD-3-Clause */
/* A context holds the worker threads and the chosen kernels.  Everything else is made from one. */
#ifndef PTIE_CONTEXT_H
#define PTIE_CONTEXT_H

#include <ptie/status.h>

typedef struct ptie_ctx ptie_ctx;

typedef struct ptie_ctx_params {
    uint32_t struct_size; /* set by ptie_ctx_params_init */
    int32_t threads;      /* 0 = all processors this process may use; else 1..256 */
    const char *cpu;      /* kernel level: "auto" (default), "scalar", "avx2", "avx512" */
} ptie_ctx_params;

PTIE_API void ptie_ctx_params_init(ptie_ctx_params *params);

/* Starts the worker threads.  `params` NULL means defaults.  Results never depend on the number of
   threads; between kernel levels they agree within the bounds of docs/math.md.
   Errors: PTIE_EINVAL (threads), PTIE_ENAME (cpu unknown or not available here), PTIE_ENOMEM.
   Thread rule: one call at a time may use a context; different contexts are independent. */
PTIE_API PTIE_NODISCARD ptie_status ptie_ctx_create(ptie_ctx **out, const ptie_ctx_params *params);

/* Stops the threads.  NULL is fine.  Everything made from the context must be freed before. */
PTIE_API void ptie_ctx_free(ptie_ctx *ctx);

/* Number of threads that work, the calling one included. */
PTIE_API int32_t ptie_ctx_threads(const ptie_ctx *ctx);

/* Kernel level in use: "scalar", "avx2" or "avx512".  Static. */
PTIE_API const char *ptie_ctx_cpu(const ptie_ctx *ctx);

/* 64-byte aligned memory for the scratch arguments of plans; NULL when there is none left.
   Free with ptie_scratch_free (NULL is fine).  Thread-safe. */
PTIE_API void *ptie_scratch_alloc(size_t bytes);
PTIE_API void ptie_scratch_free(void *scratch);

#endif
