/* SPDX-License-Identifier: BSD-3-Clause */
/* Measurements inside the library; contracts as in <ptie/bench.h>, arguments already checked.
 *
 * A group prepares what it measures and hands every measurement to ptie_bench_measure, which
 * repeats, times, compares with the peak and keeps the result.
 */
#ifndef PTIE_BENCH_BENCH_H
#define PTIE_BENCH_BENCH_H

#include <ptie/bench.h>

#include "kernel/engine.h"

ptie_status ptie_bench_groups(const ptie_engine *engine, const ptie_bench_params *params,
                              ptie_bench_result **results, size_t *count, ptie_progress progress);
/* NULL after the last. */
const char *ptie_bench_group_name(int32_t which);

/* Measurements under way. */
typedef struct ptie_bench {
    const ptie_engine *engine;
    double seconds;
    ptie_progress progress;
    const char *group;
    float *chains;      /* (threads, PTIE_CHAIN_FLOATS) */
    int64_t peak_calls; /* of multiply_add in one reading of the peak */
    ptie_bench_result *results;
    size_t count, total;
} ptie_bench;

typedef enum ptie_bench_mode {
    PTIE_BENCH_ONE,     /* the calling thread alone */
    PTIE_BENCH_EACH,    /* every thread at once, with data of its own */
    PTIE_BENCH_TOGETHER /* one call, which puts the threads to work itself */
} ptie_bench_mode;

enum { PTIE_BENCH_SAMPLES = 100 }; /* at most, per measurement */

typedef struct ptie_bench_samples {
    double rate[PTIE_BENCH_SAMPLES];  /* units/s */
    double share[PTIE_BENCH_SAMPLES]; /* of the peak at that moment */
    int32_t count;
} ptie_bench_samples;

typedef struct ptie_bench_case ptie_bench_case;
struct ptie_bench_case {
    char name[sizeof((ptie_bench_result *)0)->name];
    const char *unit; /* per second: "frames/s" */
    ptie_bench_mode mode;
    double amount; /* units in one call of `work` */
    double flops;  /* operations per unit; 0: not counted */
    ptie_status (*work)(void *context, int32_t worker);
    /* Takes the samples itself; NULL: repeats and times `work`. */
    ptie_status (*sample)(ptie_bench *bench, const ptie_bench_case *measured,
                          ptie_bench_samples *samples);
    void *context;
};

ptie_status ptie_bench_measure(ptie_bench *bench, const ptie_bench_case *measured);
/* The same for a value that needs no timing; NaN if it could not be found out. */
ptie_status ptie_bench_note(ptie_bench *bench, const char *name, const char *unit, double value);

/* No place for more, or the time has passed; a little longer where there are not three yet. */
bool ptie_bench_enough(const ptie_bench *bench, const ptie_bench_samples *samples,
                       double elapsed_s);

typedef struct ptie_bench_spread {
    double median, low, high;
} ptie_bench_spread;

/* Sorts at least one value: the middle one (mean of the middle two), the smallest, the largest. */
ptie_bench_spread ptie_bench_summarise(double *values, int32_t count);

/* Multiply-adds at full speed, in GFLOP/s.  Refers to the bench. */
ptie_bench_case ptie_bench_peak_case(ptie_bench *bench, const char *name, ptie_bench_mode mode);
/* How many of them make a reading of the peak; before the first measurement. */
ptie_status ptie_bench_calibrate_peak(ptie_bench *bench);

#endif
