/* SPDX-License-Identifier: BSD-3-Clause */
/* How fast the library runs on this machine: its kernels, inference, training, generation of
 * samples, solving, and the whole pipeline.  docs/bench.md says how to read the numbers.
 *
 * Work is repeated until one sample takes about a twentieth of the time that a measurement may
 * take; samples are taken until that time has passed (three times as long, where there are not
 * three yet). Where the operations are known, their rate is set against the rate of multiply-adds
 * that the processor reaches at best, which is measured after every sample on as many threads:
 * machines that are shared or hot change from one second to the next.
 */
#ifndef PTIE_BENCH_H
#define PTIE_BENCH_H

#include <ptie/context.h>

typedef struct ptie_bench_params {
    uint32_t struct_size; /* set by ptie_bench_params_init */
    const char *groups;   /* names of ptie_bench_group, separated by commas; NULL (default): all */
    double seconds;       /* per measurement, 1e-4..3600, default 1 */
} ptie_bench_params;

PTIE_API void ptie_bench_params_init(ptie_bench_params *params);

/* Names of the groups, in the order they are measured; NULL after the last.  Static. */
PTIE_API const char *ptie_bench_group(int32_t which);

typedef struct ptie_bench_result {
    const char *group;        /* one of ptie_bench_group; static */
    char name[64];            /* what was measured, unique in its group */
    const char *unit;         /* of median, low and high: "GFLOP/s", "frames/s", ...; static */
    double median, low, high; /* over the samples; NaN if this system does not tell (memory) */
    int32_t samples;
    int32_t threads; /* that worked at the same time */
    /* Arithmetic of the median, in 1e9 operations/s; a multiply-add counts as two.  Counted as the
       direct formula needs them: a kernel that saves operations can pass the peak.  NaN where they
       are not counted, as in what memory limits. */
    double gflops;
    double peak_share;  /* median of the samples' rate over that of multiply-adds; NaN as above */
    double peak_gflops; /* gflops / peak_share; NaN as above */
} ptie_bench_result;

/* params NULL means defaults.  Measures the groups on the context's kernels and threads.  *results
   (out): `count` of them, to be freed with ptie_bench_free.  Some groups write files to a folder of
   their own below $TMPDIR (or /tmp) and remove it. progress: one unit per measurement; the note
   says which one is next. Thread rule: the context's; what else the machine does meanwhile shows in
   the numbers. Errors: PTIE_EINVAL, PTIE_ENAME (unknown group: names the nearest), PTIE_ENOMEM,
   PTIE_EIO, PTIE_ECANCELLED. */
PTIE_API PTIE_NODISCARD ptie_status ptie_bench_run(ptie_ctx *ctx, const ptie_bench_params *params,
                                                   ptie_bench_result **results, size_t *count,
                                                   ptie_progress progress);
PTIE_API void ptie_bench_free(ptie_bench_result *results); /* NULL is fine */

#endif
