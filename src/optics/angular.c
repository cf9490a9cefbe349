/* SPDX-License-Identifier: BSD-3-Clause */
/* Intensities by the angular spectrum.  docs/math.md (M7). */
#include "optics/plan.h"

/* side: +1 or -1 times the defocus. */
static void intensity_at(const ptie_optics *optics, float *intensity, float side, const ptie_wave *wave) {
    const size_t count = ptie_fft_image_floats(optics->fft);
    ptie_wave_propagate(optics->fft, wave, &optics->propagator, side);
    for (size_t i = 0; i < count; i++) {
        const float re = wave->re[i] + wave->change_re[i], im = wave->im[i] + wave->change_im[i];
        intensity[i] = re * re + im * im;
    }
}

void ptie_angular_defocus(const ptie_optics *optics, float *i_plus, float *i_minus,
                          const float *phase_rad, const float *i_zero, const ptie_wave *wave) {
    ptie_wave_set(optics->fft, wave, phase_rad, i_zero);
    intensity_at(optics, i_plus, +1, wave);
    intensity_at(optics, i_minus, -1, wave);
}
