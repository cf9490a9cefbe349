/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/source.h"

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "io/recording.h"

#define MAX_PATH_BYTES 2048

struct ptie_source {
    ptie_recording *plus, *zero, *minus; /* zero and minus may be NULL */
    int32_t width, height;               /* as recorded */
    int32_t binning;
    float *raw;       /* (height, width): one frame as recorded */
    float *reference; /* binned no-flow frame, or NULL */
};

/* "file.h5" and the rig's "/entry/data/plus" make "file.h5:/entry/data/plus"; a file of another kind is the
   plane itself. */
static ptie_status open_plane(ptie_recording **out, const char *path, const char *dataset) {
    char full[MAX_PATH_BYTES];
    if (dataset[0] != '/' || !ptie_io_has_data_sets(path)) return ptie_io_open(out, path);
    int length = snprintf(full, sizeof full, "%s:%s", path, dataset);
    if (length >= MAX_PATH_BYTES) return PTIE_FAIL(PTIE_EINVAL, "%s: path too long", path);
    return ptie_io_open(out, full);
}

static ptie_status same_shape(const ptie_recording *a, const char *a_path, const ptie_recording *b,
                              const char *b_path, bool frames_too) {
    const ptie_recording_info *x = ptie_io_info(a), *y = ptie_io_info(b);
    if (x->width_px != y->width_px || x->height_px != y->height_px)
        return PTIE_FAIL(PTIE_ESIZE, "%s: frame size differs from %s (expected %d x %d px, found %d x %d)",
                         b_path, a_path, x->width_px, x->height_px, y->width_px, y->height_px);
    if (frames_too && x->frames != y->frames)
        return PTIE_FAIL(PTIE_ESIZE, "%s: number of frames differs from %s (expected %lld, found %lld)",
                         b_path, a_path, (long long)x->frames, (long long)y->frames);
    return PTIE_OK;
}

static ptie_status open_beside_plus(ptie_recording **out, const ptie_source *source,
                                    const ptie_run_params *params, const char *path,
                                    const char *dataset, const char *name) {
    if (!path && !dataset[0])
        return PTIE_FAIL(PTIE_EINVAL, "run: plane '%s' is missing (expected a recording, or its data set in "
                                      "the rig's [planes])", name);
    char beside[MAX_PATH_BYTES];
    if (!path) { /* another data set of the file that holds plus */
        if (strcmp(ptie_io_info(source->plus)->format, "HDF5") != 0)
            return PTIE_FAIL(PTIE_EINVAL, "run: plane '%s' is missing (expected a recording of its own, since "
                                          "%s has one plane)", name, params->plus);
        const char *inside = strstr(params->plus, ":/");
        size_t length = inside ? (size_t)(inside - params->plus) : strlen(params->plus);
        if (length >= sizeof beside) return PTIE_FAIL(PTIE_EINVAL, "%s: path too long", params->plus);
        snprintf(beside, sizeof beside, "%.*s", (int)length, params->plus);
        path = beside;
    }
    PTIE_TRY(open_plane(out, path, dataset));
    return same_shape(source->plus, params->plus, *out, path, true);
}

/* Mean of all frames of the reference recording, binned. */
static ptie_status read_reference(ptie_source *source, const ptie_run_params *params) {
    const char *path = params->reference ? params->reference : params->rig->reference;
    if (!path[0])
        return PTIE_FAIL(PTIE_EINVAL, "run: no-flow reference is missing (expected --reference, or "
                                      "'reference' in the rig's [planes])");
    ptie_recording *recording;
    PTIE_TRY(ptie_io_open(&recording, path));
    ptie_status status = same_shape(source->plus, params->plus, recording, path, false);
    size_t count = (size_t)source->width * (size_t)source->height;
    double *sum = ptie_alloc(count, sizeof *sum);
    if (status == PTIE_OK && !sum) status = PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", path);
    int64_t frames = ptie_io_info(recording)->frames;
    for (int64_t t = 0; t < frames && status == PTIE_OK; t++) {
        status = ptie_io_read(recording, t, source->raw);
        for (size_t i = 0; i < count && status == PTIE_OK; i++) sum[i] += (double)source->raw[i];
    }
    if (status == PTIE_OK) {
        for (size_t i = 0; i < count; i++) source->raw[i] = (float)(sum[i] / (double)frames);
        ptie_bin(source->reference, source->raw, source->width, source->height, source->binning);
    }
    ptie_free(sum);
    ptie_io_close(recording);
    return status;
}

/* A recording that the layout has no use for is a mistake in it or in the rig. */
static ptie_status check_planes(const ptie_run_params *params) {
    static const char *const layouts[] = {"pair", "triple", "reference"};
    const ptie_planes planes = params->rig->planes;
    const char *unused = NULL;
    if (params->zero && planes != PTIE_PLANES_TRIPLE) unused = "plane 'zero'";
    if (params->minus && planes == PTIE_PLANES_REFERENCE) unused = "plane 'minus'";
    if (params->reference && planes != PTIE_PLANES_REFERENCE) unused = "a no-flow reference";
    if (!unused) return PTIE_OK;
    return PTIE_FAIL(PTIE_EINVAL, "run: %s has no place in the rig's layout (expected the planes of '%s')", unused,
                     layouts[planes]);
}

static ptie_status open_planes(ptie_source *source, const ptie_run_params *params) {
    const ptie_rig *rig = params->rig;
    PTIE_TRY(check_planes(params));
    PTIE_TRY(open_plane(&source->plus, params->plus, rig->plus));
    const ptie_recording_info *info = ptie_io_info(source->plus);
    source->width = info->width_px;
    source->height = info->height_px;
    source->binning = rig->binning;
    if (info->width_px / rig->binning < 2 || info->height_px / rig->binning < 2)
        return PTIE_FAIL(PTIE_ESIZE, "%s: frame too small to bin %d x %d (found %d x %d px)", params->plus,
                         rig->binning, rig->binning, info->width_px, info->height_px);
    size_t count = (size_t)source->width * (size_t)source->height;
    PTIE_TRY(ptie_alloc_status(&source->raw, count, sizeof(float), params->plus));
    if (rig->planes == PTIE_PLANES_REFERENCE) {
        PTIE_TRY(ptie_alloc_status(&source->reference, count, sizeof(float), params->plus));
        return read_reference(source, params);
    }
    if (rig->planes == PTIE_PLANES_TRIPLE)
        PTIE_TRY(open_beside_plus(&source->zero, source, params, params->zero, rig->zero, "zero"));
    return open_beside_plus(&source->minus, source, params, params->minus, rig->minus, "minus");
}

ptie_status ptie_source_open(ptie_source **out, const ptie_run_params *params) {
    *out = NULL;
    ptie_source *source;
    PTIE_TRY(ptie_alloc_status(&source, 1, sizeof *source, "run"));
    ptie_status status = open_planes(source, params);
    if (status == PTIE_OK)
        *out = source;
    else
        ptie_source_close(source);
    return status;
}

void ptie_source_close(ptie_source *source) {
    if (!source) return;
    ptie_io_close(source->plus);
    ptie_io_close(source->zero);
    ptie_io_close(source->minus);
    ptie_free(source->raw);
    ptie_free(source->reference);
    ptie_free(source);
}

ptie_source_shape ptie_source_get_shape(const ptie_source *source) {
    const ptie_recording_info *info = ptie_io_info(source->plus);
    return (ptie_source_shape){.width_px = source->width / source->binning,
                               .height_px = source->height / source->binning,
                               .frames = info->frames,
                               .frame_rate_hz = info->frame_rate_hz,
                               .has_zero = source->zero || source->reference,
                               .has_minus = source->minus != NULL};
}

static ptie_status read_binned(ptie_source *source, ptie_recording *recording, int64_t frame, float *out) {
    if (!recording) return PTIE_OK;
    if (source->binning == 1) return ptie_io_read(recording, frame, out);
    PTIE_TRY(ptie_io_read(recording, frame, source->raw));
    ptie_bin(out, source->raw, source->width, source->height, source->binning);
    return PTIE_OK;
}

ptie_status ptie_source_read(ptie_source *source, int64_t frame, float *i_plus, float *i_zero,
                             float *i_minus) {
    ptie_source_shape shape = ptie_source_get_shape(source);
    if (source->reference)
        memcpy(i_zero, source->reference,
               (size_t)shape.width_px * (size_t)shape.height_px * sizeof *i_zero);
    PTIE_TRY(read_binned(source, source->plus, frame, i_plus));
    PTIE_TRY(read_binned(source, source->zero, frame, i_zero));
    return read_binned(source, source->minus, frame, i_minus);
}
