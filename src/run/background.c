/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/background.h"

#include "base/memory.h"
#include "prep/prep.h"

enum { MOST_SAMPLES = 31 };

/* Frames of a recording as planes, one at a time. */
typedef struct frames {
    ptie_source *source;
    const ptie_prepare *prepare;
    float *image[PTIE_ROLES], *plane[PTIE_ROLES];
    unsigned char *scratch;
    size_t pixels; /* of a plane */
} frames;

static ptie_status open_frames(frames *f, ptie_source *source, const ptie_prepare *prepare) {
    const ptie_source_shape recorded = ptie_source_get_shape(source);
    const ptie_prepare_shape shape = ptie_prepare_get_shape(prepare);
    const size_t raw = (size_t)recorded.width_px * (size_t)recorded.height_px;
    *f = (frames){.source = source,
                  .prepare = prepare,
                  .pixels = (size_t)shape.width_px * (size_t)shape.height_px};
    for (int32_t i = 0; i < recorded.images; i++)
        PTIE_TRY(ptie_alloc_status(&f->image[i], raw, sizeof(float), "run"));
    for (int32_t i = 0; i < shape.planes; i++)
        PTIE_TRY(ptie_alloc_status(&f->plane[i], f->pixels, sizeof(float), "run"));
    return ptie_alloc_status(&f->scratch, ptie_prepare_scratch_bytes(prepare), 1, "run: scratch");
}

static void close_frames(frames *f) {
    for (int i = 0; i < PTIE_ROLES; i++) {
        ptie_free(f->image[i]);
        ptie_free(f->plane[i]);
    }
    ptie_free(f->scratch);
}

static ptie_status read_planes(frames *f, int64_t frame) {
    PTIE_TRY(ptie_source_read(f->source, frame, f->image));
    return ptie_prepare_run(f->prepare, (const float *const *)f->image, f->plane, f->scratch);
}

static ptie_status measure_background(float *background, float *stack, frames *f,
                                      const ptie_frame_plan *plan, const ptie_rig *rig,
                                      int32_t samples) {
    const int64_t last = rig->still_end - rig->still_first - 1;
    for (int32_t i = 0; i < samples; i++) {
        PTIE_TRY(read_planes(f, rig->still_first + (samples > 1 ? last * i / (samples - 1) : 0)));
        PTIE_TRY(ptie_frame_solve(plan, 0, stack + (size_t)i * f->pixels, NULL,
                                  (const float *const *)f->plane));
    }
    ptie_temporal_median(background, stack, samples, f->pixels, f->pixels);
    return PTIE_OK;
}

ptie_status ptie_background_measure(ptie_frame_plan *plan, ptie_source *source,
                                    const ptie_prepare *prepare, const ptie_rig *rig) {
    const int64_t still = rig->still_end - rig->still_first,
                  all = ptie_source_get_shape(source).frames;
    const int32_t samples = still < MOST_SAMPLES ? (int32_t)still : MOST_SAMPLES;
    float *background = NULL, *stack = NULL;
    frames f;
    if (still <= 0) return PTIE_OK;
    if (rig->still_end > all)
        return PTIE_FAIL(
            PTIE_EINVAL,
            "rig: still_frames leave the recording (expected some of 0:%lld, found %lld:%lld)",
            (long long)all, (long long)rig->still_first, (long long)rig->still_end);
    ptie_status status = open_frames(&f, source, prepare);
    if (status == PTIE_OK)
        status = ptie_alloc_status(&background, f.pixels, sizeof(float), "run: background");
    if (status == PTIE_OK)
        status =
            ptie_alloc_status(&stack, (size_t)samples, f.pixels * sizeof(float), "run: background");
    if (status == PTIE_OK) status = measure_background(background, stack, &f, plan, rig, samples);
    close_frames(&f);
    ptie_free(stack);
    if (status == PTIE_OK)
        ptie_frame_plan_set_background(plan, background);
    else
        ptie_free(background);
    return status;
}
