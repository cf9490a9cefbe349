/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/prepare.h"

#include <string.h>

#include "base/memory.h"
#include "io/recording.h"
#include "run/planes.h"

struct ptie_prepare {
    ptie_prepare_shape shape;
    ptie_role role[PTIE_ROLES];
    int32_t width, height; /* of a sensor image */
    int32_t binning;
    float *reference; /* binned no-flow frame, or NULL */
};

/* Mean of all frames of a recording that belongs to the sensor images. */
static ptie_status read_mean(float *mean, const ptie_prepare *p, const char *path) {
    ptie_recording *recording;
    PTIE_TRY(ptie_io_open(&recording, path));
    const ptie_recording_info *info = ptie_io_info(recording);
    const size_t count = (size_t)p->width * (size_t)p->height;
    ptie_status status = PTIE_OK;
    double *sum = NULL;
    if (info->width_px != p->width || info->height_px != p->height)
        status = PTIE_FAIL(PTIE_ESIZE, "%s: frame size differs from the recording's (expected %d x %d px, found "
                                       "%d x %d)", path, p->width, p->height, info->width_px, info->height_px);
    if (status == PTIE_OK) status = ptie_alloc_status(&sum, count, sizeof *sum, path);
    for (int64_t t = 0; t < info->frames && status == PTIE_OK; t++) {
        status = ptie_io_read(recording, t, mean);
        for (size_t i = 0; i < count && status == PTIE_OK; i++) sum[i] += (double)mean[i];
    }
    for (size_t i = 0; i < count && status == PTIE_OK; i++) mean[i] = (float)(sum[i] / (double)info->frames);
    ptie_free(sum);
    ptie_io_close(recording);
    return status;
}

static ptie_status read_reference(ptie_prepare *p, const char *path) {
    float *frame;
    if (!path[0])
        return PTIE_FAIL(PTIE_EINVAL, "run: no-flow reference is missing (expected --reference, or "
                                      "'reference' in the rig's [recording])");
    const size_t count = (size_t)p->width * (size_t)p->height;
    PTIE_TRY(ptie_alloc_status(&p->reference, count, sizeof(float), path));
    PTIE_TRY(ptie_alloc_status(&frame, count, sizeof(float), path));
    ptie_status status = read_mean(frame, p, path);
    if (status == PTIE_OK) ptie_bin(p->reference, frame, p->width, p->height, p->binning);
    ptie_free(frame);
    return status;
}

static ptie_status build(ptie_prepare *p, const ptie_source_shape *source, const ptie_rig *rig) {
    if (rig->layout != PTIE_LAYOUT_SEPARATE)
        return PTIE_FAIL(PTIE_EUNSUPPORTED, "run: planes in one sensor image are not read yet");
    p->width = source->width_px;
    p->height = source->height_px;
    p->binning = rig->binning;
    p->shape = (ptie_prepare_shape){.width_px = p->width / rig->binning,
                                    .height_px = p->height / rig->binning,
                                    .pixel_m = ptie_rig_pixel_m(rig)};
    p->shape.planes = ptie_rig_planes(rig, p->role, p->shape.z_m);
    if (p->shape.width_px < 2 || p->shape.height_px < 2)
        return PTIE_FAIL(PTIE_ESIZE, "run: frame too small to bin %d x %d (found %d x %d px)", rig->binning,
                         rig->binning, p->width, p->height);
    return rig->one_plane ? read_reference(p, rig->reference) : PTIE_OK;
}

ptie_status ptie_prepare_create(ptie_prepare **out, const ptie_source *source, const ptie_rig *rig) {
    *out = NULL;
    ptie_prepare *p;
    PTIE_TRY(ptie_alloc_status(&p, 1, sizeof *p, "run"));
    const ptie_source_shape shape = ptie_source_get_shape(source);
    ptie_status status = build(p, &shape, rig);
    if (status == PTIE_OK)
        *out = p;
    else
        ptie_prepare_free(p);
    return status;
}

void ptie_prepare_free(ptie_prepare *p) {
    if (!p) return;
    ptie_free(p->reference);
    ptie_free(p);
}

ptie_prepare_shape ptie_prepare_get_shape(const ptie_prepare *p) {
    return p->shape;
}

size_t ptie_prepare_scratch_bytes(const ptie_prepare *p) {
    (void)p;
    return 0;
}

ptie_status ptie_prepare_run(const ptie_prepare *p, const float *const *images, float *const *planes,
                             void *scratch) {
    (void)scratch;
    const size_t bytes = (size_t)p->shape.width_px * (size_t)p->shape.height_px * sizeof(float);
    for (int32_t i = 0, image = 0; i < p->shape.planes; i++) {
        if (p->reference && p->role[i] == PTIE_ZERO)
            memcpy(planes[i], p->reference, bytes);
        else
            ptie_bin(planes[i], images[image++], p->width, p->height, p->binning);
    }
    return PTIE_OK;
}
