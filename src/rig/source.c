/* SPDX-License-Identifier: BSD-3-Clause */
#include "rig/source.h"

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "io/recording.h"
#include "rig/planes.h"

#define MAX_PATH_BYTES 2048

struct ptie_source {
    ptie_source_shape shape;
    ptie_recording *recording[PTIE_ROLES]; /* shape.images of them */
    char path[PTIE_ROLES][MAX_PATH_BYTES]; /* as opened */
};

/* "file.h5" and the rig's "/entry/data/plus" make "file.h5:/entry/data/plus"; a file of another
   kind is the plane itself. */
static ptie_status join(char out[MAX_PATH_BYTES], const char *path, const char *data_set) {
    const bool inside = data_set[0] == '/' && ptie_io_has_data_sets(path);
    int length =
        snprintf(out, MAX_PATH_BYTES, "%s%s%s", path, inside ? ":" : "", inside ? data_set : "");
    if (length < MAX_PATH_BYTES) return PTIE_OK;
    return PTIE_FAIL(PTIE_EINVAL, "%s: path too long", path);
}

/* Another data set of the file that holds plus: "file.h5:/entry/data/plus" is in "file.h5". */
static ptie_status join_beside(char out[MAX_PATH_BYTES], const ptie_source *source,
                               const char *recording, const char *data_set, const char *role) {
    if (!data_set[0])
        return PTIE_FAIL(PTIE_EINVAL,
                         "run: plane '%s' is missing (expected a recording, or its data set in "
                         "the rig's [planes])",
                         role);
    if (strcmp(ptie_io_info(source->recording[0])->format, "HDF5") != 0)
        return PTIE_FAIL(PTIE_EINVAL,
                         "run: plane '%s' is missing (expected a recording of its own, since "
                         "%s has one plane)",
                         role, recording);
    const char *inside = strstr(recording, ":/");
    char file[MAX_PATH_BYTES];
    snprintf(file, sizeof file, "%.*s", inside ? (int)(inside - recording) : (int)strlen(recording),
             recording);
    return join(out, file, data_set);
}

static ptie_status same_shape(const ptie_source *source, int32_t i) {
    const ptie_recording_info *x = ptie_io_info(source->recording[0]),
                              *y = ptie_io_info(source->recording[i]);
    if (x->width_px != y->width_px || x->height_px != y->height_px)
        return PTIE_FAIL(
            PTIE_ESIZE, "%s: frame size differs from %s (expected %d x %d px, found %d x %d)",
            source->path[i], source->path[0], x->width_px, x->height_px, y->width_px, y->height_px);
    if (x->frames != y->frames)
        return PTIE_FAIL(
            PTIE_ESIZE, "%s: number of frames differs from %s (expected %lld, found %lld)",
            source->path[i], source->path[0], (long long)x->frames, (long long)y->frames);
    return PTIE_OK;
}

/* Image i of a frame.  A still recording without data sets serves all planes. */
static ptie_status open_image(ptie_source *source, int32_t i, const ptie_run_params *params,
                              ptie_role role, bool still) {
    const ptie_plane *plane = &params->rig->plane[role];
    char *path = source->path[i];
    if (params->plane[role])
        PTIE_TRY(join(path, params->plane[role], plane->source));
    else if (i == 0 || still)
        PTIE_TRY(join(path, params->recording, plane->source));
    else
        PTIE_TRY(join_beside(path, source, params->recording ? params->recording : source->path[0],
                             plane->source, ptie_role_names[role]));
    PTIE_TRY(ptie_io_open(&source->recording[i], path));
    source->shape.images = i + 1;
    return same_shape(source, i);
}

/* A recording that the rig has no use for is a mistake in it or in the rig. */
static ptie_status check_files(const ptie_run_params *params) {
    const ptie_rig *rig = params->rig;
    for (int i = 0; i < PTIE_ROLES; i++)
        if (params->plane[i] && (!rig->plane[i].used || rig->layout != PTIE_LAYOUT_SEPARATE))
            return PTIE_FAIL(
                PTIE_EINVAL, "run: plane '%s' has no place in the rig's %s", ptie_role_names[i],
                rig->plane[i].used ? "layout (expected one recording)" : "set of planes");
    if (!params->recording && !params->plane[PTIE_PLUS])
        return PTIE_FAIL(PTIE_EINVAL, "run: recording is missing");
    return PTIE_OK;
}

static ptie_status open_images(ptie_source *source, const ptie_run_params *params, bool still) {
    const ptie_rig *rig = params->rig;
    PTIE_TRY(check_files(params));
    int32_t i = 0;
    for (int role = 0; role < PTIE_ROLES; role++) {
        if (!rig->plane[role].used) continue;
        PTIE_TRY(open_image(source, i++, params, (ptie_role)role, still));
        if (rig->layout != PTIE_LAYOUT_SEPARATE) break; /* all planes are in one image */
    }
    const ptie_recording_info *info = ptie_io_info(source->recording[0]);
    source->shape.width_px = info->width_px;
    source->shape.height_px = info->height_px;
    source->shape.frames = info->frames;
    source->shape.frame_rate_hz = info->frame_rate_hz;
    source->shape.white_level = info->white_level;
    source->shape.path = source->path[0];
    return PTIE_OK;
}

static ptie_status open_source(ptie_source **out, const ptie_run_params *params, bool still) {
    *out = NULL;
    ptie_source *source;
    PTIE_TRY(ptie_alloc_status(&source, 1, sizeof *source, "run"));
    ptie_status status = open_images(source, params, still);
    if (status == PTIE_OK)
        *out = source;
    else
        ptie_source_close(source);
    return status;
}

ptie_status ptie_source_open(ptie_source **out, const ptie_run_params *params) {
    return open_source(out, params, false);
}

int64_t ptie_source_sample(const ptie_source *source, int64_t i, int64_t samples) {
    const int64_t last = source->shape.frames - 1, steps = samples > 1 ? samples - 1 : 1;
    return last / steps * i + last % steps * i / steps;
}

static ptie_status add_frames(ptie_source *source, double *sum, float *const *mean, size_t count,
                              int64_t samples) {
    for (int64_t t = 0; t < samples; t++) {
        PTIE_TRY(ptie_source_read(source, ptie_source_sample(source, t, samples), mean));
        for (int32_t k = 0; k < source->shape.images; k++)
            for (size_t i = 0; i < count; i++) sum[(size_t)k * count + i] += (double)mean[k][i];
    }
    return PTIE_OK;
}

ptie_status ptie_source_average(ptie_source *source, float *const *mean, int64_t most) {
    const size_t count = (size_t)source->shape.width_px * (size_t)source->shape.height_px;
    const size_t images = (size_t)source->shape.images;
    const int64_t samples = most < source->shape.frames ? most : source->shape.frames;
    double *sum;
    PTIE_TRY(ptie_alloc_status(&sum, images * count, sizeof *sum, source->path[0]));
    ptie_status status = add_frames(source, sum, mean, count, samples);
    for (size_t k = 0; k < images && status == PTIE_OK; k++)
        for (size_t i = 0; i < count; i++)
            mean[k][i] = (float)(sum[k * count + i] / (double)samples);
    ptie_free(sum);
    return status;
}

/* Still recordings are as large as those they belong to. */
static ptie_status check_like(const ptie_source *source, const ptie_source_shape *like,
                              const char *path) {
    const ptie_source_shape *shape = &source->shape;
    if (shape->width_px == like->width_px && shape->height_px == like->height_px) return PTIE_OK;
    return PTIE_FAIL(
        PTIE_ESIZE,
        "%s: frame size differs from %s (expected %d x %d px, found %d x %d)", path, like->path,
        like->width_px, like->height_px, shape->width_px, shape->height_px);
}

ptie_status ptie_source_mean(float *const *mean, const ptie_source_shape *like, const ptie_rig *rig,
                             const char *path) {
    ptie_source *source;
    PTIE_TRY(open_source(&source, &(ptie_run_params){.rig = rig, .recording = path}, true));
    ptie_status status = check_like(source, like, path);
    if (status == PTIE_OK) status = ptie_source_average(source, mean, INT64_MAX);
    ptie_source_close(source);
    return status;
}

void ptie_source_close(ptie_source *source) {
    if (!source) return;
    for (int32_t i = 0; i < source->shape.images; i++) ptie_io_close(source->recording[i]);
    ptie_free(source);
}

ptie_source_shape ptie_source_get_shape(const ptie_source *source) {
    return source->shape;
}

const char *ptie_source_warning(const ptie_source *source, int32_t image) {
    return ptie_io_info(source->recording[image])->warning;
}

const char *ptie_source_path(const ptie_source *source, int32_t image) {
    return source->path[image];
}

ptie_status ptie_source_read(ptie_source *source, int64_t frame, float *const *images) {
    for (int32_t i = 0; i < source->shape.images; i++)
        PTIE_TRY(ptie_io_read(source->recording[i], frame, images[i]));
    return PTIE_OK;
}
