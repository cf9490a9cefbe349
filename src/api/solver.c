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
    PTIE_TRY(ptie_check_number(p->defocus_plus_m, -1e3, 1e3, where, "defocus_plus_m"));
    PTIE_TRY(ptie_check_number(p->defocus_minus_m, -1e3, 1e3, where, "defocus_minus_m"));
    PTIE_TRY(ptie_check_integer(p->boundary, PTIE_PERIODIC, PTIE_MIRROR, where, "boundary"));
    return ptie_check_number(p->cutoff_m, 0, 1e6, where, "cutoff_m");
}

ptie_status ptie_solver_create(ptie_solver **out, ptie_ctx *ctx, const ptie_solver_params *params) {
    static const char where[] = "ptie_solver_create";
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    *out = NULL;
    PTIE_TRY(ptie_check_pointer(ctx, where, "ctx"));
    ptie_solver_params known;
    ptie_solver_params_init(&known);
    PTIE_TRY(ptie_params_read(&known, sizeof known, params, where));
    PTIE_TRY(check_params(&known, where));
    return ptie_tie_plan(out, &known);
}

size_t ptie_solver_scratch_bytes(const ptie_solver *solver) {
    return solver ? ptie_tie_scratch(solver) : 0;
}

ptie_status ptie_solver_run(const ptie_solver *solver, float *phase_rad, const float *i_plus,
                            const float *i_zero, const float *i_minus, void *scratch) {
    static const char where[] = "ptie_solver_run";
    PTIE_TRY(ptie_check_pointer(solver, where, "solver"));
    PTIE_TRY(ptie_check_pointer(phase_rad, where, "phase_rad"));
    PTIE_TRY(ptie_check_pointer(i_plus, where, "i_plus"));
    if (!i_zero && !i_minus)
        return PTIE_FAIL(
            PTIE_EINVAL,
            "%s: a second plane is missing (expected i_zero, i_minus or both, found NULL)", where);
    PTIE_TRY(ptie_check_scratch(scratch, where));
    return ptie_tie_solve(solver, phase_rad, i_plus, i_zero, i_minus, scratch);
}

double ptie_solver_noise_rad(const ptie_solver *solver, ptie_planes planes, double sigma) {
    return solver ? ptie_tie_noise_rad(solver, planes, sigma) : (double)NAN;
}
