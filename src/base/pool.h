/* SPDX-License-Identifier: BSD-3-Clause */
/* A small thread pool.  Workers take one index after the other; what a task computes must depend on
   its index only, so it never depends on how many threads there are.  `worker` only picks scratch
   memory. */
#ifndef PTIE_BASE_POOL_H
#define PTIE_BASE_POOL_H

#include "base/status.h"

typedef struct ptie_pool ptie_pool;

/* One task: index 0..count-1, worker 0..threads-1. */
typedef ptie_status (*ptie_task)(void *context, size_t index, int32_t worker);

/* threads: 0 = all processors this process may use. */
ptie_status ptie_pool_create(ptie_pool **out, int32_t threads);
void ptie_pool_free(ptie_pool *pool);
int32_t ptie_pool_threads(const ptie_pool *pool);

/* Runs task for every index and returns when all are done; the calling thread works too.  After a
   failure no further index is handed out; the failure with the lowest index is returned, with its
   message.  Not reentrant: a task must not use the pool it runs on. */
ptie_status ptie_pool_run(ptie_pool *pool, size_t count, ptie_task task, void *context);

#endif
