/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/solver.h>: arguments checked, then inward. */
#include <ptie/solver.h>

#include <math.h>

#include "api/params.h"
#include "tie/solver.h"

static ptie_status check_params(const ptie_solver_params *p, const char *where) {
    PTIE_TRY(ptie_check_integer(p->width_px, 2, 32768, where, "width_px"));
    PTIE_TRY(ptie_check_integer(p->height_px, 2, 32768, where, "height_px"));
    PTIE_TRY(ptie_check_number(p->pixel_m, 1e-9, 1, where, "pixel_m"));
    PTIE_TRY(ptie_check_number(p->wavelength_m, 1e-12, 1e-2, where, "wavelength_m"));
    PTIE_TRY(ptie_check_integer(p->plane_count, 2, PTIE_MAX_PLANES, where, "plane_count"));
    for (int32_t i = 0; i < p->plane_count; i++)
        PTIE_TRY(ptie_check_number(p->z_m[i], -1e3, 1e3, where, "z_m"));
    PTIE_TRY(ptie_check_integer(p->polynomial_order, 0, p->plane_count - 1, where, "polynomial_order"));
    PTIE_TRY(ptie_check_integer(p->boundary, PTIE_PERIODIC, PTIE_MIRROR, where, "boundary"));
    PTIE_TRY(ptie_check_integer(p->method, PTIE_SOLVE_DIRECT, PTIE_SOLVE_US_TIE, where, "method"));
    PTIE_TRY(ptie_check_integer(p->max_iterations, 1, 100000, where, "max_iterations"));
    PTIE_TRY(ptie_check_number(p->intensity_floor, 0, 1, where, "intensity_floor"));
    return ptie_check_number(p->cutoff_m, 0, 1e6, where, "cutoff_m");
}

static ptie_status read_params(ptie_solver_params *known, const ptie_solver_params *params,
                               const char *where) {
    ptie_solver_params_init(known);
    PTIE_TRY(ptie_params_read(known, sizeof *known, params, where));
    return check_params(known, where);
}

ptie_status ptie_solver_create(ptie_solver **out, ptie_ctx *ctx, const ptie_solver_params *params) {
    static const char where[] = "ptie_solver_create";
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    *out = NULL;
    PTIE_TRY(ptie_check_pointer(ctx, where, "ctx"));
    ptie_solver_params known;
    PTIE_TRY(read_params(&known, params, where));
    return ptie_tie_plan(out, &known);
}

size_t ptie_solver_scratch_bytes(const ptie_solver *solver) {
    return solver ? ptie_tie_scratch(solver) : 0;
}

static ptie_status check_planes(const float *const *planes, int32_t count, const char *where) {
    PTIE_TRY(ptie_check_pointer(planes, where, "planes"));
    for (int32_t i = 0; i < count; i++)
        if (!planes[i])
            return PTIE_FAIL(PTIE_EINVAL, "%s: planes[%d] is missing (expected %d pointers, found NULL)", where,
                             i, count);
    return PTIE_OK;
}

ptie_status ptie_solver_run(const ptie_solver *solver, float *phase_rad, const float *const *planes,
                            void *scratch, ptie_solver_report *report) {
    static const char where[] = "ptie_solver_run";
    PTIE_TRY(ptie_check_pointer(solver, where, "solver"));
    PTIE_TRY(ptie_check_pointer(phase_rad, where, "phase_rad"));
    PTIE_TRY(check_planes(planes, ptie_tie_planes(solver), where));
    PTIE_TRY(ptie_check_scratch(scratch, where));
    return ptie_tie_solve(solver, phase_rad, planes, scratch, report);
}

double ptie_solver_noise_rad(const ptie_solver *solver, double sigma) {
    return solver ? ptie_tie_noise_rad(solver, sigma) : (double)NAN;
}

ptie_status ptie_solver_border(const ptie_solver *solver, uint8_t *mask) {
    static const char where[] = "ptie_solver_border";
    PTIE_TRY(ptie_check_pointer(solver, where, "solver"));
    PTIE_TRY(ptie_check_pointer(mask, where, "mask"));
    ptie_tie_border(solver, mask);
    return PTIE_OK;
}

ptie_status ptie_solver_choose_cutoff(double *cutoff_m, ptie_ctx *ctx, const ptie_solver_params *params,
                                      const float *const *planes, ptie_cutoff_rule rule, double sigma) {
    static const char where[] = "ptie_solver_choose_cutoff";
    PTIE_TRY(ptie_check_pointer(cutoff_m, where, "cutoff_m"));
    PTIE_TRY(ptie_check_pointer(ctx, where, "ctx"));
    ptie_solver_params known;
    PTIE_TRY(read_params(&known, params, where));
    PTIE_TRY(check_planes(planes, known.plane_count, where));
    PTIE_TRY(ptie_check_integer(rule, PTIE_CUTOFF_NOISE, PTIE_CUTOFF_L_CURVE, where, "rule"));
    PTIE_TRY(ptie_check_number(sigma, 0, 1e3, where, "sigma"));
    return ptie_tie_choose_cutoff(cutoff_m, &known, planes, rule, sigma);
}
