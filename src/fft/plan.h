/* SPDX-License-Identifier: BSD-3-Clause */
/* A transform's inside, for the files of this folder. */
#ifndef PTIE_FFT_PLAN_H
#define PTIE_FFT_PLAN_H

#include <fftw3.h>

#include "fft/fft.h"

struct ptie_fft {
    ptie_fft_kind kind;
    int32_t width, height;
    double scale; /* of the inverse */
    fftwf_plan forward, inverse;
    float *turns_x, *turns_y; /* of the mirrored kind: (cos, sin) of pi k / 2 n; mirror.c */
};

/* The mirrored kind, over the plans of a real transform in place. */
ptie_status ptie_mirror_prepare(ptie_fft *fft);
void ptie_mirror_forward(const ptie_fft *fft, float *spectrum, float *image);
void ptie_mirror_inverse(const ptie_fft *fft, float *image, float *spectrum);

#endif
