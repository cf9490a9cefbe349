/* SPDX-License-Identifier: BSD-3-Clause */
/* How much memory the process takes, as the system counts it. */
#ifndef PTIE_BENCH_MEMORY_H
#define PTIE_BENCH_MEMORY_H

/* Bytes in use now; from here on the peak is counted anew.  NaN where the system does not tell. */
double ptie_bench_memory_start(void);
/* The most that was in use since. */
double ptie_bench_memory_peak(void);

#endif
