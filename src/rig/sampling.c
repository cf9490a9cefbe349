/* SPDX-License-Identifier: BSD-3-Clause */
#include "rig/sampling.h"

#include <string.h>

#include "base/memory.h"

static ptie_status allocate(float **maps, int32_t count, size_t pixels) {
    for (int32_t i = 0; i < count; i++)
        PTIE_TRY(ptie_alloc_status(&maps[i], pixels, sizeof(float), "rig"));
    return PTIE_OK;
}

ptie_status ptie_sampling_read(ptie_sampling *s, int32_t i) {
    return ptie_source_read(s->source, ptie_source_sample(s->source, i, s->frames), s->frame);
}

ptie_status ptie_sampling_open(ptie_sampling *s, const ptie_rig *rig, const char *recording,
                               const char *const plane[PTIE_ROLES], bool flat) {
    ptie_run_params inputs = {.rig = rig, .recording = recording};
    if (plane) memcpy(inputs.plane, plane, sizeof inputs.plane);
    *s = (ptie_sampling){.rig = *rig};
    s->rig.flat_field = flat;
    s->rig.match_gain = false;
    PTIE_TRY(ptie_source_open(&s->source, &inputs));
    s->shape = ptie_source_get_shape(s->source);
    s->frames = s->shape.frames < PTIE_SAMPLES ? (int32_t)s->shape.frames : PTIE_SAMPLES;
    PTIE_TRY(ptie_prepare_create(&s->plan, s->source, &s->rig));
    PTIE_TRY(allocate(s->image, s->shape.images, s->plan->sensor_pixels));
    PTIE_TRY(allocate(s->frame, s->shape.images, s->plan->sensor_pixels));
    PTIE_TRY(allocate(s->plane, s->plan->planes, s->plan->pixels));
    PTIE_TRY(
        ptie_alloc_status(&s->scratch, ptie_prepare_scratch_bytes(s->plan), 1, "rig: scratch"));
    return ptie_source_average(s->source, s->image, s->frames);
}

void ptie_sampling_close(ptie_sampling *s) {
    for (int i = 0; i < PTIE_ROLES; i++) {
        ptie_free(s->image[i]);
        ptie_free(s->frame[i]);
        ptie_free(s->plane[i]);
    }
    ptie_free(s->scratch);
    ptie_prepare_free(s->plan);
    ptie_source_close(s->source);
}

ptie_status ptie_sampling_planes(ptie_sampling *s, float *const *images, ptie_step last) {
    PTIE_TRY(ptie_prepare_raw(s->plan, (const float *const *)images, s->plane, last, s->scratch));
    if (s->plan->reference) /* of a set of one plane */
        memcpy(s->plane[s->plan->measured], s->plan->reference, s->plan->pixels * sizeof(float));
    return PTIE_OK;
}
