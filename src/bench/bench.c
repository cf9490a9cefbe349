/* SPDX-License-Identifier: BSD-3-Clause */
/* Which groups, in which order. */
#include "bench/bench.h"

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "bench/groups.h"
#include "kernel/kernel.h"

typedef struct group {
    const char *name;
    ptie_status (*run)(ptie_bench *bench);
    int32_t measurements;                        /* so many, unless */
    int32_t (*count)(const ptie_engine *engine); /* this knows how many */
} group;

static const group groups[] = {
    {"peak", ptie_bench_peak, 3, NULL},
    {"kernels", ptie_bench_kernels, 0, ptie_bench_kernels_count},
    {"family", ptie_bench_family, 0, ptie_bench_family_count},
    {"inference", ptie_bench_inference, 10, NULL},
    {"training", ptie_bench_training, 3, NULL},
    {"generation", ptie_bench_generation, 2, NULL},
    {"solving", ptie_bench_solving, 4, NULL},
    {"run", ptie_bench_pipeline, 2, NULL},
};
enum { GROUPS = sizeof groups / sizeof *groups };

const char *ptie_bench_group_name(int32_t which) {
    return which >= 0 && which < GROUPS ? groups[which].name : NULL;
}

static ptie_status choose_one(bool chosen[GROUPS], const char *name) {
    const char *names[GROUPS + 1] = {0};
    for (int i = 0; i < GROUPS; i++) {
        names[i] = groups[i].name;
        if (strcmp(name, names[i]) != 0) continue;
        chosen[i] = true;
        return PTIE_OK;
    }
    return PTIE_FAIL(PTIE_ENAME, "bench: unknown group '%s' (did you mean '%s'?)", name,
                     ptie_nearest_word(name, names));
}

/* "peak,kernels" */
static ptie_status choose(bool chosen[GROUPS], const char *list) {
    memset(chosen, !list, GROUPS * sizeof *chosen);
    while (list) {
        const char *comma = strchr(list, ',');
        const size_t length = comma ? (size_t)(comma - list) : strlen(list);
        char name[32];
        snprintf(name, sizeof name, "%.*s", (int)length, list);
        PTIE_TRY(choose_one(chosen, name));
        list = comma ? comma + 1 : NULL;
    }
    return PTIE_OK;
}

static ptie_status measure(ptie_bench *bench, const bool chosen[GROUPS]) {
    for (int i = 0; i < GROUPS; i++) {
        if (!chosen[i]) continue;
        bench->group = groups[i].name;
        PTIE_TRY(groups[i].run(bench));
    }
    return ptie_progress_report(bench->progress, bench->count, bench->total, NULL);
}

ptie_status ptie_bench_groups(const ptie_engine *engine, const ptie_bench_params *params,
                              ptie_bench_result **results, size_t *count, ptie_progress progress) {
    static const char where[] = "bench";
    const size_t threads = (size_t)ptie_pool_threads(engine->pool);
    ptie_bench bench = {.engine = engine, .seconds = params->seconds, .progress = progress};
    bool chosen[GROUPS];
    *results = NULL;
    *count = 0;
    PTIE_TRY(choose(chosen, params->groups));
    for (int i = 0; i < GROUPS; i++)
        if (chosen[i])
            bench.total +=
                (size_t)(groups[i].count ? groups[i].count(engine) : groups[i].measurements);

    ptie_status status;
    PTIE_TRY_DONE(
        ptie_alloc_status(&bench.chains, threads * PTIE_CHAIN_FLOATS, sizeof(float), where));
    PTIE_TRY_DONE(ptie_alloc_status(&bench.results, bench.total, sizeof *bench.results, where));
    PTIE_TRY_DONE(ptie_bench_calibrate_peak(&bench));
    PTIE_TRY_DONE(measure(&bench, chosen));
    *results = bench.results;
    *count = bench.count;
    bench.results = NULL;
done:
    ptie_free(bench.results);
    ptie_free(bench.chains);
    return status;
}
