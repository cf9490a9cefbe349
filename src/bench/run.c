/* SPDX-License-Identifier: BSD-3-Clause */
/* The whole pipeline on a simulated recording, from file to file, beside what it computes: solving
 * and denoising the same frames without files, metrics and proposals of regions.
 */
#include "run/run.h"

#include <math.h>

#include "bench/folder.h"
#include "bench/frames.h"
#include "bench/groups.h"
#include "bench/network.h"
#include "nn/nn.h"
#include "rig/rig.h"
#include "simulate/simulate.h"
#include "run/worker.h"

typedef struct pipeline {
    const ptie_engine *engine;
    ptie_folder folder;
    ptie_rig rig;
    ptie_model *model;
    ptie_frame_plan *plan;
    ptie_frames frames; /* a: I+, b: I-, c: denoised; scratch: phase */
} pipeline;

static ptie_status solve_and_denoise(void *context, int32_t worker) {
    const pipeline *p = context;
    const ptie_frames *f = &p->frames;
    const float *const planes[] = {ptie_frame(f, f->a, worker), ptie_frame(f, f->b, worker)};
    return ptie_frame_solve(p->plan, worker, ptie_frame_scratch(f, worker), ptie_frame(f, f->c, worker), planes);
}

static ptie_status run(void *context, int32_t worker) {
    (void)worker;
    const pipeline *p = context;
    char recording[PTIE_FOLDER_FILE_BYTES], output[PTIE_FOLDER_FILE_BYTES];
    ptie_run_params params;
    ptie_run_summary summary;
    ptie_run_params_init(&params);
    params.rig = &p->rig;
    params.recording = ptie_folder_file(&p->folder, recording, "jet.h5");
    params.model = p->model;
    params.output = ptie_folder_file(&p->folder, output, "phase.h5");
    params.overwrite = true;
    return ptie_run_pipeline(p->engine, &params, &summary, (ptie_progress){0});
}

/* jet.h5 with `frames` frames, and its rig. */
static ptie_status simulate(pipeline *p, int64_t frames) {
    char recording[PTIE_FOLDER_FILE_BYTES], rig[PTIE_FOLDER_FILE_BYTES];
    ptie_simulate_params params;
    ptie_simulate_params_init(&params);
    params.flow.morphology = "jet";
    params.frames = frames;
    params.output = ptie_folder_file(&p->folder, recording, "jet.h5");
    params.rig = ptie_folder_file(&p->folder, rig, "jet.ini");
    params.overwrite = true;
    PTIE_TRY(ptie_simulate_run(p->engine->pool, &params, (ptie_progress){0}));
    return ptie_rig_read(&p->rig, params.rig);
}

static ptie_status prepare(pipeline *p, const ptie_bench *bench) {
    PTIE_TRY(ptie_folder_create(&p->folder));
    PTIE_TRY(ptie_bench_model(&p->model));
    PTIE_TRY(simulate(p, 1));
    PTIE_TRY(ptie_frame_plan_create(&p->plan, p->engine, &p->rig, NULL, p->model, PTIE_BENCH_SIDE,
                                    PTIE_BENCH_SIDE, NULL));
    PTIE_TRY(ptie_frames_create(&p->frames, bench, PTIE_BENCH_SIDE));
    return ptie_frames_add_scratch(&p->frames, bench, p->frames.pixels * sizeof(float));
}

static void release(pipeline *p) {
    ptie_frames_free(&p->frames);
    ptie_frame_plan_free(p->plan);
    ptie_nn_free(p->model);
    ptie_folder_remove(&p->folder);
}

static ptie_status measure(ptie_bench *bench, pipeline *p) {
    PTIE_TRY(ptie_bench_measure(bench, &(ptie_bench_case){.name = "solve and denoise, in memory",
                                                          .unit = "frames/s",
                                                          .mode = PTIE_BENCH_EACH,
                                                          .amount = 1,
                                                          .work = solve_and_denoise,
                                                          .context = p}));
    /* A recording that keeps the pipeline busy for about half of the measurement. */
    const double rate = bench->results[bench->count - 1].median;
    const double frames = fmin(fmax(round(rate * bench->seconds / 2), 8), 1000);
    PTIE_TRY(simulate(p, (int64_t)frames));
    return ptie_bench_measure(bench, &(ptie_bench_case){.name = "recording to phase and metrics",
                                                        .unit = "frames/s",
                                                        .mode = PTIE_BENCH_TOGETHER,
                                                        .amount = frames,
                                                        .work = run,
                                                        .context = p});
}

ptie_status ptie_bench_pipeline(ptie_bench *bench) {
    pipeline p = {.engine = bench->engine};
    ptie_status status = prepare(&p, bench);
    if (status == PTIE_OK) status = measure(bench, &p);
    release(&p);
    return status;
}
