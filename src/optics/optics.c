/* SPDX-License-Identifier: BSD-3-Clause */
/* Forward plans: what is prepared once, what a run needs, and which propagation does it. */
#include "optics/optics.h"

#include <assert.h>
#include <math.h>

#include "base/clones.h"
#include "base/image.h"
#include "base/memory.h"
#include "optics/plan.h"

void ptie_optics_params_init(ptie_optics_params *params) {
    *params = (ptie_optics_params){
        .struct_size = sizeof *params,
        .width_px = 256,
        .height_px = 256,
        .pixel_m = 20e-6,
        .wavelength_m = 532e-9,
        .defocus_m = 10e-3,
        .boundary = PTIE_PERIODIC,
        .propagation = PTIE_TIE_SPECTRAL,
    };
}

static ptie_status prepare(ptie_optics *optics) {
    const ptie_optics_params *p = &optics->params;
    if (p->propagation == PTIE_TIE_STENCIL) return PTIE_OK;
    PTIE_TRY(ptie_fft_create(&optics->fft,
                             p->boundary == PTIE_MIRROR ? PTIE_FFT_MIRROR : PTIE_FFT_REAL,
                             p->width_px, p->height_px));
    if (p->propagation == PTIE_ANGULAR_SPECTRUM)
        return ptie_propagator_fill(&optics->propagator, optics->fft, p->pixel_m, p->wavelength_m,
                                    p->defocus_m);
    PTIE_TRY(ptie_alloc_status(&optics->signal, ptie_fft_filter_floats(optics->fft), sizeof *optics->signal,
                               "optics"));
    ptie_fft_filter_fill(optics->fft, optics->signal, p->pixel_m, ptie_linear_response, optics);
    return PTIE_OK;
}

ptie_status ptie_optics_plan(ptie_optics **out, const ptie_optics_params *params) {
    ptie_optics *optics;
    *out = NULL;
    PTIE_TRY(ptie_alloc_status(&optics, 1, sizeof *optics, "optics"));
    optics->params = *params;
    ptie_status status = prepare(optics);
    if (status != PTIE_OK) {
        ptie_optics_free(optics);
        return status;
    }
    *out = optics;
    return PTIE_OK;
}

void ptie_optics_free(ptie_optics *optics) {
    if (!optics) return;
    ptie_fft_free(optics->fft);
    ptie_free(optics->signal);
    ptie_propagator_clear(&optics->propagator);
    ptie_free(optics);
}

static ptie_optics_work carve(const ptie_optics *optics, ptie_slicer *slicer) {
    const size_t pixels = (size_t)optics->params.width_px * (size_t)optics->params.height_px;
    ptie_optics_work work = {.image = ptie_slice(slicer, pixels, sizeof(float))};
    if (optics->fft)
        work.spectrum = ptie_slice(slicer, ptie_fft_spectrum_floats(optics->fft), sizeof(float));
    return work;
}

size_t ptie_optics_scratch(const ptie_optics *optics) {
    ptie_slicer slicer = {0};
    if (optics->params.propagation == PTIE_ANGULAR_SPECTRUM)
        ptie_wave_slice(optics->fft, &slicer);
    else
        carve(optics, &slicer);
    return slicer.used;
}

/* Linear TIE has one intensity for the whole image. */
static ptie_status constant_intensity(float *value, const float *i_zero,
                                      const ptie_optics_params *p) {
    const size_t w = (size_t)p->width_px, pixels = w * (size_t)p->height_px;
    *value = i_zero ? i_zero[0] : 1;
    for (size_t i = 0; i_zero && i < pixels; i++)
        if (i_zero[i] != *value)
            return PTIE_FAIL(
                PTIE_EINVAL,
                "i_zero: linear TIE needs a constant intensity (at x=%zu, y=%zu; expected "
                "%g, found %g); use the angular spectrum",
                i % w, i / w, (double)*value, (double)i_zero[i]);
    return PTIE_OK;
}

/* I+- = I0 (1 +- signal).  The darker plane is counted from the rounded brighter one: their
   difference, which carries the phase, is then rounded once and at the finer step (docs/math.md
   M9). */
PTIE_CLONES static void set_planes(float *i_plus, float *i_minus, const float *signal, double intensity,
                       size_t count) {
    for (size_t i = 0; i < count; i++) {
        const double step = intensity * fabs((double)signal[i]);
        const float bright = (float)(intensity + step), dark = (float)((double)bright - 2 * step);
        i_plus[i] = signal[i] < 0 ? dark : bright;
        i_minus[i] = signal[i] < 0 ? bright : dark;
    }
}

static ptie_status linear_defocus(const ptie_optics *optics, float *i_plus, float *i_minus,
                                  const float *phase_rad, const float *i_zero,
                                  const ptie_optics_work *work) {
    const ptie_optics_params *p = &optics->params;
    float intensity;
    PTIE_TRY(constant_intensity(&intensity, i_zero, p));
    if (p->propagation == PTIE_TIE_SPECTRAL)
        ptie_linear_signal_spectral(optics, phase_rad, work);
    else
        ptie_linear_signal_stencil(optics, phase_rad, work);
    set_planes(i_plus, i_minus, work->image, (double)intensity,
               (size_t)p->width_px * (size_t)p->height_px);
    return PTIE_OK;
}

static ptie_status check_intensity(const float *i_zero, const ptie_optics_params *p) {
    PTIE_TRY(ptie_image_finite(i_zero, p->width_px, p->height_px, "i_zero"));
    const size_t w = (size_t)p->width_px, pixels = w * (size_t)p->height_px;
    for (size_t i = 0; i < pixels; i++)
        if (i_zero[i] < 0)
            return PTIE_FAIL(
                PTIE_ENUMERIC,
                "i_zero: intensity is negative (at x=%zu, y=%zu; expected >= 0, found %g)", i % w,
                i / w, (double)i_zero[i]);
    return PTIE_OK;
}

ptie_status ptie_optics_defocus(const ptie_optics *optics, float *i_plus, float *i_minus,
                                const float *phase_rad, const float *i_zero, void *scratch) {
    const ptie_optics_params *p = &optics->params;
    assert((uintptr_t)scratch % PTIE_ALIGNMENT == 0);
    PTIE_TRY(ptie_image_finite(phase_rad, p->width_px, p->height_px, "phase_rad"));
    if (i_zero) PTIE_TRY(check_intensity(i_zero, p));
    ptie_slicer slicer = {.base = scratch};
    if (p->propagation == PTIE_ANGULAR_SPECTRUM) {
        const ptie_wave wave = ptie_wave_slice(optics->fft, &slicer);
        ptie_angular_defocus(optics, i_plus, i_minus, phase_rad, i_zero, &wave);
        return PTIE_OK;
    }
    const ptie_optics_work work = carve(optics, &slicer);
    return linear_defocus(optics, i_plus, i_minus, phase_rad, i_zero, &work);
}
