/* SPDX-License-Identifier: BSD-3-Clause */
/* Inverse plans: phi = (2 pi / lambda) F^-1( k^2 / (k^4 + k_c^4) F(dI/dz / I) ).  docs/math.md
 * (M5), (M6). */
#include "tie/solver.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "fft/fft.h"
#include "tie/derivative.h"

#define TWO_PI 6.283185307179586476925

struct ptie_solver {
    ptie_solver_params params;
    ptie_tie_weights weights;
    ptie_fft *fft;
    float *filter; /* rad m: phase per (dI/dz) / I */
};

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
    };
}

/* k = 0 carries no information: 0 makes the mean of the phase 0. */
static double inverse_response(double k2, const void *context) {
    const ptie_solver_params *p = context;
    const double cutoff = p->cutoff_m > 0 ? TWO_PI / p->cutoff_m : 0;
    return k2 > 0 ? TWO_PI / p->wavelength_m * k2 / (k2 * k2 + pow(cutoff, 4)) : 0;
}

static ptie_status prepare(ptie_solver *solver) {
    const ptie_solver_params *p = &solver->params;
    PTIE_TRY(ptie_tie_weigh(&solver->weights, p));
    PTIE_TRY(ptie_fft_create(&solver->fft,
                             p->boundary == PTIE_MIRROR ? PTIE_FFT_MIRROR : PTIE_FFT_REAL,
                             p->width_px, p->height_px));
    PTIE_TRY(ptie_alloc_status(&solver->filter, ptie_fft_filter_floats(solver->fft),
                               sizeof *solver->filter, "solver"));
    ptie_fft_filter_fill(solver->fft, solver->filter, p->pixel_m, inverse_response, p);
    return PTIE_OK;
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
    ptie_free(solver->filter);
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
    w.image = ptie_slice(slicer, ptie_fft_image_floats(solver->fft), sizeof(float));
    w.spectrum = ptie_slice(slicer, ptie_fft_spectrum_floats(solver->fft), sizeof(float));
    return w;
}

size_t ptie_tie_scratch(const ptie_solver *solver) {
    ptie_slicer slicer = {0};
    carve(solver, &slicer);
    return slicer.used;
}

ptie_status ptie_tie_solve(const ptie_solver *solver, float *phase_rad, const float *const *planes,
                           void *scratch, ptie_solver_report *report) {
    assert((uintptr_t)scratch % PTIE_ALIGNMENT == 0);
    const work w = carve(solver, &(ptie_slicer){.base = scratch});
    const ptie_solver_params *p = &solver->params;
    PTIE_TRY(ptie_tie_derivative(w.image, &solver->weights, planes, p->width_px, p->height_px));
    ptie_fft_forward(solver->fft, w.spectrum, w.image);
    ptie_fft_filter_apply(solver->fft, w.spectrum, solver->filter);
    ptie_fft_inverse(solver->fft, w.image, w.spectrum);
    memcpy(phase_rad, w.image, ptie_fft_image_floats(solver->fft) * sizeof *phase_rad);
    if (report) *report = (ptie_solver_report){.iterations = 1};
    return PTIE_OK;
}

/* White noise of variance v per pixel of dI/dz leaves v times the filter's mean power (M8). */
double ptie_tie_noise_rad(const ptie_solver *solver, double sigma) {
    const ptie_tie_weights *w = &solver->weights;
    double squares = 0;
    for (int32_t i = 0; i < w->count; i++) squares += w->weight[i] * w->weight[i];
    return sigma * sqrt(squares * ptie_fft_filter_power(solver->fft, solver->filter));
}
