/* SPDX-License-Identifier: BSD-3-Clause */
/* What the machine can do at best. */
#include <string.h>

#include "base/memory.h"
#include "bench/groups.h"

/* What all threads together copy in one call: more than caches hold. */
enum { COPY_BYTES = 128 << 20 };

typedef struct copies {
    unsigned char *from, *to;
    size_t part; /* bytes of a thread */
} copies;

static ptie_status copy(void *context, int32_t worker) {
    const copies *c = context;
    const size_t first = (size_t)worker * c->part;
    memcpy(c->to + first, c->from + first, c->part);
    return PTIE_OK;
}

static ptie_status measure_copy(ptie_bench *bench) {
    const size_t threads = (size_t)ptie_pool_threads(bench->engine->pool);
    copies c = {.part = COPY_BYTES / threads};
    ptie_status status;
    PTIE_TRY_DONE(ptie_alloc_status(&c.from, COPY_BYTES, 1, "bench"));
    PTIE_TRY_DONE(ptie_alloc_status(&c.to, COPY_BYTES, 1, "bench"));
    memset(c.from, 1, COPY_BYTES); /* pages that were never written may all be the same one */
    status = ptie_bench_measure(
        bench, &(ptie_bench_case){.name = "memory copy, all threads",
                                  .unit = "GB/s",
                                  .mode = PTIE_BENCH_EACH,
                                  .amount = 2e-9 * (double)c.part, /* read, written */
                                  .work = copy,
                                  .context = &c});
done:
    ptie_free(c.from);
    ptie_free(c.to);
    return status;
}

ptie_status ptie_bench_peak(ptie_bench *bench) {
    const ptie_bench_case one =
        ptie_bench_peak_case(bench, "multiply-add, 1 thread", PTIE_BENCH_ONE);
    const ptie_bench_case all =
        ptie_bench_peak_case(bench, "multiply-add, all threads", PTIE_BENCH_EACH);
    PTIE_TRY(ptie_bench_measure(bench, &one));
    PTIE_TRY(ptie_bench_measure(bench, &all));
    return measure_copy(bench);
}
