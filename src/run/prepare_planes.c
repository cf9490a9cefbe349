/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/prepare_planes.h"

#include <stdio.h>

#include "base/file.h"
#include "base/memory.h"
#include "io/nexus.h"
#include "io/recording.h"
#include "rig/prepare.h"
#include "rig/rig.h"
#include "run/run.h"
#include "run/stages.h"

typedef struct preparing {
    const ptie_prepare_params *params;
    ptie_source *source;
    ptie_prepare *plan;
    ptie_source_shape recorded;
    ptie_prepare_shape shape;
    ptie_h5 *output;
    int64_t frames;
    size_t slots;
    float *image; /* (slots, images, sensor height, width) */
    float *plane; /* (slots, planes, H, W) */
    unsigned char *scratch;
    size_t image_pixels, pixels, scratch_bytes;
} preparing;

static float *image_of(const preparing *p, size_t slot, int32_t i) {
    return p->image + (slot * (size_t)p->recorded.images + (size_t)i) * p->image_pixels;
}

static float *plane_of(const preparing *p, size_t slot, int32_t i) {
    return p->plane + (slot * (size_t)p->shape.planes + (size_t)i) * p->pixels;
}

static ptie_status read_frame(void *context, int64_t frame, size_t slot) {
    preparing *p = context;
    float *images[PTIE_ROLES];
    for (int32_t i = 0; i < p->recorded.images; i++) images[i] = image_of(p, slot, i);
    return ptie_source_read(p->source, p->params->frames.first + frame * p->params->frames.step,
                            images);
}

static ptie_status prepare_frame(void *context, int64_t frame, size_t slot, int32_t worker) {
    (void)frame;
    preparing *p = context;
    const float *images[PTIE_ROLES];
    float *planes[PTIE_ROLES];
    for (int32_t i = 0; i < p->recorded.images; i++) images[i] = image_of(p, slot, i);
    for (int32_t i = 0; i < p->shape.planes; i++) planes[i] = plane_of(p, slot, i);
    return ptie_prepare_run(p->plan, images, planes,
                            p->scratch + (size_t)worker * p->scratch_bytes);
}

static ptie_status write_frame(void *context, int64_t frame, size_t slot) {
    preparing *p = context;
    char path[128];
    for (int32_t i = 0; i < p->shape.planes; i++) {
        snprintf(path, sizeof path, PTIE_NEXUS_DATA "/%s", p->shape.name[i]);
        PTIE_TRY(
            ptie_h5_write(p->output, path, PTIE_H5_F32, (uint64_t)frame, 1, plane_of(p, slot, i)));
    }
    return PTIE_OK;
}

static ptie_status open_inputs(preparing *p) {
    const ptie_prepare_params *params = p->params;
    const ptie_run_params inputs = {.rig = params->rig,
                                    .recording = params->recording,
                                    .plane = {params->plane[0], params->plane[1], params->plane[2],
                                              params->plane[3], params->plane[4]}};
    const char *const paths[] = {params->recording,      params->plane[0],  params->plane[1],
                                 params->plane[2],       params->plane[3],  params->plane[4],
                                 params->rig->reference, params->rig->dark, params->rig->mask};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++)
        PTIE_TRY(ptie_output_differs(params->output, paths[i]));
    PTIE_TRY(ptie_source_open(&p->source, &inputs));
    p->recorded = ptie_source_get_shape(p->source);
    PTIE_TRY(
        ptie_io_choose(&p->frames, params->frames, p->recorded.frames, ptie_run_name(&inputs)));
    PTIE_TRY(ptie_prepare_until(&p->plan, p->source, params->rig, params->until));
    p->shape = ptie_prepare_get_shape(p->plan);
    return PTIE_OK;
}

static ptie_status allocate(preparing *p, const ptie_pool *pool) {
    const size_t workers = (size_t)ptie_pool_threads(pool);
    p->slots = ptie_stages_slots(pool, p->frames);
    p->image_pixels = (size_t)p->recorded.width_px * (size_t)p->recorded.height_px;
    p->pixels = (size_t)p->shape.width_px * (size_t)p->shape.height_px;
    p->scratch_bytes = ptie_prepare_scratch_bytes(p->plan);
    PTIE_TRY(ptie_alloc_status(&p->image, p->slots * (size_t)p->recorded.images,
                               p->image_pixels * sizeof(float), "frames"));
    PTIE_TRY(ptie_alloc_status(&p->plane, p->slots * (size_t)p->shape.planes,
                               p->pixels * sizeof(float), "planes"));
    return ptie_alloc_status(&p->scratch, workers, p->scratch_bytes, "scratch of the planes");
}

static ptie_status describe(ptie_h5 *h5, const ptie_prepare_params *params) {
    PTIE_TRY(ptie_nexus_process(h5, params->recording, params->provenance));
    char *rig = ptie_rig_print(params->rig);
    if (!rig) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", params->output);
    ptie_status status = ptie_h5_set_text(h5, PTIE_NEXUS_PROCESS, "rig", rig);
    ptie_free(rig);
    return status;
}

static ptie_status create_output(preparing *p) {
    const ptie_prepare_params *params = p->params;
    ptie_nexus_signal signals[PTIE_ROLES];
    for (int32_t i = 0; i < p->shape.planes; i++)
        signals[i] = (ptie_nexus_signal){.name = p->shape.name[i], .unit = ""};
    const double recorded_hz = p->recorded.frame_rate_hz, rig_hz = params->rig->frame_rate_hz;
    PTIE_TRY(ptie_h5_create(&p->output, params->output, params->overwrite));
    PTIE_TRY(ptie_nexus_begin(p->output,
                              &(ptie_nexus_axes){.frames = (uint64_t)p->frames,
                                                 .width_px = p->shape.width_px,
                                                 .height_px = p->shape.height_px,
                                                 .first_frame = params->frames.first,
                                                 .frame_step = params->frames.step,
                                                 .frame_rate_hz = rig_hz > 0 ? rig_hz : recorded_hz,
                                                 .pixel_m = p->shape.pixel_m},
                              signals, (size_t)p->shape.planes));
    return describe(p->output, params);
}

ptie_status ptie_prepare_recording(ptie_pool *pool, const ptie_prepare_params *params,
                                   ptie_progress progress) {
    preparing p = {.params = params};
    ptie_status status = open_inputs(&p);
    if (status == PTIE_OK) status = allocate(&p, pool);
    if (status == PTIE_OK) status = create_output(&p);
    if (status == PTIE_OK)
        status = ptie_stages_run(&(ptie_stages){.read = read_frame,
                                                .solve = prepare_frame,
                                                .write = write_frame,
                                                .context = &p,
                                                .end = p.frames,
                                                .slots = p.slots,
                                                .progress = progress,
                                                .total = p.frames},
                                 pool);
    if (status == PTIE_OK) {
        status = ptie_h5_close(p.output);
        p.output = NULL;
    }
    ptie_h5_discard(p.output);
    ptie_prepare_free(p.plan);
    ptie_source_close(p.source);
    ptie_free(p.image);
    ptie_free(p.plane);
    ptie_free(p.scratch);
    return status;
}
