/* SPDX-License-Identifier: BSD-3-Clause */
/* recording -> planes -> phase -> denoised phase -> numbers, as a stream: frames are read ahead, computed on all
   threads, and written in order.  The metrics need regions; where none are given they are proposed from the first
   frames, which are therefore solved before they are measured. */
#include "run/run.h"

#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "io/recording.h"
#include "metrics/metrics.h"
#include "run/average.h"
#include "run/background.h"
#include "rig/cutoff.h"
#include "rig/prepare.h"
#include "run/reprojection.h"
#include "run/result.h"
#include "run/settings.h"
#include "run/stages.h"
#include "run/table.h"
#include "run/warnings.h"
#include "run/worker.h"

/* Frames that regions are proposed from.  A fixed number: what is proposed must not depend on how far a run came
   before it was interrupted. */
enum { SAMPLE = 32 };

/* One frame on its way. */
typedef struct slot {
    float *image[PTIE_ROLES];     /* as recorded */
    float *truth_raw, *truth;     /* as recorded; binned.  NULL without truth */
    float *phase, *denoised;      /* denoised: NULL without a model */
    double row[PTIE_ROW];
} slot;

/* What a worker has of its own. */
typedef struct desk {
    float *plane[PTIE_ROLES];
    void *scratch; /* for the preparation */
} desk;

typedef struct run {
    const ptie_engine *engine;
    const ptie_run_params *params; /* as given, but for the rig: */
    ptie_run_params own_params;
    ptie_rig own_rig; /* with the cut-off that was chosen */
    ptie_source *source;
    ptie_prepare *preparation;
    ptie_recording *truth; /* or NULL */
    ptie_frame_plan *plan;
    ptie_reprojection *reprojection;
    ptie_result *result;
    ptie_table table;
    ptie_source_shape recorded;
    ptie_prepare_shape shape;
    size_t pixels, recorded_pixels;
    int64_t frames, sample, resumed;

    slot *slots;
    desk *desks;
    size_t slot_count;
    unsigned char *memory; /* of all slots and desks */

    uint8_t *labels;  /* (H, W) */
    bool has_regions; /* labels has both of them */
    bool labelled;    /* it is decided */
    double first_brightness;
    ptie_average phase_average, denoised_average;
    ptie_running running[PTIE_ROW];
    ptie_running early, late; /* background of the first and the last tenth */
} run;

/* Recording frame that is frame i of the run. */
static int64_t recorded_frame(const run *r, int64_t i) {
    return r->params->frames.first + i * r->params->frames.step;
}

/* --- before the first frame -------------------------------------------------------------------------- */

static ptie_status choose_frames(run *r) {
    PTIE_TRY(ptie_io_choose(&r->frames, r->params->frames, r->recorded.frames, ptie_run_name(r->params)));
    r->sample = r->frames < SAMPLE ? r->frames : SAMPLE;
    return PTIE_OK;
}

static ptie_status open_truth(run *r) {
    const char *path = r->params->truth;
    if (!path) return PTIE_OK;
    PTIE_TRY(ptie_io_open(&r->truth, path));
    const ptie_recording_info *info = ptie_io_info(r->truth);
    const int32_t binning = r->params->rig->binning;
    if (info->width_px / binning != r->shape.width_px || info->height_px / binning != r->shape.height_px)
        return PTIE_FAIL(PTIE_ESIZE, "%s: truth does not fit the phase (expected %d x %d px, found %d x %d)",
                         path, r->shape.width_px * binning, r->shape.height_px * binning, info->width_px,
                         info->height_px);
    if (info->frames >= r->recorded.frames) return PTIE_OK;
    return PTIE_FAIL(PTIE_ESIZE, "%s: too few frames of truth (expected %lld, found %lld)", path,
                     (long long)r->recorded.frames, (long long)info->frames);
}

static void carve_slot(const run *r, slot *s, ptie_slicer *slicer) {
    for (int32_t i = 0; i < r->recorded.images; i++)
        s->image[i] = ptie_slice(slicer, r->recorded_pixels, sizeof(float));
    if (r->truth) {
        const ptie_recording_info *info = ptie_io_info(r->truth);
        s->truth_raw = ptie_slice(slicer, (size_t)info->width_px * (size_t)info->height_px, sizeof(float));
        s->truth = ptie_slice(slicer, r->pixels, sizeof(float));
    }
    s->phase = ptie_slice(slicer, r->pixels, sizeof(float));
    if (r->params->model) s->denoised = ptie_slice(slicer, r->pixels, sizeof(float));
}

static void carve(run *r, ptie_slicer *slicer, int32_t workers) {
    for (size_t i = 0; i < r->slot_count; i++) carve_slot(r, &r->slots[i], slicer);
    for (int32_t w = 0; w < workers; w++) {
        for (int32_t k = 0; k < r->shape.planes; k++)
            r->desks[w].plane[k] = ptie_slice(slicer, r->pixels, sizeof(float));
        r->desks[w].scratch = ptie_slice(slicer, ptie_prepare_scratch_bytes(r->preparation), 1);
    }
}

static ptie_status allocate(run *r) {
    const int32_t workers = ptie_pool_threads(r->engine->pool);
    ptie_slicer slicer = {0};
    r->slot_count = ptie_stages_slots(r->engine->pool, r->frames);
    PTIE_TRY(ptie_alloc_status(&r->slots, r->slot_count, sizeof *r->slots, "run"));
    PTIE_TRY(ptie_alloc_status(&r->desks, (size_t)workers, sizeof *r->desks, "run"));
    carve(r, &slicer, workers);
    PTIE_TRY(ptie_alloc_status(&r->memory, slicer.used, 1, "run: frames"));
    carve(r, &(ptie_slicer){.base = r->memory}, workers);
    PTIE_TRY(ptie_average_create(&r->phase_average, r->pixels));
    if (r->params->model) PTIE_TRY(ptie_average_create(&r->denoised_average, r->pixels));
    return ptie_alloc_status(&r->labels, r->pixels, 1, "run");
}

static ptie_status check_outputs(const ptie_run_params *p) {
    const char *const inputs[] = {p->recording, p->truth, p->rig->reference, p->rig->dark, p->rig->mask,
                                  p->plane[0], p->plane[1], p->plane[2], p->plane[3], p->plane[4]};
    for (size_t i = 0; i < sizeof inputs / sizeof *inputs; i++) {
        PTIE_TRY(ptie_output_differs(p->output, inputs[i]));
        if (p->metrics_csv) PTIE_TRY(ptie_output_differs(p->metrics_csv, inputs[i]));
    }
    return ptie_output_differs(p->output, p->metrics_csv);
}

static ptie_status open_inputs(run *r) {
    const ptie_run_params *p = r->params;
    PTIE_TRY(ptie_source_open(&r->source, p));
    r->recorded = ptie_source_get_shape(r->source);
    r->recorded_pixels = (size_t)r->recorded.width_px * (size_t)r->recorded.height_px;
    PTIE_TRY(ptie_prepare_create(&r->preparation, r->source, p->rig));
    r->shape = ptie_prepare_get_shape(r->preparation);
    r->pixels = (size_t)r->shape.width_px * (size_t)r->shape.height_px;
    PTIE_TRY(choose_frames(r));
    return open_truth(r);
}

static ptie_status choose_cutoff(run *r) {
    r->own_params = *r->params;
    r->own_rig = *r->params->rig;
    r->own_params.rig = &r->own_rig;
    PTIE_TRY(ptie_run_cutoff(&r->own_rig.cutoff_m, r->params->rig, r->source, r->preparation,
                             r->params->frames.first, r->frames, r->params->frames.step));
    r->params = &r->own_params;
    return PTIE_OK;
}

static ptie_status make_plans(run *r) {
    PTIE_TRY(choose_cutoff(r));
    const ptie_run_params *p = r->params;
    const ptie_denoiser_params denoising = {.fast = p->fast, .all_threads = r->frames == 1};
    PTIE_TRY(ptie_frame_plan_create(&r->plan, r->engine, p->rig, ptie_prepare_mask(r->preparation), p->model,
                                    r->shape.width_px, r->shape.height_px, &denoising));
    PTIE_TRY(ptie_background_measure(r->plan, r->source, r->preparation, p->rig));
    return ptie_reprojection_create(&r->reprojection, p->rig, ptie_prepare_mask(r->preparation),
                                    r->shape.width_px, r->shape.height_px, ptie_pool_threads(r->engine->pool));
}

static ptie_status prepare_planes(const run *r, const slot *s, const desk *d) {
    const float *images[PTIE_ROLES];
    for (int32_t i = 0; i < r->recorded.images; i++) images[i] = s->image[i];
    return ptie_prepare_run(r->preparation, images, d->plane, d->scratch);
}

/* Mean of all planes, and of each. */
static double brightness(const run *r, const desk *d, double mean[PTIE_ROLES]) {
    double sum = 0;
    for (int32_t k = 0; k < r->shape.planes; k++) sum += mean[k] = ptie_run_mean(d->plane[k], r->pixels);
    return sum / r->shape.planes;
}

/* Of the first and the last frame as the solver gets them. */
static ptie_status hash_planes(run *r, uint64_t *hash) {
    double mean[PTIE_ROLES];
    *hash = PTIE_HASH_BEGIN;
    for (int end = 0; end < 2; end++) {
        PTIE_TRY(ptie_source_read(r->source, recorded_frame(r, end ? r->frames - 1 : 0), r->slots[0].image));
        PTIE_TRY(prepare_planes(r, &r->slots[0], &r->desks[0]));
        if (end == 0) r->first_brightness = brightness(r, &r->desks[0], mean);
        for (int32_t k = 0; k < r->shape.planes; k++)
            *hash = ptie_hash(*hash, r->desks[0].plane[k], r->pixels * sizeof(float));
    }
    return PTIE_OK;
}

static ptie_status open_result(run *r) {
    const ptie_run_params *p = r->params;
    const ptie_nexus_axes axes = {.frames = (uint64_t)r->frames,
                                  .width_px = r->shape.width_px,
                                  .height_px = r->shape.height_px,
                                  .first_frame = p->frames.first,
                                  .frame_step = p->frames.step,
                                  .frame_rate_hz = p->rig->frame_rate_hz > 0 ? p->rig->frame_rate_hz
                                                                             : r->recorded.frame_rate_hz,
                                  .pixel_m = r->shape.pixel_m,
                                  .in_place = true};
    uint64_t hash;
    ptie_text settings = {0};
    PTIE_TRY(hash_planes(r, &hash));
    ptie_status status = ptie_run_settings(&settings, p, r->frames, hash);
    if (status == PTIE_OK) status = ptie_result_open(&r->result, p, &axes, settings.data);
    ptie_text_free(&settings);
    return status;
}

static bool regions_given(const ptie_run_params *p) {
    const ptie_rect none = {0};
    return memcmp(&p->jet, &none, sizeof none) != 0 || memcmp(&p->background, &none, sizeof none) != 0;
}

static ptie_status label_what_is_given(run *r) {
    r->labelled = r->has_regions = regions_given(r->params);
    if (!r->labelled) return PTIE_OK;
    return ptie_metrics_label_rects(r->labels, r->shape.width_px, r->shape.height_px, r->params->jet,
                                    r->params->background);
}

/* Where the phase is made of light that every plane saw, and none that came from elsewhere. */
static ptie_status write_trusted(run *r) {
    const uint8_t *seen = ptie_prepare_seen(r->preparation);
    uint8_t *trusted;
    PTIE_TRY(ptie_alloc_status(&trusted, r->pixels, 1, "run"));
    ptie_frame_trusted(r->plan, trusted);
    for (size_t i = 0; seen && i < r->pixels; i++) trusted[i] &= seen[i];
    const ptie_status status = ptie_result_write(r->result, PTIE_RESULT_TRUSTED, trusted);
    ptie_free(trusted);
    return status;
}

static ptie_status begin(run *r) {
    PTIE_TRY(check_outputs(r->params));
    PTIE_TRY(open_inputs(r));
    PTIE_TRY(make_plans(r));
    PTIE_TRY(allocate(r));
    PTIE_TRY(label_what_is_given(r)); /* before the work: they may lie outside the frame */
    PTIE_TRY(open_result(r));
    PTIE_TRY(write_trusted(r));
    PTIE_TRY(ptie_table_open(&r->table, r->params));
    return r->labelled ? ptie_result_write(r->result, PTIE_RESULT_REGIONS, r->labels) : PTIE_OK;
}

/* --- frame by frame ---------------------------------------------------------------------------------- */

static ptie_status read_truth(run *r, int64_t frame, slot *s) {
    return r->truth ? ptie_io_read(r->truth, recorded_frame(r, frame), s->truth_raw) : PTIE_OK;
}

static ptie_status read_frame(void *context, int64_t frame, size_t i) {
    run *r = context;
    PTIE_TRY(read_truth(r, frame, &r->slots[i]));
    return ptie_source_read(r->source, recorded_frame(r, frame), r->slots[i].image);
}

static void bin_truth(const run *r, slot *s) {
    if (!r->truth) return;
    const ptie_recording_info *info = ptie_io_info(r->truth);
    ptie_bin(s->truth, s->truth_raw, info->width_px, info->height_px, r->params->rig->binning);
}

/* What the planes say of the maps, while they are at hand. */
static ptie_status compare_with_planes(const run *r, slot *s, const desk *d, int32_t worker) {
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
static void inspect_planes(const run *r, slot *s, const desk *d) {
    double *number = s->row + PTIE_ROW_OF_FRAME, mean[PTIE_ROLES];
    const double all = brightness(r, d, mean), limit = r->params->rig->saturation_counts;
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

static ptie_status measure_maps(const run *r, slot *s) {
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
    run *r = context;
    slot *s = &r->slots[i];
    const desk *d = &r->desks[worker];
    const float *planes[PTIE_ROLES];
    for (int k = 0; k < PTIE_ROW; k++) s->row[k] = (double)NAN;
    PTIE_TRY(prepare_planes(r, s, d));
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
static ptie_status take_row(run *r, int64_t frame, const double *row) {
    const int64_t tenth = r->frames / 10;
    const double background = row[PTIE_ROW_OF_FRAME + PTIE_BACKGROUND_RAD];
    for (int k = 0; k < PTIE_ROW; k++) ptie_running_add(&r->running[k], row[k]);
    if (frame < tenth) ptie_running_add(&r->early, background);
    if (frame >= r->frames - tenth) ptie_running_add(&r->late, background);
    return ptie_table_append(&r->table, recorded_frame(r, frame), row);
}

static void take_maps(run *r, const slot *s) {
    ptie_average_add(&r->phase_average, s->phase);
    if (s->denoised) ptie_average_add(&r->denoised_average, s->denoised);
}

static ptie_status write_row(void *context, int64_t frame, size_t i) {
    run *r = context;
    PTIE_TRY(ptie_result_write_row(r->result, frame, r->slots[i].row));
    PTIE_TRY(take_row(r, frame, r->slots[i].row));
    return ptie_result_finish(r->result, frame + 1);
}

static ptie_status write_frame(void *context, int64_t frame, size_t i) {
    run *r = context;
    slot *s = &r->slots[i];
    PTIE_TRY(ptie_result_write_maps(r->result, frame, s->phase, s->denoised));
    take_maps(r, s);
    return r->labelled ? write_row(r, frame, i) : ptie_result_write_row(r->result, frame, s->row);
}

static ptie_status stream(run *r, int64_t first, int64_t end, ptie_progress progress) {
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
    run *r = context;
    slot *s = &r->slots[i];
    PTIE_TRY(read_truth(r, frame, s));
    PTIE_TRY(ptie_result_read_row(r->result, frame, s->row));
    return ptie_result_read_maps(r->result, frame, s->phase, s->denoised);
}

static ptie_status measure_frame(void *context, int64_t frame, size_t i, int32_t worker) {
    (void)frame, (void)worker;
    run *r = context;
    bin_truth(r, &r->slots[i]);
    return measure_maps(r, &r->slots[i]);
}

/* From the mean of the best map.  Maps without flow have no regions, which is no reason to give up the maps. */
static ptie_status propose_regions(run *r) {
    float *mean = r->slots[0].phase; /* free between two streams */
    ptie_average_mean(r->params->model ? &r->denoised_average : &r->phase_average, mean);
    const ptie_status status = ptie_metrics_propose(r->labels, mean, r->shape.width_px, r->shape.height_px);
    r->has_regions = status == PTIE_OK;
    r->labelled = true;
    if (status == PTIE_ENUMERIC) memset(r->labels, PTIE_NOWHERE, r->pixels);
    if (status != PTIE_OK && status != PTIE_ENUMERIC) return status;
    return ptie_result_write(r->result, PTIE_RESULT_REGIONS, r->labels);
}

static ptie_status run_sample(run *r, ptie_progress progress) {
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

/* --- the whole --------------------------------------------------------------------------------------- */

/* Takes in what an interrupted run finished. */
static ptie_status catch_up(run *r) {
    slot *s = &r->slots[0];
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

static ptie_status run_frames(run *r, ptie_progress progress) {
    if (ptie_result_finished(r->result) > 0)
        PTIE_TRY(catch_up(r));
    else if (!r->labelled)
        PTIE_TRY(run_sample(r, progress));
    const int64_t done = ptie_result_finished(r->result);
    PTIE_TRY(ptie_progress_report(progress, (uint64_t)done, (uint64_t)r->frames, NULL));
    return stream(r, done, r->frames, progress);
}

static ptie_status write_average(run *r, const ptie_average *average, ptie_result_field mean, ptie_result_field rms) {
    float *map = r->slots[0].phase;
    ptie_average_mean(average, map);
    PTIE_TRY(ptie_result_write(r->result, mean, map));
    ptie_average_rms(average, map);
    return ptie_result_write(r->result, rms, map);
}

static ptie_run_row row_of(const run *r, int map) {
    const ptie_running *of = r->running + map * PTIE_RUN_METRICS;
    return (ptie_run_row){.mgm = ptie_running_stat(of + PTIE_MGM),
                          .sbr = ptie_running_stat(of + PTIE_SBR),
                          .bns = ptie_running_stat(of + PTIE_BNS),
                          .cnr = ptie_running_stat(of + PTIE_CNR),
                          .rmse_rad = ptie_running_stat(of + PTIE_RMSE_RAD),
                          .correlation = ptie_running_stat(of + PTIE_CORRELATION),
                          .signal_kept = ptie_running_stat(of + PTIE_SIGNAL_KEPT),
                          .residual = ptie_running_stat(of + PTIE_RESIDUAL)};
}

static void summarise(const run *r, ptie_run_summary *summary) {
    *summary = (ptie_run_summary){
        .frames = r->frames,
        .resumed = r->resumed,
        .width_px = r->shape.width_px,
        .height_px = r->shape.height_px,
        .pixel_m = r->shape.pixel_m,
        .phase = row_of(r, PTIE_OF_PHASE),
        .denoised = row_of(r, PTIE_OF_DENOISED),
        .truth = row_of(r, PTIE_OF_TRUTH),
        .noise_rad = ptie_running_stat(&r->running[PTIE_ROW_OF_FRAME + PTIE_NOISE_RAD]),
        .has_regions = r->has_regions,
    };
    ptie_run_warn(summary, r->source, r->params->rig, r->running + PTIE_ROW_OF_FRAME, &r->early, &r->late);
}

static ptie_status finish(run *r, ptie_run_summary *summary) {
    char lines[PTIE_RUN_MOST_WARNINGS][PTIE_H5_LINE_BYTES] = {{0}};
    PTIE_TRY(write_average(r, &r->phase_average, PTIE_RESULT_PHASE_MEAN, PTIE_RESULT_PHASE_RMS));
    if (r->params->model)
        PTIE_TRY(write_average(r, &r->denoised_average, PTIE_RESULT_DENOISED_MEAN, PTIE_RESULT_DENOISED_RMS));
    summarise(r, summary);
    for (int32_t i = 0; i < summary->warnings; i++) memcpy(lines[i], summary->warning[i], sizeof lines[i]);
    PTIE_TRY(ptie_result_write(r->result, PTIE_RESULT_WARNINGS, lines));
    ptie_result *result = r->result;
    r->result = NULL;
    PTIE_TRY(ptie_result_complete(result));
    return ptie_table_complete(&r->table);
}

static void release(run *r) {
    const bool keep = r->result && ptie_result_finished(r->result) > 0;
    ptie_table_abandon(&r->table, keep);
    ptie_result_abandon(r->result);
    ptie_free(r->slots);
    ptie_free(r->desks);
    ptie_free(r->memory);
    ptie_free(r->labels);
    ptie_average_free(&r->phase_average);
    ptie_average_free(&r->denoised_average);
    ptie_frame_plan_free(r->plan);
    ptie_reprojection_free(r->reprojection);
    ptie_io_close(r->truth);
    ptie_prepare_free(r->preparation);
    ptie_source_close(r->source);
}

const char *ptie_run_name(const ptie_run_params *params) {
    return params->recording ? params->recording : params->plane[PTIE_PLUS];
}

ptie_status ptie_run_pipeline(const ptie_engine *engine, const ptie_run_params *params,
                              ptie_run_summary *summary, ptie_progress progress) {
    const double start = ptie_now_s();
    run r = {.engine = engine, .params = params};
    *summary = (ptie_run_summary){0};
    ptie_status status = begin(&r);
    if (status == PTIE_OK) status = run_frames(&r, progress);
    if (status == PTIE_OK) status = finish(&r, summary);
    if (status != PTIE_OK && r.result) summary->frames = ptie_result_finished(r.result);
    summary->seconds = ptie_now_s() - start;
    release(&r);
    return status;
}
