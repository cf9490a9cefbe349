/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/average.h"

#include <math.h>

#include "base/clones.h"
#include "base/memory.h"

ptie_status ptie_average_create(ptie_average *a, size_t pixels) {
    *a = (ptie_average){.pixels = pixels};
    PTIE_TRY(ptie_alloc_status(&a->sum, pixels, sizeof *a->sum, "average"));
    return ptie_alloc_status(&a->squares, pixels, sizeof *a->squares, "average");
}

void ptie_average_free(ptie_average *a) {
    ptie_free(a->sum);
    ptie_free(a->squares);
    *a = (ptie_average){0};
}

PTIE_CLONES static void add(double *restrict sum, double *restrict squares, const float *restrict map, size_t pixels) {
    for (size_t i = 0; i < pixels; i++) {
        const double value = (double)map[i];
        sum[i] += value;
        squares[i] += value * value;
    }
}

void ptie_average_add(ptie_average *a, const float *map) {
    add(a->sum, a->squares, map, a->pixels);
    a->maps++;
}

void ptie_average_mean(const ptie_average *a, float *mean) {
    for (size_t i = 0; i < a->pixels; i++) mean[i] = (float)(a->sum[i] / (double)a->maps);
}

/* Sums of squares in double keep 8 digits of an rms 10,000 times smaller than the mean. */
void ptie_average_rms(const ptie_average *a, float *rms) {
    for (size_t i = 0; i < a->pixels; i++) {
        const double mean = a->sum[i] / (double)a->maps;
        rms[i] = (float)sqrt(fmax(a->squares[i] / (double)a->maps - mean * mean, 0));
    }
}
