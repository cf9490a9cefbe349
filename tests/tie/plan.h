/* SPDX-License-Identifier: BSD-3-Clause */
/* What the solver tests share: a solver with its scratch, forward images, and test fields. */
#ifndef PTIE_TESTS_TIE_PLAN_H
#define PTIE_TESTS_TIE_PLAN_H

#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/random.h"
#include "optics/optics.h"
#include "tie/solver.h"

#define PI 3.14159265358979323846

static inline ptie_solver_params solver_params(ptie_boundary boundary, int32_t w, int32_t h) {
    ptie_solver_params p;
    ptie_solver_params_init(&p);
    p.width_px = w, p.height_px = h, p.boundary = boundary;
    return p;
}

static inline float *image_of(int32_t w, int32_t h) {
    float *image = calloc((size_t)w * (size_t)h, sizeof *image);
    assert_non_null(image);
    return image;
}

/* The same set-up with other planes. */
static inline ptie_solver_params with_planes(ptie_solver_params params, int32_t count, const double *z_m) {
    params.plane_count = count;
    for (int32_t i = 0; i < count; i++) params.z_m[i] = z_m[i];
    return params;
}

/* I+ and I- of the params; with the plane in focus between them; I+ and its reference. */
static inline ptie_solver_params with_focus(ptie_solver_params params) {
    return with_planes(params, 3, (const double[]){params.z_m[0], 0, params.z_m[1]});
}

static inline ptie_solver_params with_reference(ptie_solver_params params) {
    return with_planes(params, 2, (const double[]){params.z_m[0], 0});
}

/* One run of a plan made for it. */
static inline ptie_status solve_planes(const ptie_solver_params *params, float *phase,
                                       const float *const *planes) {
    ptie_solver *solver;
    assert_ok(ptie_tie_plan(&solver, params));
    void *scratch = ptie_alloc(ptie_tie_scratch(solver), 1);
    assert_non_null(scratch);
    const ptie_status status = ptie_tie_solve(solver, phase, planes, scratch, NULL);
    ptie_free(scratch);
    ptie_solver_free(solver);
    return status;
}

/* The planes of the pair `params`; with the image in focus or the reference, `zero`, where there is one. */
static inline ptie_status solve(const ptie_solver_params *params, float *phase, const float *plus,
                                const float *zero, const float *minus) {
    if (!zero) return solve_planes(params, phase, (const float *const[]){plus, minus});
    const ptie_solver_params p = minus ? with_focus(*params) : with_reference(*params);
    return solve_planes(&p, phase, (const float *const[]){plus, zero, minus});
}

/* Images at +-z_m[0] of the params. */
static inline void forward(const ptie_solver_params *params, float *plus, float *minus,
                           const float *phase, ptie_propagation propagation) {
    ptie_optics_params p;
    ptie_optics_params_init(&p);
    p.width_px = params->width_px, p.height_px = params->height_px, p.pixel_m = params->pixel_m;
    p.wavelength_m = params->wavelength_m, p.defocus_m = params->z_m[0];
    p.boundary = params->boundary, p.propagation = propagation;
    ptie_optics *optics;
    assert_ok(ptie_optics_plan(&optics, &p));
    void *scratch = ptie_alloc(ptie_optics_scratch(optics), 1);
    assert_ok(ptie_optics_defocus(optics, plus, minus, phase, NULL, scratch));
    ptie_free(scratch);
    ptie_optics_free(optics);
}

/* Zero-mean, band-limited to a quarter of Nyquist (beyond, a linear signal exceeds the light):
   twelve modes of the boundary, about 1 rad in all. */
static inline void set_band_limited(float *phase, const ptie_solver_params *params,
                                    uint64_t which) {
    const int32_t w = params->width_px, h = params->height_px;
    const int32_t step = params->boundary == PTIE_MIRROR ? 1 : 2; /* half-waves across the frame */
    ptie_random random;
    ptie_random_init(&random, 3, PTIE_STREAM_TEXTURE, which);
    memset(phase, 0, (size_t)w * (size_t)h * sizeof *phase);
    for (int mode = 0; mode < 12; mode++) {
        const int32_t i = step * ptie_random_integer(&random, 0, w / 4 / step);
        const int32_t j = step * ptie_random_integer(&random, 1, h / 4 / step);
        const double amplitude = ptie_random_uniform(&random, -0.6, 0.6);
        const double turn = step == 2 ? ptie_random_uniform(&random, 0, 2 * PI) : 0;
        for (int32_t y = 0; y < h; y++)
            for (int32_t x = 0; x < w; x++)
                phase[y * w + x] += (float)(amplitude * cos(PI * i * (x + 0.5) / w + turn) *
                                            cos(PI * j * (y + 0.5) / h + turn));
    }
}

/* Rounding is noise of the images, and amplified as such: 3e-8 of the light, and of the signal what
   two transforms leave, 4e-7 if it were white (tests/fft); regular images have it in their own few
   modes: measured 8e-7, allowed 1.5e-6. */
static inline double rounding_rad(const ptie_solver_params *params, const float *plus,
                                  const float *minus) {
    const int32_t count = params->width_px * params->height_px;
    double squares = 0;
    for (int32_t i = 0; i < count; i++) squares += pow((double)plus[i] - (double)minus[i], 2);
    ptie_solver *solver;
    assert_ok(ptie_tie_plan(&solver, params));
    /* (I+ - I-) / 2 has sigma / sqrt 2. */
    const double sigma = sqrt(2) * (3e-8 + 1.5e-6 * sqrt(squares / (4 * count)));
    const double rounding = ptie_tie_noise_rad(solver, sigma);
    ptie_solver_free(solver);
    return rounding;
}

#endif
