/* SPDX-License-Identifier: BSD-3-Clause */
/* Power spectral density of maps, averaged over directions and maps. */
#ifndef PTIE_REPORT_SPECTRUM_H
#define PTIE_REPORT_SPECTRUM_H

#include "fft/fft.h"

typedef struct ptie_spectrum {
    ptie_fft *fft;
    float *image, *modes; /* of one map */
    double pixel_m;
    int32_t width_px, height_px, bins, maps;
    double *sum, *modes_in; /* per bin: sum of squares; modes of one map */
} ptie_spectrum;

ptie_status ptie_spectrum_create(ptie_spectrum *spectrum, int32_t width_px, int32_t height_px, double pixel_m);
void ptie_spectrum_free(ptie_spectrum *spectrum);

/* The mirror's modes (DCT-II): a map needs no window for them. */
void ptie_spectrum_add(ptie_spectrum *spectrum, const float *map);

/* Of bin 0 .. bins-1: angular frequency at its middle, rad/m; density in (unit of the map)^2 m^2, such that its
   integral over d^2q / (2 pi)^2 is the variance.  NaN for a bin without modes. */
double ptie_spectrum_q(const ptie_spectrum *spectrum, int32_t bin);
double ptie_spectrum_density(const ptie_spectrum *spectrum, int32_t bin);

#endif
