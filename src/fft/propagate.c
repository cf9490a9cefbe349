/* SPDX-License-Identifier: BSD-3-Clause */
#include "fft/propagate.h"

#include <math.h>
#include <string.h>

#include "base/clones.h"

#define TWO_PI 6.283185307179586476925

typedef struct distance {
    double k0, z_m;
} distance;

/* Phase of H relative to a plane wave: z (k_z - k0) = -z k^2 / (k0 + k_z), no cancellation. */
static bool transfer_phase(double k2, const distance *d, double *phase) {
    if (k2 > d->k0 * d->k0) return false; /* evanescent: H = 0 */
    *phase = -d->z_m * k2 / (d->k0 + sqrt(d->k0 * d->k0 - k2));
    return true;
}

static double loss_at(double k2, const void *context) {
    double phase;
    if (!transfer_phase(k2, context, &phase)) return -1;
    const double half = sin(phase / 2);
    return -2 * half * half; /* cos - 1 */
}

static double turn_at(double k2, const void *context) {
    double phase;
    return transfer_phase(k2, context, &phase) ? sin(phase) : 0;
}

ptie_status ptie_propagator_fill(ptie_propagator *propagator, const ptie_fft *fft, double pixel_m,
                                 double wavelength_m, double z_m) {
    const size_t entries = ptie_fft_filter_floats(fft);
    const distance d = {TWO_PI / wavelength_m, z_m};
    PTIE_TRY(ptie_alloc_status(&propagator->loss, entries, sizeof(float), "propagator"));
    PTIE_TRY(ptie_alloc_status(&propagator->turn, entries, sizeof(float), "propagator"));
    ptie_fft_filter_fill(fft, propagator->loss, pixel_m, loss_at, &d);
    ptie_fft_filter_fill(fft, propagator->turn, pixel_m, turn_at, &d);
    return PTIE_OK;
}

void ptie_propagator_clear(ptie_propagator *propagator) {
    ptie_free(propagator->loss);
    ptie_free(propagator->turn);
    *propagator = (ptie_propagator){0};
}

ptie_wave ptie_wave_slice(const ptie_fft *fft, ptie_slicer *slicer) {
    const size_t image = ptie_fft_image_floats(fft), spectrum = ptie_fft_spectrum_floats(fft);
    ptie_wave wave;
    wave.re = ptie_slice(slicer, image, sizeof(float));
    wave.im = ptie_slice(slicer, image, sizeof(float));
    wave.spectrum_re = ptie_slice(slicer, spectrum, sizeof(float));
    wave.spectrum_im = ptie_slice(slicer, spectrum, sizeof(float));
    wave.change_re = ptie_slice(slicer, image, sizeof(float));
    wave.change_im = ptie_slice(slicer, image, sizeof(float));
    wave.work = ptie_slice(slicer, spectrum, sizeof(float));
    return wave;
}

void ptie_wave_set(const ptie_fft *fft, const ptie_wave *wave, const float *phase_rad,
                   const float *intensity) {
    const size_t count = ptie_fft_image_floats(fft);
    for (size_t i = 0; i < count; i++) {
        const float amplitude = intensity ? sqrtf(intensity[i]) : 1;
        wave->re[i] = amplitude * cosf(phase_rad[i]);
        wave->im[i] = amplitude * sinf(phase_rad[i]);
    }
    /* Transforms destroy what they read. */
    memcpy(wave->change_re, wave->re, count * sizeof *wave->re);
    memcpy(wave->change_im, wave->im, count * sizeof *wave->im);
    ptie_fft_forward(fft, wave->spectrum_re, wave->change_re);
    ptie_fft_forward(fft, wave->spectrum_im, wave->change_im);
}

/* out: loss u + sign turn v. */
PTIE_CLONES static void combine(float *restrict out, const float *restrict u, const float *restrict v,
                                const ptie_propagator *h, float sign, size_t entries, size_t parts) {
    for (size_t i = 0; i < entries; i++) {
        const float loss = h->loss[i], turn = sign * h->turn[i];
        for (size_t j = i * parts; j < (i + 1) * parts; j++) out[j] = loss * u[j] + turn * v[j];
    }
}

void ptie_wave_propagate(const ptie_fft *fft, const ptie_wave *wave, const ptie_propagator *propagator,
                         float side) {
    const size_t entries = ptie_fft_filter_floats(fft), parts = ptie_fft_entry_floats(fft);
    combine(wave->work, wave->spectrum_re, wave->spectrum_im, propagator, -side, entries, parts);
    ptie_fft_inverse(fft, wave->change_re, wave->work);
    combine(wave->work, wave->spectrum_im, wave->spectrum_re, propagator, side, entries, parts);
    ptie_fft_inverse(fft, wave->change_im, wave->work);
}
