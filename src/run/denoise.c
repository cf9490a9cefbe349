/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/denoise.h"

#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "io/recording.h"
#include "nn/nn.h"
#include "run/stages.h"

typedef struct denoising {
    const ptie_denoise_params *params;
    ptie_recording *input;
    ptie_writer *output;
    ptie_denoiser *denoiser;
    int64_t frames;
    size_t pixels, slots, scratch_bytes;
    float *maps;            /* (slots, H, W) */
    unsigned char *scratch; /* one part per worker */
} denoising;

/* A camera's counts are no phase, and would make a map that looks like one. */
static ptie_status check_unit(const ptie_recording_info *info, const char *path) {
    if (info->bit_depth == 0 || strcmp(info->unit, "rad") == 0) return PTIE_OK;
    return PTIE_FAIL(
        PTIE_EFORMAT,
        "%s: intensity of a camera (expected phase in rad, as 'ptie run' makes it, found %d bits)", path,
        info->bit_depth);
}

static ptie_status prepare(denoising *d, const ptie_engine *engine) {
    const ptie_denoise_params *p = d->params;
    PTIE_TRY(ptie_output_differs(p->output, p->input));
    PTIE_TRY(ptie_io_open(&d->input, p->input));
    ptie_recording_info info = *ptie_io_info(d->input);
    PTIE_TRY(check_unit(&info, p->input));
    d->frames = info.frames;
    d->pixels = (size_t)info.width_px * (size_t)info.height_px;
    const ptie_denoiser_params how = {.fast = p->fast, .all_threads = d->frames == 1};
    const size_t workers = how.all_threads ? 1 : (size_t)ptie_pool_threads(engine->pool);
    d->slots = ptie_stages_slots(engine->pool, d->frames);
    PTIE_TRY(ptie_nn_denoiser(&d->denoiser, engine, p->model, info.width_px, info.height_px,
                              &how));
    d->scratch_bytes = ptie_nn_denoiser_scratch(d->denoiser);
    PTIE_TRY(ptie_alloc_status(&d->maps, d->slots, d->pixels * sizeof(float), "frames"));
    PTIE_TRY(ptie_alloc_status(&d->scratch, workers, d->scratch_bytes, "scratch of the network"));
    snprintf(info.unit, sizeof info.unit, "rad");
    snprintf(info.sample, sizeof info.sample, "f32");
    return ptie_io_create(&d->output, &(ptie_writer_job){.path = p->output,
                                                         .name = "denoised",
                                                         .info = info,
                                                         .overwrite = p->overwrite});
}

static ptie_status read_frame(void *context, int64_t frame, size_t slot) {
    denoising *d = context;
    return ptie_io_read(d->input, frame, d->maps + slot * d->pixels);
}

static ptie_status denoise_frame(void *context, int64_t frame, size_t slot, int32_t worker) {
    (void)frame;
    denoising *d = context;
    float *map = d->maps + slot * d->pixels;
    return ptie_nn_denoise_rad(d->denoiser, map, map, d->params->polarity,
                               d->scratch + (size_t)worker * d->scratch_bytes);
}

static ptie_status write_frame(void *context, int64_t frame, size_t slot) {
    (void)frame;
    denoising *d = context;
    return ptie_io_append(d->output, d->maps + slot * d->pixels);
}

static ptie_status denoise_frames(denoising *d, ptie_pool *pool, ptie_progress progress) {
    PTIE_TRY(ptie_stages_run(&(ptie_stages){.read = read_frame,
                                            .solve = denoise_frame,
                                            .write = write_frame,
                                            .context = d,
                                            .end = d->frames,
                                            .slots = d->slots,
                                            .progress = progress,
                                            .total = d->frames},
                             pool));
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
