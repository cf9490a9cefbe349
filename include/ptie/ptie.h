/* SPDX-License-Identifier: BSD-3-Clause */
/* ptie: from parallel-TIE recordings to quantitative, denoised phase.
 *
 *     #include <ptie/ptie.h>
 *
 *     ptie_ctx *ctx;
 *     ptie_solver *solver;
 *     ptie_solver_params p;
 *     ptie_solver_params_init(&p);
 *     p.width_px = 256, p.height_px = 256, p.pixel_m = 20e-6;
 *     if (ptie_ctx_create(&ctx, NULL) || ptie_solver_create(&solver, ctx, &p))
 *         return fprintf(stderr, "%s\n", ptie_last_error()), 1;
 *     void *scratch = ptie_scratch_alloc(ptie_solver_scratch_bytes(solver));
 *     ptie_status s = ptie_solver_run(solver, phase_rad, i_plus, NULL, i_minus, scratch);
 *
 * Conventions.  Images are row-major float32, height x width, top row first.  Lengths are in m, phase in
 * rad, unit in the name.  *_init fills defaults; set `struct_size` only through it.  Plans (solver,
 * optics, denoiser) are const while they run: share them between threads, give each run its scratch.
 */
#ifndef PTIE_PTIE_H
#define PTIE_PTIE_H

#include <ptie/bench.h>
#include <ptie/camera.h>
#include <ptie/context.h>
#include <ptie/convert.h>
#include <ptie/dataset.h>
#include <ptie/figure.h>
#include <ptie/flow.h>
#include <ptie/machine.h>
#include <ptie/metrics.h>
#include <ptie/model.h>
#include <ptie/optics.h>
#include <ptie/prepare.h>
#include <ptie/preprocess.h>
#include <ptie/recording.h>
#include <ptie/report.h>
#include <ptie/rig.h>
#include <ptie/run.h>
#include <ptie/simulate.h>
#include <ptie/solver.h>
#include <ptie/status.h>
#include <ptie/text.h>
#include <ptie/train.h>
#include <ptie/version.h>

#endif
