/* SPDX-License-Identifier: BSD-3-Clause */
/* Time that only goes forward. */
#ifndef PTIE_BASE_CLOCK_H
#define PTIE_BASE_CLOCK_H

#include <time.h>

/* Seconds since some moment. */
static inline double ptie_now_s(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#endif
