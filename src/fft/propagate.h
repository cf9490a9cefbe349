/* SPDX-License-Identifier: BSD-3-Clause */
/* Angular spectrum: scalar diffraction without approximation.  docs/math.md (M7).
 *
 * The transfer function H = C + i S depends on k^2 only, so C and S are real convolutions that keep the
 * boundary's symmetry: the parts a and b of the wave a + i b go through real transforms (FFT or DCT).  What
 * is computed is the change (H - 1) U, small at small distances, so that it does not drown in the rounding
 * of the wave itself.
 */
#ifndef PTIE_FFT_PROPAGATE_H
#define PTIE_FFT_PROPAGATE_H

#include "base/memory.h"
#include "fft/fft.h"

/* To a distance z, and to -z. */
typedef struct ptie_propagator {
    float *loss, *turn; /* C - 1 and S per spectrum entry */
} ptie_propagator;

ptie_status ptie_propagator_fill(ptie_propagator *propagator, const ptie_fft *fft, double pixel_m,
                                 double wavelength_m, double z_m);
void ptie_propagator_clear(ptie_propagator *propagator);

/* A wave in focus, its spectra, and room for what propagation adds to it. */
typedef struct ptie_wave {
    float *re, *im;
    float *spectrum_re, *spectrum_im;
    float *change_re, *change_im;
    float *work; /* spectrum */
} ptie_wave;

ptie_wave ptie_wave_slice(const ptie_fft *fft, ptie_slicer *slicer);

/* wave = sqrt(intensity) exp(i phase).  intensity: NULL for 1. */
void ptie_wave_set(const ptie_fft *fft, const ptie_wave *wave, const float *phase_rad,
                   const float *intensity);

/* wave->change_* (out): (H - 1) U at z (side +1) or -z (side -1) of the propagator. */
void ptie_wave_propagate(const ptie_fft *fft, const ptie_wave *wave, const ptie_propagator *propagator,
                         float side);

#endif
