/* SPDX-License-Identifier: BSD-3-Clause */
/* The frames of a run, one by one.  The metrics need regions; where none are given they are proposed from the first
   frames, which are therefore solved before they are measured. */
#include <math.h>
#include <string.h>

#include "metrics/metrics.h"
#include "run/job.h"
#include "run/stages.h"

static ptie_status read_truth(ptie_job *r, int64_t frame, ptie_slot *s) {
    return r->truth ? ptie_io_read(r->truth, ptie_job_frame(r, frame), s->truth_raw) : PTIE_OK;
}

static ptie_status read_frame(void *context, int64_t frame, size_t i) {
    ptie_job *r = context;
    PTIE_TRY(read_truth(r, frame, &r->slots[i]));
    return ptie_source_read(r->source, ptie_job_frame(r, frame), r->slots[i].image);
}

static void bin_truth(const ptie_job *r, ptie_slot *s) {
    if (!r->truth) return;
    const ptie_recording_info *info = ptie_io_info(r->truth);
    ptie_bin(s->truth, s->truth_raw, info->width_px, info->height_px, r->params->rig->binning);
}

/* What the planes say of the maps, while they are at hand. */
static ptie_status compare_with_planes(const ptie_job *r, ptie_slot *s, const ptie_desk *d, int32_t worker) {
    const float *const maps[PTIE_RUN_MAPS] = {s->phase, s->denoised, s->truth};
    const float *present[PTIE_RUN_MAPS], *planes[PTIE_ROLES];
    double residual[PTIE_RUN_MAPS];
    size_t count = 0;
    for (int k = 0; k < PTIE_RUN_MAPS; k++)
        if (maps[k]) present[count++] = maps[k];
    for (int32_t k = 0; k < r->shape.planes; k++) planes[k] = d->plane[k];
    PTIE_TRY(ptie_reprojection_measure(r->reprojection, worker, residual, present, count, planes));
    count = 0;
    for (int k = 0; k < PTIE_RUN_MAPS; k++)
        if (maps[k]) s->row[k * PTIE_RUN_METRICS + PTIE_RESIDUAL] = residual[count++];
    return PTIE_OK;
}

/* What the images and planes say of themselves. */
static void inspect_planes(const ptie_job *r, ptie_slot *s, const ptie_desk *d) {
    double *number = s->row + PTIE_ROW_OF_FRAME, mean[PTIE_ROLES];
    const double all = ptie_job_brightness(r, d, mean), limit = r->params->rig->saturation_counts;
    double off = 0, saturated = 0;
    for (int32_t k = 0; k < r->shape.planes; k++) off = fmax(off, fabs(mean[k] / all - 1));
    for (int32_t i = 0; i < r->recorded.images && limit > 0; i++)
        saturated = fmax(saturated, ptie_run_share_above(s->image[i], r->recorded_pixels, limit));
    const double sigma = ptie_run_plane_noise((ptie_lit_plane){d->plane[0], mean[0]},
                                              (ptie_lit_plane){d->plane[1], mean[1]}, r->shape.width_px,
                                              r->shape.height_px);
    number[PTIE_NOISE_RAD] = ptie_frame_noise_rad(r->plan, sigma);
    number[PTIE_SATURATED] = limit > 0 ? saturated : (double)NAN;
    number[PTIE_IMBALANCE] = off;
    number[PTIE_BRIGHTNESS] = all / r->first_brightness;
}

static ptie_status measure_maps(const ptie_job *r, ptie_slot *s) {
    const float *const maps[PTIE_RUN_MAPS] = {s->phase, s->denoised, s->truth};
    double *background = s->row + PTIE_ROW_OF_FRAME + PTIE_BACKGROUND_RAD;
    for (int k = 0; k < PTIE_RUN_MAPS; k++)
        if (maps[k])
            PTIE_TRY(ptie_run_measure(s->row + k * PTIE_RUN_METRICS, k == PTIE_OF_PHASE ? background : NULL, maps[k],
                                      k == PTIE_OF_TRUTH ? NULL : s->truth, r->has_regions ? r->labels : NULL,
                                      r->shape.width_px, r->shape.height_px));
    return PTIE_OK;
}

static ptie_status solve_frame(void *context, int64_t frame, size_t i, int32_t worker) {
    (void)frame;
    ptie_job *r = context;
    ptie_slot *s = &r->slots[i];
    const ptie_desk *d = &r->desks[worker];
    const float *planes[PTIE_ROLES];
    for (int k = 0; k < PTIE_ROW; k++) s->row[k] = (double)NAN;
    PTIE_TRY(ptie_job_planes(r, s, d));
    for (int32_t k = 0; k < r->shape.planes; k++) planes[k] = d->plane[k];
    float *measured = ptie_reprojection_measured(r->reprojection, worker);
    PTIE_TRY(measured ? ptie_frame_solve_measured(r->plan, worker, s->phase, s->denoised, measured, planes)
                      : ptie_frame_solve(r->plan, worker, s->phase, s->denoised, planes));
    bin_truth(r, s);
    inspect_planes(r, s, d);
    PTIE_TRY(compare_with_planes(r, s, d, worker));
    return r->labelled ? measure_maps(r, s) : PTIE_OK;
}

/* A row joins the table and the statistics; with it the frame is finished. */
static ptie_status take_row(ptie_job *r, int64_t frame, const double *row) {
    const int64_t tenth = r->frames / 10;
    const double background = row[PTIE_ROW_OF_FRAME + PTIE_BACKGROUND_RAD];
    for (int k = 0; k < PTIE_ROW; k++) ptie_running_add(&r->running[k], row[k]);
    if (frame < tenth) ptie_running_add(&r->early, background);
    if (frame >= r->frames - tenth) ptie_running_add(&r->late, background);
    return ptie_table_append(&r->table, ptie_job_frame(r, frame), row);
}

static void take_maps(ptie_job *r, const ptie_slot *s) {
    ptie_average_add(&r->phase_average, s->phase);
    if (s->denoised) ptie_average_add(&r->denoised_average, s->denoised);
}

static ptie_status write_row(void *context, int64_t frame, size_t i) {
    ptie_job *r = context;
    PTIE_TRY(ptie_result_write_row(r->result, frame, r->slots[i].row));
    PTIE_TRY(take_row(r, frame, r->slots[i].row));
    return ptie_result_finish(r->result, frame + 1);
}

static ptie_status write_frame(void *context, int64_t frame, size_t i) {
    ptie_job *r = context;
    ptie_slot *s = &r->slots[i];
    PTIE_TRY(ptie_result_write_maps(r->result, frame, s->phase, s->denoised));
    take_maps(r, s);
    return r->labelled ? write_row(r, frame, i) : ptie_result_write_row(r->result, frame, s->row);
}

static ptie_status stream(ptie_job *r, int64_t first, int64_t end, ptie_progress progress) {
    return ptie_stages_run(&(ptie_stages){.read = read_frame,
                                          .solve = solve_frame,
                                          .write = write_frame,
                                          .context = r,
                                          .first = first,
                                          .end = end,
                                          .slots = r->slot_count,
                                          .progress = progress,
                                          .total = r->frames},
                           r->engine->pool);
}

/* --- the first frames, where regions are to be proposed ------------------------------------------------ */

static ptie_status read_back(void *context, int64_t frame, size_t i) {
    ptie_job *r = context;
    ptie_slot *s = &r->slots[i];
    PTIE_TRY(read_truth(r, frame, s));
    PTIE_TRY(ptie_result_read_row(r->result, frame, s->row));
    return ptie_result_read_maps(r->result, frame, s->phase, s->denoised);
}

static ptie_status measure_frame(void *context, int64_t frame, size_t i, int32_t worker) {
    (void)frame, (void)worker;
    ptie_job *r = context;
    bin_truth(r, &r->slots[i]);
    return measure_maps(r, &r->slots[i]);
}

/* From the mean of the best map.  Maps without flow have no regions, which is no reason to give up the maps. */
static ptie_status propose_regions(ptie_job *r) {
    float *mean = r->slots[0].phase; /* free between two streams */
    ptie_average_mean(r->params->model ? &r->denoised_average : &r->phase_average, mean);
    const ptie_status status = ptie_metrics_propose(r->labels, mean, r->shape.width_px, r->shape.height_px);
    r->has_regions = status == PTIE_OK;
    r->labelled = true;
    if (status == PTIE_ENUMERIC) memset(r->labels, PTIE_NOWHERE, r->pixels);
    if (status != PTIE_OK && status != PTIE_ENUMERIC) return status;
    return ptie_result_write(r->result, PTIE_RESULT_REGIONS, r->labels);
}

static ptie_status run_sample(ptie_job *r, ptie_progress progress) {
    PTIE_TRY(stream(r, 0, r->sample, progress));
    PTIE_TRY(propose_regions(r));
    return ptie_stages_run(&(ptie_stages){.read = read_back,
                                          .solve = measure_frame,
                                          .write = write_row,
                                          .context = r,
                                          .end = r->sample,
                                          .slots = r->slot_count,
                                          .total = r->frames},
                           r->engine->pool);
}

/* --- all of them ---------------------------------------------------------------------------------------- */

/* Takes in what an interrupted run finished. */
static ptie_status catch_up(ptie_job *r) {
    ptie_slot *s = &r->slots[0];
    PTIE_TRY(ptie_result_read(r->result, PTIE_RESULT_REGIONS, r->labels));
    r->labelled = true;
    r->has_regions = memchr(r->labels, PTIE_JET, r->pixels) != NULL;
    r->resumed = ptie_result_finished(r->result);
    for (int64_t t = 0; t < r->resumed; t++) {
        PTIE_TRY(ptie_result_read_row(r->result, t, s->row));
        PTIE_TRY(ptie_result_read_maps(r->result, t, s->phase, s->denoised));
        take_maps(r, s);
        PTIE_TRY(take_row(r, t, s->row));
    }
    return PTIE_OK;
}

ptie_status ptie_job_frames(ptie_job *r, ptie_progress progress) {
    if (ptie_result_finished(r->result) > 0)
        PTIE_TRY(catch_up(r));
    else if (!r->labelled)
        PTIE_TRY(run_sample(r, progress));
    const int64_t done = ptie_result_finished(r->result);
    PTIE_TRY(ptie_progress_report(progress, (uint64_t)done, (uint64_t)r->frames, NULL));
    return stream(r, done, r->frames, progress);
}
