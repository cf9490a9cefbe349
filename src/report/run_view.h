/* SPDX-License-Identifier: BSD-3-Clause */
/* What a report reads from the result file of a run (docs/formats.md). */
#ifndef PTIE_REPORT_RUN_VIEW_H
#define PTIE_REPORT_RUN_VIEW_H

#include "io/h5.h"

typedef struct ptie_run_view {
    ptie_h5 *h5;
    const char *path;
    int64_t frames, finished; /* of the run; what there is of them */
    int32_t width_px, height_px;
    size_t pixels;
    bool denoised;
    double pixel_m;        /* 0: not known */
    bool seconds;          /* time is in s, else the frame's number */
    double *time;          /* (finished) */
} ptie_run_view;

ptie_status ptie_run_view_open(ptie_run_view *view, const char *path);
void ptie_run_view_close(ptie_run_view *view);

/* map: "phase", "denoised". */
ptie_status ptie_run_view_map(const ptie_run_view *view, const char *map, int64_t frame, float *out);
/* name: "phase_mean", ... under /entry/statistics. */
ptie_status ptie_run_view_statistic(const ptie_run_view *view, const char *name, float *out);
/* values (finished): "mgm" of "phase", ...; false if the run has none. */
bool ptie_run_view_column(const ptie_run_view *view, const char *group, const char *name, double *values);
/* Attribute of the process, "" if there is none; freed with ptie_free.  NULL when memory is short. */
char *ptie_run_view_text(const ptie_run_view *view, const char *name);
double ptie_run_view_number(const ptie_run_view *view, const char *name); /* NaN if there is none */
/* Line `i` of the warnings; false behind the last. */
bool ptie_run_view_warning(const ptie_run_view *view, int32_t i, char line[PTIE_H5_LINE_BYTES]);

#endif
