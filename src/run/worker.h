/* SPDX-License-Identifier: BSD-3-Clause */
/* One frame from planes to denoised phase: plans shared by all threads, scratch for each. */
#ifndef PTIE_RUN_WORKER_H
#define PTIE_RUN_WORKER_H

#include <ptie/run.h>

#include "kernel/engine.h"

/* mask: what is light, or NULL; lives as long as the plan.  params: how the model runs, NULL: the defaults.  With all threads, ptie_frame_solve takes the pool. */
typedef struct ptie_frame_plan ptie_frame_plan;

ptie_status ptie_frame_plan_create(ptie_frame_plan **out, const ptie_engine *engine,
                                   const ptie_rig *rig, const uint8_t *mask, const ptie_model *model,
                                   int32_t width_px, int32_t height_px, const ptie_denoiser_params *params);
void ptie_frame_plan_free(ptie_frame_plan *plan); /* NULL is fine */

/* A map that is taken off every phase from now on; the plan's. */
void ptie_frame_plan_set_background(ptie_frame_plan *plan, float *background);

/* phase, denoised (out; denoised untouched without a model, NULL: not wanted) from the planes in the order of ptie_rig_solver.
   `worker` picks the scratch. */
ptie_status ptie_frame_solve(const ptie_frame_plan *plan, int32_t worker, float *phase, float *denoised,
                             const float *const *planes);

/* The same for the linear model (ptie_reprojection_measured): measured (out), the spectrum of (dI/dz) / I. */
ptie_status ptie_frame_solve_measured(const ptie_frame_plan *plan, int32_t worker, float *phase, float *denoised,
                                      float *measured, const float *const *planes);

/* Standard deviation of the phase that white noise of relative deviation sigma in each plane causes. */
double ptie_frame_noise_rad(const ptie_frame_plan *plan, double sigma);

/* trusted (out): 1 where the phase is made of measured light only, ptie_solver_border. */
void ptie_frame_trusted(const ptie_frame_plan *plan, uint8_t *trusted);

#endif
