/* SPDX-License-Identifier: BSD-3-Clause */
#include "simulate/simulate.h"

#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "simulate/film.h"
#include "rig/prepare.h"
#include "simulate/rig.h"
#include "simulate/studio.h"

/* Frames are made in blocks, as many as there are threads, and written one after the other. */
typedef struct simulation {
    const ptie_simulate_params *params;
    ptie_simulated_files files;
    ptie_pool *pool;
    ptie_progress progress;
    uint64_t done, total; /* frames of all recordings */
    ptie_studio *studio;
    size_t pixels, block, scratch_bytes;
    int32_t images;         /* of a frame */
    ptie_exposure exposure; /* of the recording that is being made */
    int64_t first;          /* frame of the block */
    float *image;           /* (block, images, H, W) */
    float *phase;           /* (block, H, W) */
    float *cells;           /* (H/2, W/2): the truth as a mosaic's planes can show it */
    unsigned char *scratch; /* one part per worker */
} simulation;

static float *image_of(const simulation *s, size_t slot, int32_t which) {
    return s->image + (slot * (size_t)s->images + (size_t)which) * s->pixels;
}

static ptie_status simulate_frame(void *context, size_t slot, int32_t worker) {
    simulation *s = context;
    float *image[2] = {image_of(s, slot, 0), s->images > 1 ? image_of(s, slot, 1) : NULL};
    return ptie_studio_frame(s->studio, image, s->phase + slot * s->pixels, s->exposure, s->first + (int64_t)slot,
                            s->scratch + (size_t)worker * s->scratch_bytes);
}

static ptie_status prepare(simulation *s) {
    const ptie_simulate_params *p = s->params;
    PTIE_TRY(ptie_studio_create(&s->studio, p));
    s->pixels = (size_t)p->flow.width_px * (size_t)p->flow.height_px;
    s->block = (size_t)ptie_pool_threads(s->pool);
    s->images = ptie_studio_images(s->studio);
    s->scratch_bytes = ptie_studio_scratch(s->studio);
    PTIE_TRY(ptie_alloc_status(&s->image, s->block * (size_t)s->images, s->pixels * sizeof(float), "block of frames"));
    PTIE_TRY(ptie_alloc_status(&s->phase, s->block, s->pixels * sizeof(float), "block of frames"));
    PTIE_TRY(ptie_alloc_status(&s->cells, s->pixels / 4, sizeof(float), "truth"));
    return ptie_alloc_status(&s->scratch, s->block, s->scratch_bytes, "scratch of a frame");
}

static bool is_mosaic(const ptie_simulate_params *p) {
    return p->camera && p->camera->layout == PTIE_CAMERA_MOSAIC;
}

/* Opens the recording of the present exposure. */
static ptie_status open_film(const simulation *s, ptie_film *film, const char *path, int64_t frames) {
    const ptie_simulate_params *p = s->params;
    if (!p->camera) return ptie_film_open_planes(film, p);
    if (!is_mosaic(p)) return ptie_film_open_sensors(film, path, p, frames);
    ptie_recording_info info = {.width_px = p->flow.width_px,
                                .height_px = p->flow.height_px,
                                .frames = frames,
                                .unit = "counts",
                                .frame_rate_hz = p->frame_rate_hz,
                                .pixel_m = p->flow.pixel_m,
                                .camera = "ptie simulate",
                                .bit_depth = p->camera->bits,
                                .roi_x_px = p->camera->roi_x_px,
                                .roi_y_px = p->camera->roi_y_px};
    snprintf(info.sample, sizeof info.sample, "u%d", p->camera->bits);
    const char *const title[] = {p->flow.morphology, "no flow", "dark", "target"}; /* by exposure */
    snprintf(info.comment, sizeof info.comment, "%s, seed %llu", title[s->exposure], (unsigned long long)p->flow.seed);
    return ptie_film_open_image(film, path, "counts", &info, p);
}

/* The truth of a camera's recording, in a file of its own: a plane of a mosaic has a pixel per cell. */
static ptie_status open_truth(const simulation *s, ptie_film *film) {
    const ptie_simulate_params *p = s->params;
    const int32_t pitch = is_mosaic(p) ? 2 : 1;
    const ptie_recording_info info = {.width_px = p->flow.width_px / pitch,
                                      .height_px = p->flow.height_px / pitch,
                                      .frames = p->frames,
                                      .unit = "rad",
                                      .frame_rate_hz = p->frame_rate_hz,
                                      .pixel_m = p->flow.pixel_m * pitch};
    return ptie_film_open_image(film, s->files.truth, "phase", &info, p);
}

static ptie_status write_truth(const simulation *s, ptie_film *truth, int64_t frame, const float *phase) {
    if (!is_mosaic(s->params)) return ptie_film_append(truth, frame, &phase);
    ptie_bin(s->cells, phase, s->params->flow.width_px, s->params->flow.height_px, 2);
    return ptie_film_append(truth, frame, (const float *[]){s->cells});
}

/* Frame by frame, so that the file does not show how long a block was.  truth: NULL for none. */
static ptie_status write_block(const simulation *s, ptie_film *film, ptie_film *truth, uint64_t count) {
    for (size_t slot = 0; slot < count; slot++) {
        const int64_t frame = s->first + (int64_t)slot;
        const float *phase = s->phase + slot * s->pixels, *image[PTIE_FILM_IMAGES] = {0};
        for (int32_t i = 0; i < s->images; i++) image[i] = image_of(s, slot, i);
        if (film->images > s->images) image[s->images] = phase;
        PTIE_TRY(ptie_film_append(film, frame, image));
        if (truth) PTIE_TRY(write_truth(s, truth, frame, phase));
    }
    return PTIE_OK;
}

static ptie_status write_frames(simulation *s, ptie_film *film, ptie_film *truth, uint64_t frames) {
    for (uint64_t first = 0; first < frames;) {
        const uint64_t count = frames - first < s->block ? frames - first : s->block;
        s->first = (int64_t)first;
        PTIE_TRY(ptie_pool_run(s->pool, (size_t)count, simulate_frame, s));
        PTIE_TRY(write_block(s, film, truth, count));
        first += count;
        s->done += count;
        PTIE_TRY(ptie_progress_report(s->progress, s->done, s->total, NULL));
    }
    return PTIE_OK;
}

/* A recording of one exposure; frames 0: none. */
static ptie_status record(simulation *s, const char *path, ptie_exposure exposure, int64_t frames) {
    ptie_film film = {0}, truth = {0};
    const bool with_truth = s->params->camera && exposure == PTIE_EXPOSE_FLOW;
    if (frames == 0) return PTIE_OK;
    s->exposure = exposure;
    PTIE_TRY(open_film(s, &film, path, frames));
    ptie_status status = with_truth ? open_truth(s, &truth) : PTIE_OK;
    if (status == PTIE_OK) status = write_frames(s, &film, with_truth ? &truth : NULL, (uint64_t)frames);
    if (with_truth) status = ptie_film_close(&truth, status);
    return ptie_film_close(&film, status);
}

static ptie_status record_all(simulation *s) {
    const ptie_simulate_params *p = s->params;
    const int64_t still = p->camera ? p->reference_frames : 0, dark = p->camera ? p->dark_frames : 0,
                  target = p->camera ? p->target_frames : 0;
    s->total = (uint64_t)(p->frames + still + dark + target);
    PTIE_TRY(record(s, p->output, PTIE_EXPOSE_FLOW, p->frames));
    PTIE_TRY(record(s, s->files.reference, PTIE_EXPOSE_REFERENCE, still));
    PTIE_TRY(record(s, s->files.dark, PTIE_EXPOSE_DARK, dark));
    PTIE_TRY(record(s, s->files.target, PTIE_EXPOSE_TARGET, target));
    return p->rig ? ptie_simulate_write_rigs(p, &s->files) : PTIE_OK;
}

/* Finds out before the work whether the files can be written after it. */
static ptie_status check_outputs(const ptie_simulate_params *p, const ptie_simulated_files *files) {
    const char *const paths[] = {p->output, p->rig, files->truth, files->reference, files->dark,
                                 files->target, files->true_rig};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        ptie_output_file file;
        if (!paths[i] || !paths[i][0]) continue;
        PTIE_TRY(ptie_output_open(&file, paths[i], p->overwrite));
        ptie_output_discard(&file);
    }
    return PTIE_OK;
}

ptie_status ptie_simulate_run(ptie_pool *pool, const ptie_simulate_params *params,
                              ptie_progress progress) {
    simulation s = {.params = params, .pool = pool, .progress = progress};
    ptie_status status;
    PTIE_TRY(ptie_simulate_name_files(&s.files, params));
    PTIE_TRY(check_outputs(params, &s.files));
    PTIE_TRY_DONE(prepare(&s));
    status = record_all(&s);
done:
    ptie_studio_free(s.studio);
    ptie_free(s.image);
    ptie_free(s.phase);
    ptie_free(s.cells);
    ptie_free(s.scratch);
    return status;
}
