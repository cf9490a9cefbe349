/* SPDX-License-Identifier: BSD-3-Clause */
#include "bench/memory.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* A line of Linux's /proc/self/status, "VmHWM:   1234 kB". */
static double read_status(const char *key) {
    FILE *file = fopen("/proc/self/status", "r");
    char line[128];
    double kilobytes = (double)NAN;
    if (!file) return kilobytes;
    while (fgets(line, sizeof line, file))
        if (strncmp(line, key, strlen(key)) == 0) sscanf(line + strlen(key), "%lf", &kilobytes);
    fclose(file);
    return 1024 * kilobytes;
}

double ptie_bench_memory_start(void) {
    FILE *file = fopen("/proc/self/clear_refs", "w");
    if (!file) return (double)NAN;
    const bool reset = fputs("5", file) >= 0; /* proc(5): resets VmHWM */
    if (fclose(file) != 0 || !reset) return (double)NAN;
    return read_status("VmRSS:");
}

double ptie_bench_memory_peak(void) {
    return read_status("VmHWM:");
}
