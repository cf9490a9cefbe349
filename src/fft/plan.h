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
};

/* Floats per spectrum entry: complex or real. */
static inline size_t ptie_fft_entry_floats(const ptie_fft *fft) {
    return fft->kind == PTIE_FFT_MIRROR ? 1 : 2;
}

#endif
