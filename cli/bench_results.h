/* SPDX-License-Identifier: BSD-3-Clause */
/* Measurements with what they were made on, as a table or as JSON (docs/bench.md). */
#ifndef CLI_BENCH_RESULTS_H
#define CLI_BENCH_RESULTS_H

#include <stdio.h>

#include <ptie/bench.h>
#include <ptie/machine.h>

typedef struct bench_results {
    ptie_machine machine;
    const char *level;
    int32_t threads;
    double seconds; /* per measurement */
    ptie_bench_result *results;
    size_t count;
} bench_results;

/* On stdout. */
void print_bench_table(const bench_results *results, bool markdown);
void print_bench_json(FILE *out, const bench_results *results);

#endif
