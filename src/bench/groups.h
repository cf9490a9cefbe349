/* SPDX-License-Identifier: BSD-3-Clause */
/* The groups.  How many measurements each makes stands in bench.c. */
#ifndef PTIE_BENCH_GROUPS_H
#define PTIE_BENCH_GROUPS_H

#include "bench/bench.h"

/* Multiply-adds on one thread and on all, copying memory. */
ptie_status ptie_bench_peak(ptie_bench *bench);
/* Every kernel at the shapes of the paper's network. */
ptie_status ptie_bench_kernels(ptie_bench *bench);
int32_t ptie_bench_kernels_count(const ptie_engine *engine);
/* 3x3 convolutions of other widths. */
ptie_status ptie_bench_family(ptie_bench *bench);
int32_t ptie_bench_family_count(const ptie_engine *engine);
ptie_status ptie_bench_inference(ptie_bench *bench);
ptie_status ptie_bench_training(ptie_bench *bench);
ptie_status ptie_bench_generation(ptie_bench *bench);
ptie_status ptie_bench_solving(ptie_bench *bench);
/* Recording to phase, from file to file and in memory. */
ptie_status ptie_bench_pipeline(ptie_bench *bench);

/* Does the kernels group measure this kernel? */
bool ptie_bench_has_kernel(const char *name);

#endif
