/* SPDX-License-Identifier: BSD-3-Clause */
/* Angular spectrum: scalar diffraction without approximation.  docs/math.md (M7).
 *
 * The transfer function H = C + i S depends on k^2 only, so C and S are real convolutions that keep
 * the boundary's symmetry: the parts a and b of the wave a + i b go through real transforms (FFT or
 * DCT), and
 *
 *     a' = C a - S b,   b' = S a + C b   at +dz,   with S -> -S at -dz.
 */
#include <math.h>

#include "optics/plan.h"

#define TWO_PI 6.283185307179586476925

/* Phase of H relative to a plane wave: dz (k_z - k0) = -dz k^2 / (k0 + k_z), no cancellation. */
static bool transfer_phase(double k2, const ptie_optics_params *p, double *phase) {
    const double k0 = TWO_PI / p->wavelength_m;
    if (k2 > k0 * k0) return false; /* evanescent */
    *phase = -p->defocus_m * k2 / (k0 + sqrt(k0 * k0 - k2));
    return true;
}

double ptie_angular_response_re(double k2, const void *context) {
    double phase;
    return transfer_phase(k2, &((const ptie_optics *)context)->params, &phase) ? cos(phase) : 0;
}

double ptie_angular_response_im(double k2, const void *context) {
    double phase;
    return transfer_phase(k2, &((const ptie_optics *)context)->params, &phase) ? sin(phase) : 0;
}

/* Spectra of the real and imaginary part of sqrt(I0) exp(i phi). */
static void wave_in_focus(const ptie_optics *optics, const float *phase_rad, const float *i_zero,
                          const ptie_optics_work *work) {
    const size_t count = ptie_fft_image_floats(optics->fft);
    for (int part = 0; part < 2; part++) {
        for (size_t i = 0; i < count; i++) {
            const float wave = part == 0 ? cosf(phase_rad[i]) : sinf(phase_rad[i]);
            work->image[i] = i_zero ? sqrtf(i_zero[i]) * wave : wave;
        }
        ptie_fft_forward(optics->fft, part == 0 ? work->u_re : work->u_im, work->image);
    }
}

/* work->image (out): C u + sign S v. */
static void propagate_part(const ptie_optics *optics, const float *u, const float *v, float sign,
                           const ptie_optics_work *work) {
    const size_t filter_floats = ptie_fft_filter_floats(optics->fft);
    const size_t parts = ptie_fft_entry_floats(optics->fft);
    for (size_t i = 0; i < filter_floats; i++) {
        const float re = optics->h_re[i], im = sign * optics->h_im[i];
        for (size_t j = i * parts; j < (i + 1) * parts; j++)
            work->spectrum[j] = re * u[j] + im * v[j];
    }
    ptie_fft_inverse(optics->fft, work->image, work->spectrum);
}

/* side: +1 or -1 times the defocus. */
static void intensity_at(const ptie_optics *optics, float *intensity, float side,
                         const ptie_optics_work *work) {
    const size_t count = ptie_fft_image_floats(optics->fft);
    const float *image = work->image;
    propagate_part(optics, work->u_re, work->u_im, -side, work);
    for (size_t i = 0; i < count; i++) intensity[i] = image[i] * image[i];
    propagate_part(optics, work->u_im, work->u_re, side, work);
    for (size_t i = 0; i < count; i++) intensity[i] += image[i] * image[i];
}

void ptie_angular_defocus(const ptie_optics *optics, float *i_plus, float *i_minus,
                          const float *phase_rad, const float *i_zero,
                          const ptie_optics_work *work) {
    wave_in_focus(optics, phase_rad, i_zero, work);
    intensity_at(optics, i_plus, +1, work);
    intensity_at(optics, i_minus, -1, work);
}
