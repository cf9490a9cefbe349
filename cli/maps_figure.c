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

static ptie_status collect(maps *m, const ptie_run_params *run, int64_t frame, double pixel_m) {
    char path[PATH_BYTES];
    int64_t recorded = run->first + frame * run->step;
    const char *inside = strstr(run->plus, ":/") ? "" : run->rig->plus;
    ptie_panel intensity = {
        .title = "intensity", .colormap = PTIE_GRAY, .pixel_m = pixel_m / run->rig->binning};
    ptie_panel phase = {.unit = "rad", .colormap = PTIE_DIVERGING, .pixel_m = pixel_m};

    snprintf(path, sizeof path, "%s%s%s", run->plus, inside[0] ? ":" : "", inside);
    ptie_status status = add_map(m, path, recorded, intensity);
    phase.title = "TIE phase";
    snprintf(path, sizeof path, "%s:/entry/data/phase", run->output);
    if (status == PTIE_OK) status = add_map(m, path, frame, phase);
    phase.title = "denoised phase";
    snprintf(path, sizeof path, "%s:/entry/data/denoised", run->output);
    if (status == PTIE_OK && run->model) status = add_map(m, path, frame, phase);
    phase.title = "true phase";
    phase.pixel_m = intensity.pixel_m;
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
