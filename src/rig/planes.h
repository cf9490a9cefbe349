/* SPDX-License-Identifier: BSD-3-Clause */
/* A rig's planes: which there are, where they lie, how they are solved. */
#ifndef PTIE_RIG_PLANES_H
#define PTIE_RIG_PLANES_H

#include <ptie/rig.h>

#include "base/status.h"

/* "plus", "minus", "zero", "plus2", "minus2". */
extern const char *const ptie_role_names[PTIE_ROLES];

/* The sets of planes that there are: I+ and I-; with I0; with the outer pair; I+ and its no-flow
 * reference. */
typedef enum ptie_plane_set {
    PTIE_SET_PAIR,
    PTIE_SET_TRIPLE,
    PTIE_SET_FIVE,
    PTIE_SET_REFERENCE,
    PTIE_SETS
} ptie_plane_set;

bool ptie_set_has(ptie_plane_set set, int role);
/* PTIE_SETS if the rig's planes are none of them. */
ptie_plane_set ptie_rig_set(const ptie_rig *rig);

/* The planes in the solver's order: by role; a set of one plane has its reference too, as PTIE_ZERO
   in focus. Returns their count. */
int32_t ptie_rig_planes(const ptie_rig *rig, ptie_role role[PTIE_ROLES], double z_m[PTIE_ROLES]);

/* The planes are a set and lie apart, I- below I+.  `where` begins the message. */
ptie_status ptie_rig_check_planes(const ptie_rig *rig, const char *where);

/* Of the planes and the phase: after de-mosaicking and binning. */
double ptie_rig_pixel_m(const ptie_rig *rig);

/* From this chi on, linear TIE is more than 5 % too weak: sin(chi) = 0.95 chi. */
#define PTIE_LINEAR_CHI 0.55
/* Period with that chi in the plane farthest from focus, docs/math.md (M7b): finer structures come out too weak. */
double ptie_rig_linear_period_m(const ptie_rig *rig);

/* How planes of this size are solved; without a cut-off where that is still to be chosen. */
ptie_solver_params ptie_rig_solver(const ptie_rig *rig, int32_t width_px, int32_t height_px);

#endif
