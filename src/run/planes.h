/* SPDX-License-Identifier: BSD-3-Clause */
/* A rig's planes in the order of the solver. */
#ifndef PTIE_RUN_PLANES_H
#define PTIE_RUN_PLANES_H

#include <ptie/run.h>

/* How frames of this size (after binning) are solved. */
ptie_solver_params ptie_rig_solver(const ptie_rig *rig, int32_t width_px, int32_t height_px);

/* planes (out): in the order of ptie_rig_solver's z_m; an image that the rig does not have is NULL. */
void ptie_rig_order(const float **planes, const float *i_plus, const float *i_zero, const float *i_minus);

#endif
