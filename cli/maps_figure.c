/* SPDX-License-Identifier: BSD-3-Clause */
/* Reads one frame of the recordings that went into a run and came out of it, and draws them. */
#include "maps_figure.h"

#include <stdio.h>
#include <string.h>

#include "cli.h"

enum { MOST_MAPS = 4 };

typedef struct maps {
    ptie_panel panels[MOST_MAPS];
    float *data[MOST_MAPS];
    int32_t count;
} maps;

static ptie_status read_frame(float **data, ptie_recording_info *info, const char *path,
                              int64_t frame) {
    ptie_recording *recording;
    *data = NULL;
    ptie_status status = ptie_recording_open(&recording, path);
    if (status != PTIE_OK) return status;
    *info = *ptie_recording_get_info(recording);
    *data = ptie_scratch_alloc((size_t)info->width_px * (size_t)info->height_px * sizeof **data);
    status = *data ? ptie_recording_read(recording, frame, *data) : PTIE_ENOMEM;
    ptie_recording_close(recording);
    return status;
}

static ptie_status add_map(maps *m, const char *path, int64_t frame, ptie_panel panel) {
    ptie_recording_info info = {.width_px = 0};
    ptie_status status = read_frame(&m->data[m->count], &info, path, frame);
    panel.data = m->data[m->count];
    panel.width_px = info.width_px;
    panel.height_px = info.height_px;
    m->panels[m->count++] = panel;
    return status;
}

/* The data set that the rig names is one of an HDF5 file. */
static void path_of_plus(char path[PATH_BYTES], const ptie_run_params *run) {
    ptie_recording *recording;
    const char *file = run->recording ? run->recording : run->plane[PTIE_PLUS];
    const char *inside = strstr(file, ":/") ? "" : run->rig->plane[PTIE_PLUS].source;
    if (inside[0] && ptie_recording_open(&recording, file) == PTIE_OK) {
        if (strcmp(ptie_recording_get_info(recording)->format, "HDF5") != 0) inside = "";
        ptie_recording_close(recording);
    }
    snprintf(path, PATH_BYTES, "%s%s%s", file, inside[0] ? ":" : "", inside);
}

int check_maps_frame(const ptie_run_params *run, int64_t frame) {
    char path[PATH_BYTES];
    ptie_recording *recording;
    path_of_plus(path, run);
    if (ptie_recording_open(&recording, path) != PTIE_OK) return GO_ON; /* the run says why */
    const ptie_frame_range f = run->frames;
    const int64_t end = f.end ? f.end : ptie_recording_get_info(recording)->frames;
    const int64_t taken = f.first < end ? (end - f.first - 1) / f.step + 1 : 0;
    ptie_recording_close(recording);
    if (taken == 0 || frame < taken) return GO_ON;
    return misused("--figure-frame: expected 0..%lld of the frames processed, or -1, found %lld",
                   (long long)taken - 1, (long long)frame);
}

static ptie_status collect(maps *m, const ptie_run_params *run, int64_t frame, double pixel_m) {
    char path[PATH_BYTES];
    int64_t recorded = run->frames.first + frame * run->frames.step;
    ptie_panel intensity = {
        .title = "as recorded", .colormap = PTIE_GRAY, .pixel_m = run->rig->pixel_m};
    ptie_panel phase = {.unit = "rad", .colormap = PTIE_DIVERGING, .pixel_m = pixel_m};

    path_of_plus(path, run);
    ptie_status status = add_map(m, path, recorded, intensity);
    phase.title = "TIE phase";
    snprintf(path, sizeof path, "%s:/entry/data/phase", run->output);
    if (status == PTIE_OK) status = add_map(m, path, frame, phase);
    phase.title = "denoised phase";
    snprintf(path, sizeof path, "%s:/entry/data/denoised", run->output);
    if (status == PTIE_OK && run->model) status = add_map(m, path, frame, phase);
    phase.title = "true phase";
    phase.pixel_m = pixel_m / run->rig->binning; /* of the planes */
    if (status == PTIE_OK && run->truth) status = add_map(m, run->truth, recorded, phase);
    return status;
}

ptie_status draw_maps(const char *path, const ptie_run_params *run, int64_t frame, double pixel_m) {
    maps m = {.count = 0};
    ptie_status status = collect(&m, run, frame, pixel_m);
    if (status == PTIE_OK) {
        ptie_panels figure = {.panels = m.panels, .rows = 1, .columns = m.count};
        status = ptie_figure_panels(path, &figure, run->overwrite);
    }
    for (int32_t i = 0; i < m.count; i++) ptie_scratch_free(m.data[i]);
    return status;
}
