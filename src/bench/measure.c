/* SPDX-License-Identifier: BSD-3-Clause */
/* Repeats, times, compares with the peak. */
#include "bench/bench.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "kernel/kernel.h"

/* A sample takes this part of a measurement's time. */
#define SAMPLE_SHARE (1.0 / 20)
/* A reading of the peak: long beside the waking of threads, which takes some 50 us. */
#define PEAK_S 8e-3

bool ptie_bench_enough(const ptie_bench *bench, const ptie_bench_samples *samples,
                       double elapsed_s) {
    enum { FEW = 3 };
    const double limit_s = bench->seconds * (samples->count < FEW ? FEW : 1);
    return samples->count == PTIE_BENCH_SAMPLES || (samples->count > 0 && elapsed_s >= limit_s);
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

ptie_bench_spread ptie_bench_summarise(double *values, int32_t count) {
    assert(count >= 1);
    qsort(values, (size_t)count, sizeof *values, ascending);
    return (ptie_bench_spread){.median = (values[(count - 1) / 2] + values[count / 2]) / 2,
                               .low = values[0],
                               .high = values[count - 1]};
}

static int32_t threads_of(const ptie_bench *bench, ptie_bench_mode mode) {
    return mode == PTIE_BENCH_ONE ? 1 : ptie_pool_threads(bench->engine->pool);
}

/* How many threads do the same at once. */
static int32_t copies_of(const ptie_bench *bench, ptie_bench_mode mode) {
    return mode == PTIE_BENCH_EACH ? ptie_pool_threads(bench->engine->pool) : 1;
}

/* What the threads take one after the other. */
static ptie_status call_once(void *context, size_t index, int32_t worker) {
    (void)index;
    const ptie_bench_case *const *measured = context;
    return (*measured)->work((*measured)->context, worker);
}

static ptie_status call_often(const ptie_bench *bench, const ptie_bench_case *measured,
                              int64_t calls) {
    if (measured->mode == PTIE_BENCH_EACH)
        return ptie_pool_run(bench->engine->pool, (size_t)calls, call_once, &measured);
    for (int64_t i = 0; i < calls; i++) PTIE_TRY(measured->work(measured->context, 0));
    return PTIE_OK;
}

static ptie_status time_calls(const ptie_bench *bench, const ptie_bench_case *measured,
                              int64_t calls, double *seconds) {
    const double start_s = ptie_now_s();
    PTIE_TRY(call_often(bench, measured, calls));
    *seconds = fmax(ptie_now_s() - start_s, 1e-9); /* a clock may stand still */
    return PTIE_OK;
}

/* Calls that take about `seconds`, as many for every copy; what it does to find out also warms
   caches and clocks. */
static ptie_status calibrate(const ptie_bench *bench, const ptie_bench_case *measured,
                             double seconds, int64_t *calls) {
    const int64_t copies = copies_of(bench, measured->mode);
    int64_t each = 1;
    double taken;
    PTIE_TRY(time_calls(bench, measured, each * copies, &taken));
    while (taken < seconds / 4) PTIE_TRY(time_calls(bench, measured, (each *= 2) * copies, &taken));
    *calls = (int64_t)ceil((double)each * seconds / taken) * copies;
    return PTIE_OK;
}

/* Units per second, of all copies together. */
static ptie_status sample_rate(const ptie_bench *bench, const ptie_bench_case *measured,
                               int64_t calls, double *rate) {
    double seconds;
    PTIE_TRY(time_calls(bench, measured, calls, &seconds));
    *rate = (double)calls * measured->amount / seconds;
    return PTIE_OK;
}

/* The peak. */

enum { ROUNDS = 20000 }; /* in one call: some 50 microseconds */

static ptie_status multiply_add(void *context, int32_t worker) {
    const ptie_bench *bench = context;
    bench->engine->kernels->multiply_add(bench->chains + (size_t)worker * PTIE_CHAIN_FLOATS, 0.999f,
                                         0.001f, ROUNDS);
    return PTIE_OK;
}

ptie_bench_case ptie_bench_peak_case(ptie_bench *bench, const char *name, ptie_bench_mode mode) {
    ptie_bench_case peak = {.unit = "GFLOP/s",
                            .mode = mode == PTIE_BENCH_ONE ? PTIE_BENCH_ONE : PTIE_BENCH_EACH,
                            .amount = 2e-9 * PTIE_CHAIN_FLOATS * ROUNDS,
                            .work = multiply_add,
                            .context = bench};
    snprintf(peak.name, sizeof peak.name, "%s", name);
    return peak;
}

ptie_status ptie_bench_calibrate_peak(ptie_bench *bench) {
    const ptie_bench_case peak = ptie_bench_peak_case(bench, "peak", PTIE_BENCH_ONE);
    return calibrate(bench, &peak, PEAK_S, &bench->peak_calls);
}

/* One reading, in GFLOP/s. */
static ptie_status read_peak(ptie_bench *bench, ptie_bench_mode mode, double *gflops) {
    const ptie_bench_case peak = ptie_bench_peak_case(bench, "peak", mode);
    return sample_rate(bench, &peak, bench->peak_calls * copies_of(bench, peak.mode), gflops);
}

/* Samples. */

/* A reading of the peak follows each sample. */
static ptie_status take_samples(ptie_bench *bench, const ptie_bench_case *measured,
                                ptie_bench_samples *samples) {
    const double start_s = ptie_now_s();
    double rate, peak = 1;
    int64_t calls;
    PTIE_TRY(calibrate(bench, measured, bench->seconds * SAMPLE_SHARE, &calls));
    do {
        PTIE_TRY(sample_rate(bench, measured, calls, &rate));
        if (measured->flops > 0) PTIE_TRY(read_peak(bench, measured->mode, &peak));
        samples->rate[samples->count] = rate;
        samples->share[samples->count++] = 1e-9 * measured->flops * rate / peak;
    } while (!ptie_bench_enough(bench, samples, ptie_now_s() - start_s));
    return PTIE_OK;
}

static ptie_status read_peaks(ptie_bench *bench, ptie_bench_mode mode, double *gflops) {
    enum { READINGS = 5 };
    double reading[READINGS];
    for (int i = 0; i < READINGS; i++) PTIE_TRY(read_peak(bench, mode, &reading[i]));
    *gflops = ptie_bench_summarise(reading, READINGS).median;
    return PTIE_OK;
}

/* Work that cannot be interrupted: the peak before and after, the larger of the two. */
static ptie_status take_own_samples(ptie_bench *bench, const ptie_bench_case *measured,
                                    ptie_bench_samples *samples) {
    double before, after;
    PTIE_TRY(read_peaks(bench, measured->mode, &before));
    PTIE_TRY(measured->sample(bench, measured, samples));
    PTIE_TRY(read_peaks(bench, measured->mode, &after));
    for (int32_t i = 0; i < samples->count; i++)
        samples->share[i] = 1e-9 * measured->flops * samples->rate[i] / fmax(before, after);
    return PTIE_OK;
}

/* The next place among the results, announced. */
static ptie_status begin(ptie_bench *bench, const char *name, const char *unit,
                         ptie_bench_result **result) {
    char note[128];
    assert(bench->count < bench->total);
    snprintf(note, sizeof note, "%s: %s", bench->group, name);
    PTIE_TRY(ptie_progress_report(bench->progress, bench->count, bench->total, note));
    const double none = (double)NAN;
    *result = &bench->results[bench->count++];
    **result = (ptie_bench_result){.group = bench->group,
                                   .unit = unit,
                                   .gflops = none,
                                   .peak_gflops = none,
                                   .peak_share = none};
    snprintf((*result)->name, sizeof(*result)->name, "%s", name);
    return PTIE_OK;
}

ptie_status ptie_bench_measure(ptie_bench *bench, const ptie_bench_case *measured) {
    ptie_bench_result *result;
    ptie_bench_samples samples = {.count = 0};
    PTIE_TRY(begin(bench, measured->name, measured->unit, &result));
    PTIE_TRY((measured->sample ? take_own_samples : take_samples)(bench, measured, &samples));
    const ptie_bench_spread rate = ptie_bench_summarise(samples.rate, samples.count);
    result->median = rate.median;
    result->low = rate.low;
    result->high = rate.high;
    result->samples = samples.count;
    result->threads = threads_of(bench, measured->mode);
    if (measured->flops > 0) {
        result->gflops = 1e-9 * measured->flops * rate.median;
        result->peak_share = ptie_bench_summarise(samples.share, samples.count).median;
        result->peak_gflops = result->gflops / result->peak_share;
    }
    return PTIE_OK;
}

ptie_status ptie_bench_note(ptie_bench *bench, const char *name, const char *unit, double value) {
    ptie_bench_result *result;
    PTIE_TRY(begin(bench, name, unit, &result));
    result->median = result->low = result->high = value;
    result->samples = 1;
    result->threads = ptie_pool_threads(bench->engine->pool);
    return PTIE_OK;
}
