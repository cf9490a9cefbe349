/* SPDX-License-Identifier: BSD-3-Clause */
/* The inverse model inside the library: contracts of <ptie/solver.h>, arguments already checked. */
#ifndef PTIE_TIE_SOLVER_H
#define PTIE_TIE_SOLVER_H

#include <ptie/solver.h>

#include "base/status.h"

ptie_status ptie_tie_plan(ptie_solver **out, const ptie_solver_params *params);
int32_t ptie_tie_planes(const ptie_solver *solver); /* of a frame */
size_t ptie_tie_scratch(const ptie_solver *solver);
ptie_status ptie_tie_solve(const ptie_solver *solver, float *phase_rad, const float *const *planes,
                           void *scratch, ptie_solver_report *report);
/* Of PTIE_SOLVE_DIRECT.  measured (out): the spectrum of (dI/dz) / I, the same ptie_tie_solve inverts, in a buffer of
   the boundary's transform (fft/fft.h). */
ptie_status ptie_tie_solve_direct(const ptie_solver *solver, float *phase_rad, float *measured,
                                  const float *const *planes, void *scratch);
/* Of a method other than PTIE_SOLVE_DIRECT, docs/math.md (Q11).  residual (out): per map, what diffraction by it leaves
   of the planes' dI/dz, rms about the means, relative to dI/dz itself.  scratch: as ptie_tie_solve. */
ptie_status ptie_tie_reproject(const ptie_solver *solver, double *residual, const float *const *maps,
                               size_t count, const float *const *planes, void *scratch);
void ptie_tie_border(const ptie_solver *solver, uint8_t *mask);
ptie_status ptie_tie_choose_cutoff(double *cutoff_m, const ptie_solver_params *params,
                                   const float *const *planes, ptie_cutoff_rule rule, double sigma);
double ptie_tie_noise_rad(const ptie_solver *solver, double sigma);

#endif
