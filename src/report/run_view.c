/* SPDX-License-Identifier: BSD-3-Clause */
#include "report/run_view.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "io/nexus.h"

#define FINISHED PTIE_NEXUS_PROCESS "/finished"
#define WARNINGS PTIE_NEXUS_PROCESS "/warnings"

static ptie_status read_shape(ptie_run_view *v) {
    uint64_t dims[4] = {0}, finished;
    int32_t rank;
    if (!ptie_h5_exists(v->h5, FINISHED) || !ptie_h5_exists(v->h5, PTIE_NEXUS_DATA "/phase"))
        return PTIE_FAIL(PTIE_EFORMAT, "%s: not a result of 'ptie run'", v->path);
    PTIE_TRY(ptie_h5_shape(v->h5, PTIE_NEXUS_DATA "/phase", &rank, dims));
    PTIE_TRY(ptie_h5_read(v->h5, FINISHED, PTIE_H5_U64, 0, 1, &finished));
    if (rank != 3 || dims[1] < 2 || dims[2] < 2 || dims[1] > 32768 || dims[2] > 32768 || finished < 1 || finished > dims[0])
        return PTIE_FAIL(PTIE_EFORMAT, "%s: no finished frames (found %llu of %llu)", v->path,
                         (unsigned long long)finished, (unsigned long long)dims[0]);
    v->frames = (int64_t)dims[0];
    v->finished = (int64_t)finished;
    v->height_px = (int32_t)dims[1];
    v->width_px = (int32_t)dims[2];
    v->pixels = (size_t)dims[1] * (size_t)dims[2];
    v->denoised = ptie_h5_exists(v->h5, PTIE_NEXUS_DATA "/denoised");
    return PTIE_OK;
}

static ptie_status read_axes(ptie_run_view *v) {
    char *unit;
    double x[2];
    PTIE_TRY(ptie_h5_get_text(v->h5, PTIE_NEXUS_DATA "/x", "units", &unit));
    const bool metres = strcmp(unit, "m") == 0;
    ptie_free(unit);
    PTIE_TRY(ptie_h5_read(v->h5, PTIE_NEXUS_DATA "/x", PTIE_H5_F64, 0, 2, x));
    v->pixel_m = metres ? x[1] - x[0] : 0;
    PTIE_TRY(ptie_h5_get_text(v->h5, PTIE_NEXUS_DATA "/time", "units", &unit));
    v->seconds = strcmp(unit, "s") == 0;
    ptie_free(unit);
    PTIE_TRY(ptie_alloc_status(&v->time, (size_t)v->finished, sizeof *v->time, v->path));
    return ptie_h5_read(v->h5, PTIE_NEXUS_DATA "/time", PTIE_H5_F64, 0, (uint64_t)v->finished, v->time);
}

ptie_status ptie_run_view_open(ptie_run_view *v, const char *path) {
    *v = (ptie_run_view){.path = path};
    PTIE_TRY(ptie_h5_open(&v->h5, path));
    PTIE_TRY(read_shape(v));
    return read_axes(v);
}

void ptie_run_view_close(ptie_run_view *v) {
    ptie_h5_discard(v->h5);
    ptie_free(v->time);
}

ptie_status ptie_run_view_map(const ptie_run_view *v, const char *map, int64_t frame, float *out) {
    char path[64];
    snprintf(path, sizeof path, PTIE_NEXUS_DATA "/%s", map);
    return ptie_h5_read(v->h5, path, PTIE_H5_F32, (uint64_t)frame, 1, out);
}

ptie_status ptie_run_view_statistic(const ptie_run_view *v, const char *name, float *out) {
    char path[64];
    snprintf(path, sizeof path, "/entry/statistics/%s", name);
    return ptie_h5_read(v->h5, path, PTIE_H5_F32, 0, (uint64_t)v->height_px, out);
}

bool ptie_run_view_column(const ptie_run_view *v, const char *group, const char *name, double *values) {
    char path[64];
    snprintf(path, sizeof path, "/entry/metrics/%s/%s", group, name);
    return ptie_h5_exists(v->h5, path) &&
           ptie_h5_read(v->h5, path, PTIE_H5_F64, 0, (uint64_t)v->finished, values) == PTIE_OK;
}

char *ptie_run_view_text(const ptie_run_view *v, const char *name) {
    char *text;
    return ptie_h5_get_text(v->h5, PTIE_NEXUS_PROCESS, name, &text) == PTIE_OK ? text : ptie_strdup("");
}

double ptie_run_view_number(const ptie_run_view *v, const char *name) {
    double value;
    return ptie_h5_get_number(v->h5, PTIE_NEXUS_PROCESS, name, &value) == PTIE_OK ? value : (double)NAN;
}

bool ptie_run_view_warning(const ptie_run_view *v, int32_t i, char line[PTIE_H5_LINE_BYTES]) {
    uint64_t dims[4] = {0};
    int32_t rank;
    return ptie_h5_exists(v->h5, WARNINGS) && ptie_h5_shape(v->h5, WARNINGS, &rank, dims) == PTIE_OK &&
           (uint64_t)i < dims[0] && ptie_h5_read(v->h5, WARNINGS, PTIE_H5_LINE, (uint64_t)i, 1, line) == PTIE_OK &&
           memchr(line, 0, PTIE_H5_LINE_BYTES) && line[0];
}
