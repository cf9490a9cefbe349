/* SPDX-License-Identifier: BSD-3-Clause */
/* Inverse plans: phi = (2 pi / lambda) F^-1( k^2 / (k^4 + k_c^4) F(dI/dz / I) ).  docs/math.md
 * (M5), (M6). */
#include "tie/solver.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "tie/inner.h"

#define TWO_PI 6.283185307179586476925

void ptie_solver_params_init(ptie_solver_params *params) {
    *params = (ptie_solver_params){
        .struct_size = sizeof *params,
        .width_px = 256,
        .height_px = 256,
        .pixel_m = 20e-6,
        .wavelength_m = 532e-9,
        .plane_count = 2,
        .z_m = {10e-3, -10e-3},
        .boundary = PTIE_PERIODIC,
        .max_iterations = 100,
    };
}

/* k = 0 carries no information: 0 makes the mean of the phase 0. */
static double inverse_response(double k2, const void *context) {
    const ptie_solver_params *p = context;
    const double cutoff = p->cutoff_m > 0 ? TWO_PI / p->cutoff_m : 0;
    return k2 > 0 ? TWO_PI / p->wavelength_m * k2 / (k2 * k2 + pow(cutoff, 4)) : 0;
}

static ptie_status copy_mask(ptie_solver *solver) {
    ptie_solver_params *p = &solver->params;
    if (!p->mask) return PTIE_OK;
    const size_t pixels = ptie_solver_pixels(solver);
    PTIE_TRY(ptie_alloc_status(&solver->mask, pixels, 1, "solver"));
    for (size_t i = 0; i < pixels; i++) solver->mask[i] = p->mask[i] != 0;
    p->mask = solver->mask;
    if (!memchr(p->mask, 1, pixels))
        return PTIE_FAIL(PTIE_EINVAL, "solver: the mask leaves no light (expected a pixel that is 1)");
    PTIE_TRY(ptie_alloc_status(&solver->reached, pixels, 1, "solver"));
    memcpy(solver->reached, p->mask, pixels);
    ptie_tie_spread(solver->reached, p->width_px, p->height_px, 1, ptie_tie_reach(p));
    return PTIE_OK;
}

static ptie_status prepare_propagators(ptie_solver *solver) {
    const ptie_solver_params *p = &solver->params;
    const ptie_tie_weights *w = &solver->weights;
    for (int32_t i = 0; i < w->count; i++)
        if (!w->pixelwise || i != w->base)
            PTIE_TRY(ptie_propagator_fill(&solver->propagator[i], solver->fft, p->pixel_m, p->wavelength_m,
                                          p->z_m[i]));
    return PTIE_OK;
}

static ptie_status prepare(ptie_solver *solver) {
    const ptie_solver_params *p = &solver->params;
    if (p->method == PTIE_SOLVE_ITERATIVE_DCT && p->boundary != PTIE_MIRROR)
        return PTIE_FAIL(PTIE_EINVAL,
                         "solver: the iterative DCT has the mirror boundary (expected PTIE_MIRROR, found %d)",
                         (int)p->boundary);
    PTIE_TRY(copy_mask(solver));
    PTIE_TRY(ptie_tie_weigh(&solver->weights, p));
    PTIE_TRY(ptie_fft_create(&solver->fft,
                             p->boundary == PTIE_MIRROR ? PTIE_FFT_MIRROR : PTIE_FFT_REAL,
                             p->width_px, p->height_px));
    PTIE_TRY(ptie_alloc_status(&solver->inverse, ptie_fft_filter_floats(solver->fft), sizeof *solver->inverse,
                               "solver"));
    ptie_fft_filter_fill(solver->fft, solver->inverse, p->pixel_m, inverse_response, p);
    if (p->method == PTIE_SOLVE_DIRECT) return PTIE_OK;
    if (ptie_solver_divides_by_light(solver)) PTIE_TRY(ptie_poisson_prepare(&solver->poisson, p));
    return prepare_propagators(solver);
}

ptie_status ptie_tie_plan(ptie_solver **out, const ptie_solver_params *params) {
    ptie_solver *solver;
    *out = NULL;
    PTIE_TRY(ptie_alloc_status(&solver, 1, sizeof *solver, "solver"));
    solver->params = *params;
    ptie_status status = prepare(solver);
    if (status != PTIE_OK) {
        ptie_solver_free(solver);
        return status;
    }
    *out = solver;
    return PTIE_OK;
}

void ptie_solver_free(ptie_solver *solver) {
    if (!solver) return;
    ptie_fft_free(solver->fft);
    ptie_free(solver->inverse);
    ptie_poisson_clear(&solver->poisson);
    for (int32_t i = 0; i < PTIE_MAX_PLANES; i++) ptie_propagator_clear(&solver->propagator[i]);
    ptie_free(solver->mask);
    ptie_free(solver->reached);
    ptie_free(solver);
}

int32_t ptie_tie_planes(const ptie_solver *solver) {
    return solver->params.plane_count;
}

typedef struct work {
    float *image, *spectrum;
} work;

static work carve(const ptie_solver *solver, ptie_slicer *slicer) {
    work w;
    w.image = ptie_slice(slicer, ptie_solver_pixels(solver), sizeof(float));
    w.spectrum = ptie_slice(slicer, ptie_fft_spectrum_floats(solver->fft), sizeof(float));
    return w;
}

size_t ptie_tie_scratch(const ptie_solver *solver) {
    if (solver->params.method != PTIE_SOLVE_DIRECT) return ptie_tie_iterate_scratch(solver);
    ptie_slicer slicer = {0};
    carve(solver, &slicer);
    return slicer.used;
}

void ptie_tie_invert(const ptie_solver *solver, float *image, float *spectrum) {
    ptie_fft_forward(solver->fft, spectrum, image);
    ptie_fft_filter_apply(solver->fft, spectrum, solver->inverse);
    ptie_fft_inverse(solver->fft, image, spectrum);
}

void ptie_tie_level(const ptie_solver *solver, float *phase_rad) {
    const uint8_t *mask = solver->mask;
    const size_t pixels = ptie_solver_pixels(solver);
    double sum = 0;
    size_t lit = 0;
    for (size_t i = 0; i < pixels; i++)
        if (!mask || mask[i]) sum += (double)phase_rad[i], lit++;
    const float mean = (float)(sum / (double)lit);
    for (size_t i = 0; i < pixels; i++) phase_rad[i] -= mean;
    ptie_tie_blank(phase_rad, mask, pixels);
}

/* measured: may be w.spectrum. */
static ptie_status solve_direct(const ptie_solver *solver, float *phase_rad, float *measured, const work *w,
                                const float *const *planes) {
    PTIE_TRY(ptie_tie_derivative(w->image, &solver->weights, planes));
    ptie_fft_forward(solver->fft, measured, w->image);
    ptie_fft_filter_to(solver->fft, w->spectrum, measured, solver->inverse);
    ptie_fft_inverse(solver->fft, w->image, w->spectrum);
    memcpy(phase_rad, w->image, ptie_solver_pixels(solver) * sizeof *phase_rad);
    if (solver->mask) ptie_tie_level(solver, phase_rad);
    return PTIE_OK;
}

ptie_status ptie_tie_solve_direct(const ptie_solver *solver, float *phase_rad, float *measured,
                                  const float *const *planes, void *scratch) {
    assert(solver->params.method == PTIE_SOLVE_DIRECT && (uintptr_t)scratch % PTIE_ALIGNMENT == 0);
    const work w = carve(solver, &(ptie_slicer){.base = scratch});
    return solve_direct(solver, phase_rad, measured, &w, planes);
}

ptie_status ptie_tie_solve(const ptie_solver *solver, float *phase_rad, const float *const *planes,
                           void *scratch, ptie_solver_report *report) {
    assert((uintptr_t)scratch % PTIE_ALIGNMENT == 0);
    if (solver->params.method != PTIE_SOLVE_DIRECT)
        return ptie_tie_iterate(solver, phase_rad, planes, scratch, report);
    const work w = carve(solver, &(ptie_slicer){.base = scratch});
    if (report) *report = (ptie_solver_report){.iterations = 1};
    return solve_direct(solver, phase_rad, w.spectrum, &w, planes);
}

/* White noise of variance v per pixel of dI/dz leaves v times the filter's mean power (M8). */
double ptie_tie_noise_rad(const ptie_solver *solver, double sigma) {
    return sigma * sqrt(ptie_tie_noise_gain(&solver->weights) * ptie_fft_filter_power(solver->fft, solver->inverse));
}
