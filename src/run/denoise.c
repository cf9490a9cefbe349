/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/denoise.h"

#include <stdio.h>

#include "base/file.h"
#include "base/memory.h"
#include "io/recording.h"
#include "nn/nn.h"

/* Frames go through the network in parallel, a block at a time, as many as there are workers. */
typedef struct denoising {
    const ptie_denoise_params *params;
    ptie_recording *input;
    ptie_writer *output;
    ptie_denoiser *denoiser;
    int64_t frames;
    size_t pixels, block, scratch_bytes;
    float *maps;            /* (block, H, W) */
    unsigned char *scratch; /* one part per worker */
} denoising;

static ptie_status prepare(denoising *d, const ptie_engine *engine) {
    const ptie_denoise_params *p = d->params;
    PTIE_TRY(ptie_output_differs(p->output, p->input));
    PTIE_TRY(ptie_io_open(&d->input, p->input));
    ptie_recording_info info = *ptie_io_info(d->input);
    d->frames = info.frames;
    d->pixels = (size_t)info.width_px * (size_t)info.height_px;
    const ptie_denoiser_params how = {.fast = p->fast, .all_threads = d->frames == 1};
    d->block = how.all_threads ? 1 : (size_t)ptie_pool_threads(engine->pool);
    PTIE_TRY(ptie_nn_denoiser(&d->denoiser, engine, p->model, info.width_px, info.height_px,
                              &how));
    d->scratch_bytes = ptie_nn_denoiser_scratch(d->denoiser);
    PTIE_TRY(ptie_alloc_status(&d->maps, d->block, d->pixels * sizeof(float), "block of frames"));
    PTIE_TRY(ptie_alloc_status(&d->scratch, d->block, d->scratch_bytes, "scratch of the network"));
    snprintf(info.unit, sizeof info.unit, "rad");
    return ptie_io_create(&d->output, p->output, "denoised", &info, p->overwrite);
}

static ptie_status denoise_task(void *context, size_t i, int32_t worker) {
    denoising *d = context;
    float *map = d->maps + i * d->pixels;
    return ptie_nn_denoise_rad(d->denoiser, map, map, d->params->polarity,
                               d->scratch + (size_t)worker * d->scratch_bytes);
}

static ptie_status denoise_frames(denoising *d, ptie_pool *pool, ptie_progress progress) {
    for (int64_t first = 0; first < d->frames;) {
        size_t count =
            d->block < (size_t)(d->frames - first) ? d->block : (size_t)(d->frames - first);
        for (size_t i = 0; i < count; i++)
            PTIE_TRY(ptie_io_read(d->input, first + (int64_t)i, d->maps + i * d->pixels));
        PTIE_TRY(d->frames == 1 ? denoise_task(d, 0, 0) /* takes the pool itself */
                                : ptie_pool_run(pool, count, denoise_task, d));
        for (size_t i = 0; i < count; i++)
            PTIE_TRY(ptie_io_append(d->output, d->maps + i * d->pixels));
        first += (int64_t)count;
        PTIE_TRY(ptie_progress_report(progress, (uint64_t)first, (uint64_t)d->frames, NULL));
    }
    ptie_writer *output = d->output;
    d->output = NULL;
    return ptie_io_complete(output);
}

ptie_status ptie_denoise_recording(const ptie_engine *engine, const ptie_denoise_params *params,
                                   ptie_progress progress) {
    denoising d = {.params = params};
    ptie_status status = prepare(&d, engine);
    if (status == PTIE_OK) status = denoise_frames(&d, engine->pool, progress);
    ptie_io_discard(d.output);
    ptie_io_close(d.input);
    ptie_nn_denoiser_free(d.denoiser);
    ptie_free(d.maps);
    ptie_free(d.scratch);
    return status;
}
