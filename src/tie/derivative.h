/* SPDX-License-Identifier: BSD-3-Clause */
/* dI/dz relative to the intensity, from the planes that there are.  docs/math.md (M4), (M4b),
 * (M4c). */
#ifndef PTIE_TIE_DERIVATIVE_H
#define PTIE_TIE_DERIVATIVE_H

#include "tie/solver.h"

/* dI/dz = plus I+ + zero I0 + minus I-, in 1/m; the weights sum to 0. */
typedef struct ptie_tie_weights {
    double plus, zero, minus;
} ptie_tie_weights;

/* PTIE_EINVAL if the distances do not fit the planes. */
ptie_status ptie_tie_weigh(ptie_tie_weights *weights, ptie_planes planes,
                           const ptie_solver_params *params);

/* derivative (out): (dI/dz) / I in 1/m.  i_zero and i_minus may be NULL as in ptie_solver_run. */
ptie_status ptie_tie_derivative(float *derivative, const ptie_solver_params *params,
                                const float *i_plus, const float *i_zero, const float *i_minus);

#endif
