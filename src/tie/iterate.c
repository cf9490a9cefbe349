/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps of maximum intensity or of two Poisson equations, each on what the phase so far leaves of dI/dz under
 * diffraction.  docs/math.md (M11)-(M13). */
#include <math.h>
#include <string.h>

#include "tie/inner.h"

#define ENOUGH 1e-3 /* of the largest dI/dz left: done */
#define WORSE 1.05  /* largest left grows by this from step to step: noise, or divergence */

typedef struct work {
    float *light, *measured, *left, *phase; /* (H, W) */
    /* One after the other: a step, and a look at what it leaves. */
    float *image, *spectrum;
    ptie_poisson_work poisson;
    ptie_wave wave;
} work;

static work carve(const ptie_solver *solver, ptie_slicer *slicer) {
    const size_t pixels = ptie_solver_pixels(solver);
    work w = {0};
    w.light = ptie_slice(slicer, pixels, sizeof(float));
    w.measured = ptie_slice(slicer, pixels, sizeof(float));
    w.left = ptie_slice(slicer, pixels, sizeof(float));
    w.phase = ptie_slice(slicer, pixels, sizeof(float));
    ptie_slicer step = *slicer;
    if (ptie_solver_divides_by_light(solver))
        w.poisson = ptie_poisson_slice(&solver->poisson, &step);
    else {
        w.image = ptie_slice(&step, pixels, sizeof(float));
        w.spectrum = ptie_slice(&step, ptie_fft_spectrum_floats(solver->fft), sizeof(float));
    }
    w.wave = ptie_wave_slice(solver->fft, slicer);
    if (slicer->used < step.used) slicer->used = step.used;
    return w;
}

size_t ptie_tie_iterate_scratch(const ptie_solver *solver) {
    ptie_slicer slicer = {0};
    carve(solver, &slicer);
    return slicer.used;
}

/* predicted (out): dI/dz of the wave sqrt(light) exp(i phase) by the angular spectrum. */
static void diffract(const ptie_solver *solver, float *predicted, const float *phase_rad, const float *light,
                     const ptie_wave *wave) {
    const ptie_tie_weights *weights = &solver->weights;
    const size_t pixels = ptie_solver_pixels(solver);
    memset(predicted, 0, pixels * sizeof *predicted);
    ptie_wave_set(solver->fft, wave, phase_rad, light);
    for (int32_t p = 0; p < weights->count; p++) {
        if (!solver->propagator[p].loss) continue; /* in focus: no change */
        ptie_wave_propagate(solver->fft, wave, &solver->propagator[p], 1);
        for (size_t i = 0; i < pixels; i++) {
            const double a = (double)wave->change_re[i], b = (double)wave->change_im[i];
            const double change = a * (2 * (double)wave->re[i] + a) + b * (2 * (double)wave->im[i] + b);
            predicted[i] += (float)(weights->weight[p] * change);
        }
    }
}

static void take_step(const ptie_solver *solver, const work *w) {
    if (ptie_solver_divides_by_light(solver)) {
        ptie_poisson_step(solver, w->phase, w->left, w->light, &w->poisson);
        return;
    }
    const size_t pixels = ptie_solver_pixels(solver);
    memcpy(w->image, w->left, pixels * sizeof *w->image);
    ptie_tie_invert(solver, w->image, w->spectrum);
    for (size_t i = 0; i < pixels; i++) w->phase[i] += w->image[i];
}

static float largest(const float *image, size_t count) {
    float value = image[0];
    for (size_t i = 1; i < count; i++)
        if (!(image[i] <= value)) value = image[i]; /* NaN stays */
    return value;
}

/* What the phase so far does not explain; returns its largest value. */
static double look_at_rest(const ptie_solver *solver, const work *w) {
    const size_t pixels = ptie_solver_pixels(solver);
    diffract(solver, w->left, w->phase, w->light, &w->wave);
    for (size_t i = 0; i < pixels; i++) w->left[i] = w->measured[i] - w->left[i];
    ptie_tie_blank(w->left, solver->reached, pixels);
    return (double)largest(w->left, pixels);
}

static ptie_status measure(const ptie_solver *solver, const work *w, const float *const *planes) {
    PTIE_TRY(ptie_tie_slope(w->measured, w->light, &solver->weights, planes));
    ptie_tie_blank(w->measured, solver->reached, ptie_solver_pixels(solver));
    return PTIE_OK;
}

static ptie_solver_report iterate(const ptie_solver *solver, const work *w) {
    const double start = (double)largest(w->measured, ptie_solver_pixels(solver));
    double rest = start;
    ptie_solver_report report = {0};
    while (report.iterations < solver->params.max_iterations) {
        take_step(solver, w);
        report.iterations++;
        if (!ptie_solver_iterates(solver)) return report;
        const double before = rest;
        rest = look_at_rest(solver, w);
        if (rest <= ENOUGH * start || isnan(rest)) break;
        if (report.iterations > 1 && rest > WORSE * before) break;
    }
    report.residual = start > 0 ? rest / start : 0;
    return report;
}

ptie_status ptie_tie_iterate(const ptie_solver *solver, float *phase_rad, const float *const *planes,
                             void *scratch, ptie_solver_report *report) {
    const work w = carve(solver, &(ptie_slicer){.base = scratch});
    const size_t pixels = ptie_solver_pixels(solver);
    PTIE_TRY(measure(solver, &w, planes));
    memcpy(w.left, w.measured, pixels * sizeof *w.left);
    memset(w.phase, 0, pixels * sizeof *w.phase);
    const ptie_solver_report result = iterate(solver, &w);
    if (!isfinite(result.residual))
        return PTIE_FAIL(PTIE_ENUMERIC, "solver: diverged at iteration %d (expected a finite phase); use the "
                         "universal solution or a stronger regularisation", result.iterations);
    ptie_tie_level(solver, w.phase);
    memcpy(phase_rad, w.phase, pixels * sizeof *phase_rad);
    if (report) *report = result;
    return PTIE_OK;
}

/* Sum of squares about the mean. */
static double spread(const float *image, size_t count) {
    double sum = 0, squares = 0;
    for (size_t i = 0; i < count; i++) sum += (double)image[i];
    const double mean = sum / (double)count;
    for (size_t i = 0; i < count; i++) squares += ((double)image[i] - mean) * ((double)image[i] - mean);
    return squares;
}

ptie_status ptie_tie_reproject(const ptie_solver *solver, double *residual, const float *const *maps,
                               size_t count, const float *const *planes, void *scratch) {
    const work w = carve(solver, &(ptie_slicer){.base = scratch});
    const size_t pixels = ptie_solver_pixels(solver);
    PTIE_TRY(measure(solver, &w, planes));
    const double all = spread(w.measured, pixels);
    for (size_t n = 0; n < count; n++) {
        memcpy(w.phase, maps[n], pixels * sizeof *w.phase);
        look_at_rest(solver, &w);
        residual[n] = all > 0 ? sqrt(spread(w.left, pixels) / all) : (double)NAN;
    }
    return PTIE_OK;
}
