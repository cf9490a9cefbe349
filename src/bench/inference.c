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

typedef struct row {
    const char *name;
    int32_t side;
    ptie_bench_mode mode;
    ptie_denoiser_params params;
    ptie_status (*work)(void *context, int32_t worker);
} row;

/* memory: in MB, beside the frames. */
static ptie_status measure(ptie_bench *bench, const ptie_model *model, const row *r,
                           double *memory) {
    inference i = {.denoiser = NULL};
    ptie_status status;
    PTIE_TRY_DONE(ptie_frames_create(&i.frames, bench, r->side));
    const double before = ptie_bench_memory_start();
    PTIE_TRY_DONE(
        ptie_nn_denoiser(&i.denoiser, bench->engine, model, r->side, r->side, &r->params));
    PTIE_TRY_DONE(ptie_frames_add_scratch(&i.frames, bench, ptie_nn_denoiser_scratch(i.denoiser)));
    ptie_bench_case c = {.unit = "frames/s",
                         .mode = r->mode,
                         .amount = 1,
                         .flops = ptie_bench_forward_flops(&model->graph, r->side),
                         .work = r->work,
                         .context = &i};
    snprintf(c.name, sizeof c.name, "%s", r->name);
    status = ptie_bench_measure(bench, &c);
    *memory = 1e-6 * (ptie_bench_memory_peak() - before);
done:
    ptie_nn_denoiser_free(i.denoiser);
    ptie_frames_free(&i.frames);
    return status;
}

/* Fast ones are counted with the operations of the direct way. */
static ptie_status measure_all(ptie_bench *bench, const ptie_model *model) {
    enum { SIDE = PTIE_BENCH_SIDE, LARGE = 1024 };
    const ptie_denoiser_params fast = {.fast = true}, shared = {.all_threads = true},
                               fast_shared = {.fast = true, .all_threads = true}, plain = {0};
    const row rows[] = {
        {"256 x 256, 1 thread", SIDE, PTIE_BENCH_ONE, plain, denoise},
        {"256 x 256, all threads", SIDE, PTIE_BENCH_EACH, plain, denoise},
        {"256 x 256, one frame on all threads", SIDE, PTIE_BENCH_TOGETHER, shared, denoise},
        {"256 x 256 in rad, all threads", SIDE, PTIE_BENCH_EACH, plain, denoise_rad},
        {"256 x 256, fast, 1 thread", SIDE, PTIE_BENCH_ONE, fast, denoise},
        {"256 x 256, fast, all threads", SIDE, PTIE_BENCH_EACH, fast, denoise},
        {"256 x 256, fast, one frame on all threads", SIDE, PTIE_BENCH_TOGETHER, fast_shared,
         denoise},
        {"1024 x 1024, fast, all threads", LARGE, PTIE_BENCH_EACH, fast, denoise},
        {"1024 x 1024, all threads", LARGE, PTIE_BENCH_EACH, plain, denoise},
    };
    double memory = 0;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        PTIE_TRY(measure(bench, model, &rows[i], &memory));
    return ptie_bench_note(bench, "memory beside the frames", "MB", memory);
}

ptie_status ptie_bench_inference(ptie_bench *bench) {
    ptie_model *model;
    PTIE_TRY(ptie_bench_model(&model));
    ptie_status status = measure_all(bench, model);
    ptie_nn_free(model);
    return status;
}
