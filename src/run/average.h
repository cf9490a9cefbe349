/* SPDX-License-Identifier: BSD-3-Clause */
/* Mean over time and rms about it, pixel by pixel, of maps that come one after the other. */
#ifndef PTIE_RUN_AVERAGE_H
#define PTIE_RUN_AVERAGE_H

#include "base/status.h"

typedef struct ptie_average {
    double *sum, *squares; /* per pixel */
    size_t pixels;
    int64_t maps;
} ptie_average;

ptie_status ptie_average_create(ptie_average *average, size_t pixels);
void ptie_average_free(ptie_average *average);

void ptie_average_add(ptie_average *average, const float *map);
/* Of the maps so far, at least one. */
void ptie_average_mean(const ptie_average *average, float *mean);
void ptie_average_rms(const ptie_average *average, float *rms);

#endif
