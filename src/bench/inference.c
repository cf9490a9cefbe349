/* SPDX-License-Identifier: BSD-3-Clause */
/* The denoiser: how long one frame takes, how many frames go through at once. */
#include <stdio.h>

#include "bench/frames.h"
#include "bench/groups.h"
#include "bench/memory.h"
#include "bench/network.h"
#include "nn/model.h"

typedef struct inference {
    ptie_denoiser *denoiser;
    ptie_frames frames; /* a: noisy, b: clean */
} inference;

static ptie_status denoise(void *context, int32_t worker) {
    const inference *i = context;
    const ptie_frames *f = &i->frames;
    return ptie_nn_denoise(i->denoiser, ptie_frame(f, f->b, worker), ptie_frame(f, f->a, worker),
                           ptie_frame_scratch(f, worker));
}

static ptie_status denoise_rad(void *context, int32_t worker) {
    const inference *i = context;
    const ptie_frames *f = &i->frames;
    return ptie_nn_denoise_rad(i->denoiser, ptie_frame(f, f->b, worker),
                               ptie_frame(f, f->a, worker), 0, ptie_frame_scratch(f, worker));
}

static ptie_status prepare(inference *i, const ptie_bench *bench, const ptie_model *model,
                           int32_t side) {
    PTIE_TRY(ptie_nn_denoiser(&i->denoiser, bench->engine, model, side, side, NULL));
    return ptie_frames_add_scratch(&i->frames, bench, ptie_nn_denoiser_scratch(i->denoiser));
}

static void release(inference *i) {
    ptie_nn_denoiser_free(i->denoiser);
    ptie_frames_free(&i->frames);
}

static ptie_status measure(ptie_bench *bench, inference *i, const char *name, ptie_bench_mode mode,
                           ptie_status (*work)(void *, int32_t), double flops) {
    ptie_bench_case c = {
        .unit = "frames/s", .mode = mode, .amount = 1, .flops = flops, .work = work, .context = i};
    snprintf(c.name, sizeof c.name, "%s", name);
    return ptie_bench_measure(bench, &c);
}

/* Frames of the paper's size, and the memory they take. */
static ptie_status measure_small(ptie_bench *bench, const ptie_model *model) {
    const double flops = ptie_bench_forward_flops(&model->graph, PTIE_BENCH_SIDE);
    inference i = {.denoiser = NULL};
    ptie_status status;
    PTIE_TRY_DONE(ptie_frames_create(&i.frames, bench, PTIE_BENCH_SIDE));
    const double before = ptie_bench_memory_start();
    PTIE_TRY_DONE(prepare(&i, bench, model, PTIE_BENCH_SIDE));
    PTIE_TRY_DONE(measure(bench, &i, "256 x 256, 1 thread", PTIE_BENCH_ONE, denoise, flops));
    PTIE_TRY_DONE(measure(bench, &i, "256 x 256, all threads", PTIE_BENCH_EACH, denoise, flops));
    PTIE_TRY_DONE(
        measure(bench, &i, "256 x 256 in rad, all threads", PTIE_BENCH_EACH, denoise_rad, flops));
    status = ptie_bench_note(bench, "memory beside the frames", "MB",
                             1e-6 * (ptie_bench_memory_peak() - before));
done:
    release(&i);
    return status;
}

/* Frames that no cache holds. */
static ptie_status measure_large(ptie_bench *bench, const ptie_model *model) {
    enum { SIDE = 1024 };
    inference i = {.denoiser = NULL};
    ptie_status status;
    PTIE_TRY_DONE(ptie_frames_create(&i.frames, bench, SIDE));
    PTIE_TRY_DONE(prepare(&i, bench, model, SIDE));
    status = measure(bench, &i, "1024 x 1024, all threads", PTIE_BENCH_EACH, denoise,
                     ptie_bench_forward_flops(&model->graph, SIDE));
done:
    release(&i);
    return status;
}

ptie_status ptie_bench_inference(ptie_bench *bench) {
    ptie_model *model;
    PTIE_TRY(ptie_bench_model(&model));
    ptie_status status = measure_small(bench, model);
    if (status == PTIE_OK) status = measure_large(bench, model);
    ptie_nn_free(model);
    return status;
}
