/* SPDX-License-Identifier: BSD-3-Clause */
/* HDF5: a data set [H, W] or [T, H, W] of any numeric type, named or found; MATLAB's v7.3 files are HDF5, too. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "io/detector.h"
#include "io/input.h"
#include "io/nexus.h"
#include "io/reader.h"
#include "io/transpose.h"

#define PATH_BYTES sizeof((ptie_recording_info){0}.dataset)
#define LONGEST_CHAIN 8 /* of @default attributes */

typedef struct h5_recording {
    ptie_h5 *h5;
    int32_t rank, width, height;
    char dataset[PATH_BYTES];
    bool matlab;    /* a MAT file (v7.3): arrays are stored by columns, [T, W, H] */
    float *columns; /* then: one frame as stored */
} h5_recording;

/* The signature is at 0, or behind a user block of 512, 1024, ... bytes. */
static bool h5_probe(const unsigned char *head) {
    for (size_t at = 0; at + 8 <= PTIE_HEAD_BYTES; at = at ? 2 * at : 512)
        if (memcmp(head + at, "\x89HDF\r\n\x1a\n", 8) == 0) return true;
    return false;
}

static void h5_close(void *state) {
    h5_recording *recording = state;
    if (!recording) return;
    ptie_h5_discard(recording->h5);
    ptie_free(recording->columns);
    ptie_free(recording);
}

/* A data set of numbers with two or three dimensions? */
static bool is_recording(ptie_h5 *h5, const char *path) {
    int32_t rank;
    uint64_t dims[4];
    char sample[16];
    return ptie_h5_shape(h5, path, &rank, dims) == PTIE_OK && (rank == 2 || rank == 3) &&
           ptie_h5_sample(h5, path, sample) == PTIE_OK;
}

/* "group/name", or name when it is absolute; false if that is too long. */
static bool join(char path[PATH_BYTES], const char *group, const char *name) {
    if (name[0] == '/' || strcmp(group, "/") == 0) group = "";
    int length = snprintf(path, PATH_BYTES, "%s%s%s", group, name[0] == '/' ? "" : "/", name);
    return length >= 0 && (size_t)length < PATH_BYTES;
}

/* Follows `attribute` of a group to the path it names. */
static bool follow(ptie_h5 *h5, const char *group, const char *attribute, char path[PATH_BYTES]) {
    char *name;
    if (ptie_h5_get_text(h5, group, attribute, &name) != PTIE_OK) return false;
    bool fits = join(path, group, name);
    ptie_free(name);
    return fits;
}

/* NeXus: @default leads from the root to a group whose @signal names the data set. */
static bool find_default(ptie_h5 *h5, char path[PATH_BYTES]) {
    char group[PATH_BYTES] = "/", next[PATH_BYTES];
    for (int step = 0; step < LONGEST_CHAIN; step++) {
        if (follow(h5, group, "signal", path)) return is_recording(h5, path);
        if (!follow(h5, group, "default", next)) return false;
        memcpy(group, next, sizeof group);
    }
    return false;
}

/* An image among MATLAB's variables: no scalar or vector, no text, no part of another variable (/#refs#). */
static bool is_matlab_image(ptie_h5 *h5, const char *path) {
    int32_t rank;
    uint64_t dims[4];
    char *class;
    if (path[1] == '#' || ptie_h5_shape(h5, path, &rank, dims) != PTIE_OK) return false;
    if (ptie_h5_get_text(h5, path, "MATLAB_class", &class) != PTIE_OK) return false;
    const bool text = strcmp(class, "char") == 0;
    ptie_free(class);
    return !text && dims[rank - 1] > 1 && dims[rank - 2] > 1;
}

/* Keeps of `lines` those that are recordings; returns how many. */
static size_t keep_recordings(const h5_recording *recording, char *lines, ptie_text *kept) {
    ptie_h5 *h5 = recording->h5;
    size_t count = 0;
    char *rest = NULL;
    for (char *path = strtok_r(lines, "\n", &rest); path; path = strtok_r(NULL, "\n", &rest)) {
        if (!is_recording(h5, path) || (recording->matlab && !is_matlab_image(h5, path))) continue;
        ptie_text_append(kept, "%s%s", count ? ", " : "", path);
        count++;
    }
    return count;
}

static ptie_status find_only(const h5_recording *recording, const char *file, char path[PATH_BYTES]) {
    ptie_text lines = {0}, kept = {0};
    ptie_status status = ptie_h5_list(recording->h5, &lines);
    if (status == PTIE_OK) {
        size_t count = lines.data ? keep_recordings(recording, lines.data, &kept) : 0;
        if (count == 1)
            snprintf(path, PATH_BYTES, "%s", kept.data);
        else if (count == 0)
            status = PTIE_FAIL(PTIE_EFORMAT, "%s: no numeric data set of 2 or 3 dimensions", file);
        else
            status = PTIE_FAIL(PTIE_EFORMAT, "%s: several data sets (expected %s:PATH, found %s)",
                               file, file, kept.data);
    }
    ptie_text_free(&lines);
    ptie_text_free(&kept);
    return status;
}

static ptie_status find_data_set(h5_recording *recording, const char *file, const char *inside) {
    if (strlen(inside) >= PATH_BYTES)
        return PTIE_FAIL(PTIE_EUNSUPPORTED,
                         "%s: path of the data set too long (expected at most %zu bytes)", file,
                         PATH_BYTES - 1);
    if (*inside)
        memcpy(recording->dataset, inside, strlen(inside));
    else if (!find_default(recording->h5, recording->dataset))
        return find_only(recording, file, recording->dataset);
    return PTIE_OK;
}

static ptie_status take_shape(h5_recording *recording, ptie_recording_info *info,
                              const char *file) {
    uint64_t dims[4];
    PTIE_TRY(ptie_h5_shape(recording->h5, recording->dataset, &recording->rank, dims));
    const int32_t rank = recording->rank;
    if (rank != 2 && rank != 3)
        return PTIE_FAIL(PTIE_EUNSUPPORTED, "%s: %s has %d dimensions (expected 2 or 3)", file,
                         recording->dataset, rank);
    const uint64_t last = dims[rank - 1], before = dims[rank - 2];
    PTIE_TRY(ptie_info_set_size(info, file, recording->matlab ? before : last, recording->matlab ? last : before));
    uint64_t frames = rank == 3 ? dims[0] : 1;
    if (frames < 1 || frames > INT64_MAX)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: %s has no frames", file, recording->dataset);
    info->frames = (int64_t)frames;
    recording->width = info->width_px;
    recording->height = info->height_px;
    return ptie_h5_sample(recording->h5, recording->dataset, info->sample);
}

/* Step of an axis in its SI unit ("um" -> m), if it says one of that quantity; else 0. */
static double axis_step(ptie_h5 *h5, const char *group, const char *axis, ptie_quantity quantity) {
    char path[PATH_BYTES], text[32];
    double values[2], scale;
    uint64_t dims[4];
    int32_t rank;
    char *unit;
    if (!join(path, group, axis)) return 0;
    if (ptie_h5_shape(h5, path, &rank, dims) != PTIE_OK || rank != 1) return 0;
    if (ptie_h5_read(h5, path, PTIE_H5_F64, 0, 2, values) != PTIE_OK) return 0;
    if (ptie_h5_get_text(h5, path, "units", &unit) != PTIE_OK) return 0;
    snprintf(text, sizeof text, "1 %s", unit);
    ptie_free(unit);
    double step = ptie_parse_quantity(text, quantity, &scale) ? 0 : (values[1] - values[0]) * scale;
    return isfinite(step) && step > 0 ? step : 0;
}

/* Which frames of another recording these are, if the time axis says so. */
static void take_frame_numbers(ptie_h5 *h5, const char *group, ptie_recording_info *info) {
    char path[PATH_BYTES];
    int64_t first, step;
    if (!join(path, group, "time")) return;
    if (ptie_h5_get_integer(h5, path, PTIE_NEXUS_FIRST_FRAME, &first) != PTIE_OK) return;
    if (ptie_h5_get_integer(h5, path, PTIE_NEXUS_FRAME_STEP, &step) != PTIE_OK) return;
    /* The number of the last frame must be one. */
    if (first < 0 || step < 1 || info->frames - 1 > (INT64_MAX - first) / step) return;
    info->first_frame = first;
    info->frame_step = step;
}

/* Unit and axes of a NeXus signal, as far as they are there. */
static void take_units(const h5_recording *recording, ptie_recording_info *info) {
    char group[PATH_BYTES];
    char *unit;
    if (ptie_h5_get_text(recording->h5, recording->dataset, "units", &unit) == PTIE_OK) {
        snprintf(info->unit, sizeof info->unit, "%s", unit);
        ptie_free(unit);
    }
    memcpy(group, recording->dataset, sizeof group);
    char *slash = strrchr(group, '/');
    if (slash) *slash = 0;
    info->pixel_m = axis_step(recording->h5, group, "x", PTIE_LENGTH);
    double interval_s = axis_step(recording->h5, group, "time", PTIE_TIME);
    info->frame_rate_hz = interval_s > 0 ? 1 / interval_s : 0;
    take_frame_numbers(recording->h5, group, info);
    ptie_detector_read(recording->h5, info);
}

static ptie_status h5_load(h5_recording *recording, ptie_recording_info *info, const char *path,
                           const char *inside) {
    static const char matlab[] = "MATLAB 7.3";
    unsigned char head[sizeof matlab - 1];
    PTIE_TRY(ptie_input_head(path, head, sizeof head));
    recording->matlab = memcmp(head, matlab, sizeof head) == 0;
    if (recording->matlab) memcpy(info->format, "MAT 7.3", sizeof "MAT 7.3");
    PTIE_TRY(ptie_h5_open(&recording->h5, path));
    PTIE_TRY(find_data_set(recording, path, inside));
    PTIE_TRY(take_shape(recording, info, path));
    memcpy(info->dataset, recording->dataset, sizeof info->dataset);
    take_units(recording, info);
    return PTIE_OK;
}

static ptie_status h5_open(void **state, ptie_recording_info *info, const char *path,
                           const char *inside) {
    h5_recording *recording;
    PTIE_TRY(ptie_alloc_status(&recording, 1, sizeof *recording, path));
    ptie_status status = h5_load(recording, info, path, inside);
    if (status != PTIE_OK) {
        h5_close(recording);
        recording = NULL;
    }
    *state = recording;
    return status;
}

static ptie_status read_columns(h5_recording *recording, int64_t frame, float *data) {
    const size_t width = (size_t)recording->width, height = (size_t)recording->height;
    const bool stack = recording->rank == 3;
    if (!recording->columns)
        PTIE_TRY(ptie_alloc_status(&recording->columns, width * height, sizeof *data, recording->dataset));
    PTIE_TRY(ptie_h5_read(recording->h5, recording->dataset, PTIE_H5_F32, stack ? (uint64_t)frame : 0,
                          stack ? 1 : width, recording->columns));
    ptie_transpose(data, recording->columns, height, width);
    return PTIE_OK;
}

static ptie_status h5_read(void *state, int64_t frame, float *data) {
    h5_recording *recording = state;
    uint64_t first = recording->rank == 3 ? (uint64_t)frame : 0;
    uint64_t rows = recording->rank == 3 ? 1 : (uint64_t)recording->height;
    if (recording->matlab) return read_columns(recording, frame, data);
    return ptie_h5_read(recording->h5, recording->dataset, PTIE_H5_F32, first, rows, data);
}

const ptie_reader ptie_read_h5 = {.name = "HDF5",
                                  .probe = h5_probe,
                                  .open = h5_open,
                                  .read = h5_read,
                                  .close = h5_close,
                                  .has_data_sets = true,
                                  .takes_inside = true};
