/* SPDX-License-Identifier: BSD-3-Clause */
#include "series.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Adds a recording; without `must`, one that is not there is no failure. */
static ptie_status add_series(series_set *set, const char *path, const char *inside,
                              const char *name, const char *key, bool must) {
    series *s = &set->series[set->count];
    snprintf(s->path, sizeof s->path, "%s%s", path, inside);
    ptie_status status = ptie_recording_open(&s->recording, s->path);
    if (status != PTIE_OK) return must ? status : PTIE_OK;
    s->name = name;
    s->key = key;
    set->count++;
    return PTIE_OK;
}

static ptie_status open_recordings(series_set *set, const operand_list *files) {
    const char *first = files->value[0];
    ptie_status status = PTIE_OK;
    if (files->count == 1) {
        status = add_series(set, first, ":/entry/data/phase", "TIE phase", "phase", false);
        if (status == PTIE_OK)
            status = add_series(set, first, ":/entry/data/denoised", "denoised", "denoised", false);
        if (set->count > 0) return status;
    }
    for (int i = 0; i < files->count && status == PTIE_OK; i++)
        status = add_series(set, files->value[i], "", files->value[i], files->value[i], true);
    return status;
}

static int check_size(const series_set *set, const series *s) {
    const ptie_recording_info *info = ptie_recording_get_info(s->recording);
    if (info->width_px == set->width && info->height_px == set->height &&
        info->frames >= set->frames)
        return GO_ON;
    say("ptie: %s: does not fit %s (expected %lld frames of %d x %d px, found %lld of %d x %d)",
        s->path, set->series[0].path, (long long)set->frames, set->width, set->height,
        (long long)info->frames, info->width_px, info->height_px);
    return FAILED;
}

static int allocate(series_set *set) {
    set->map = calloc(set->pixels, sizeof *set->map);
    set->true_map = calloc(set->pixels, sizeof *set->true_map);
    set->labels = calloc(set->pixels, 1);
    bool enough = set->map && set->true_map && set->labels;
    for (int i = 0; i < set->count; i++)
        for (int k = 0; k < MEASURES; k++) {
            set->series[i].value[k] = calloc((size_t)set->frames, sizeof(double));
            enough &= set->series[i].value[k] != NULL;
        }
    return enough ? GO_ON : failed(PTIE_ENOMEM);
}

/* The truth's frame that belongs to frame t, or -1. */
static int64_t true_frame(const series_set *set, int64_t t) {
    const ptie_recording_info *info = ptie_recording_get_info(set->truth->recording);
    int64_t behind = set->first_frame + t * set->frame_step - info->first_frame;
    bool there =
        behind >= 0 && behind % info->frame_step == 0 && behind / info->frame_step < info->frames;
    return there ? behind / info->frame_step : -1;
}

static int check_truth(const series_set *set) {
    const series *s = set->truth;
    const ptie_recording_info *info = ptie_recording_get_info(s->recording);
    if (info->width_px != set->width || info->height_px != set->height) return check_size(set, s);
    for (int64_t t = 0; t < set->frames; t++) {
        if (true_frame(set, t) >= 0) continue;
        say("ptie: %s: has no truth for frame %lld of the recording (found %lld frames)", s->path,
            (long long)(set->first_frame + t * set->frame_step), (long long)info->frames);
        return FAILED;
    }
    return GO_ON;
}

int open_series(series_set *set, const operand_list *files, const char *truth) {
    ptie_status status = open_recordings(set, files);
    if (status == PTIE_OK && truth) {
        status = add_series(set, truth, "", "truth", "truth", true);
        set->truth = &set->series[set->count - 1];
    }
    if (status != PTIE_OK) return failed(status);
    const ptie_recording_info *info = ptie_recording_get_info(set->series[0].recording);
    set->frames = info->frames;
    set->width = info->width_px;
    set->height = info->height_px;
    set->first_frame = info->first_frame;
    set->frame_step = info->frame_step;
    set->pixels = (size_t)set->width * (size_t)set->height;
    int code = GO_ON;
    for (int i = 1; i < set->count && code == GO_ON; i++)
        code = &set->series[i] == set->truth ? check_truth(set) : check_size(set, &set->series[i]);
    return code == GO_ON ? allocate(set) : code;
}

/* The mean over frames of the last recording that is not the truth. */
static ptie_status take_mean(series_set *set, const series *last, float *mean) {
    for (int64_t t = 0; t < set->frames; t++) {
        ptie_status status = ptie_recording_read(last->recording, t, set->map);
        if (status != PTIE_OK) return status;
        for (size_t i = 0; i < set->pixels; i++) mean[i] += set->map[i] / (float)set->frames;
    }
    return PTIE_OK;
}

int label_regions(series_set *set, ptie_rect jet, ptie_rect background) {
    if (jet.width_px > 0) {
        ptie_status status = ptie_regions_from_rects(set->labels, set->width, set->height, jet, background);
        return status == PTIE_OK ? GO_ON : failed(status);
    }
    const series *last = &set->series[set->count - (set->truth ? 2 : 1)];
    float *mean = set->true_map; /* not in use yet */
    ptie_status status = take_mean(set, last, mean);
    if (status != PTIE_OK) return failed(status);
    if (ptie_regions_propose(set->labels, mean, set->width, set->height) == PTIE_OK) return GO_ON;
    say("ptie: %s: mean %s", last->path, ptie_last_error()); /* "map: is constant (...)" */
    return FAILED;
}

/* A TIE phase has no mean, so none is compared. */
static void take_mean_out(float *map, size_t count) {
    double mean = 0;
    for (size_t i = 0; i < count; i++) mean += (double)map[i];
    for (size_t i = 0; i < count; i++) map[i] -= (float)(mean / (double)count);
}

/* The map in set->map. */
static ptie_status compare_with_truth(series_set *set, ptie_comparison *found, int64_t t) {
    ptie_status status =
        ptie_recording_read(set->truth->recording, true_frame(set, t), set->true_map);
    if (status != PTIE_OK) return status;
    take_mean_out(set->map, set->pixels);
    take_mean_out(set->true_map, set->pixels);
    return ptie_compare(found, set->map, set->true_map, set->width, set->height, 1);
}

static ptie_status measure_one(series_set *set, series *s, int64_t t) {
    ptie_flow_metrics flow;
    ptie_comparison truth = {
        .rmse = (double)NAN, .correlation = (double)NAN, .signal_kept = (double)NAN};
    ptie_status status =
        ptie_recording_read(s->recording, s == set->truth ? true_frame(set, t) : t, set->map);
    if (status == PTIE_OK)
        status = ptie_flow_measure(&flow, set->map, set->labels, set->width, set->height);
    if (status == PTIE_OK && set->truth && s != set->truth)
        status = compare_with_truth(set, &truth, t);
    if (status != PTIE_OK) return status;
    const double found[MEASURES] = {flow.mgm,          flow.sbr,   flow.bns,
                                    flow.cnr,          truth.rmse, truth.correlation,
                                    truth.signal_kept, (double)NAN}; /* no planes */
    for (int k = 0; k < MEASURES; k++) s->value[k][t] = found[k];
    return PTIE_OK;
}

ptie_status measure_frame(series_set *set, int64_t t) {
    for (int i = 0; i < set->count; i++) {
        ptie_status status = measure_one(set, &set->series[i], t);
        if (status != PTIE_OK) return status;
    }
    return PTIE_OK;
}

static ptie_stat over_frames(const double *values, int64_t frames) {
    double mean = 0, squares = 0;
    int64_t count = 0;
    for (int64_t t = 0; t < frames; t++)
        if (isfinite(values[t])) mean += values[t], count++;
    if (count == 0) return (ptie_stat){(double)NAN, (double)NAN};
    mean /= (double)count;
    for (int64_t t = 0; t < frames; t++)
        if (isfinite(values[t])) squares += (values[t] - mean) * (values[t] - mean);
    return (ptie_stat){mean, count > 1 ? sqrt(squares / (double)(count - 1)) : 0};
}

ptie_run_row summarise_series(const series_set *set, int which) {
    ptie_run_row row;
    for (int k = 0; k < MEASURES; k++)
        *measure_in(&row, k) = over_frames(set->series[which].value[k], set->frames);
    return row;
}

void close_series(series_set *set) {
    for (int i = 0; i < set->count; i++) {
        ptie_recording_close(set->series[i].recording);
        for (int k = 0; k < MEASURES; k++) free(set->series[i].value[k]);
    }
    free(set->map);
    free(set->true_map);
    free(set->labels);
}
