/* SPDX-License-Identifier: BSD-3-Clause */
/* Maps sent back through the forward model and compared with what was measured, docs/math.md (Q11).
 */
#ifndef PTIE_RUN_REPROJECTION_H
#define PTIE_RUN_REPROJECTION_H

#include <ptie/run.h>

#include "base/status.h"

typedef struct ptie_reprojection ptie_reprojection;

/* For frames of this size (after binning), measured by at most `workers` threads at a time.  mask: what is light, or
   NULL. */
ptie_status ptie_reprojection_create(ptie_reprojection **out, const ptie_rig *rig, const uint8_t *mask,
                                     int32_t width_px, int32_t height_px, int32_t workers);
void ptie_reprojection_free(ptie_reprojection *reprojection); /* NULL is fine */

/* Of the linear model: where the worker's spectrum of (dI/dz) / I belongs before it measures; NULL for the others. */
float *ptie_reprojection_measured(const ptie_reprojection *reprojection, int32_t worker);

/* residual (out): one number per map.  Planes as in ptie_frame_solve; the linear model takes its spectrum instead. */
ptie_status ptie_reprojection_measure(const ptie_reprojection *reprojection, int32_t worker,
                                      double *residual, const float *const *maps, size_t count,
                                      const float *const *planes);

#endif
