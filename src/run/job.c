/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/job.h"

#include <string.h>

#include "base/memory.h"
#include "metrics/metrics.h"
#include "rig/cutoff.h"
#include "run/background.h"
#include "run/settings.h"
#include "run/stages.h"

static ptie_status choose_frames(ptie_job *r) {
    PTIE_TRY(ptie_io_choose(&r->frames, r->params->frames, r->recorded.frames, ptie_run_name(r->params)));
    r->sample = r->frames < SAMPLE ? r->frames : SAMPLE;
    return PTIE_OK;
}

static ptie_status open_truth(ptie_job *r) {
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

static void carve_slot(const ptie_job *r, ptie_slot *s, ptie_slicer *slicer) {
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

static void carve(ptie_job *r, ptie_slicer *slicer, int32_t workers) {
    for (size_t i = 0; i < r->slot_count; i++) carve_slot(r, &r->slots[i], slicer);
    for (int32_t w = 0; w < workers; w++) {
        for (int32_t k = 0; k < r->shape.planes; k++)
            r->desks[w].plane[k] = ptie_slice(slicer, r->pixels, sizeof(float));
        r->desks[w].scratch = ptie_slice(slicer, ptie_prepare_scratch_bytes(r->preparation), 1);
    }
}

static ptie_status allocate(ptie_job *r) {
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

static ptie_status open_inputs(ptie_job *r) {
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

static ptie_status choose_cutoff(ptie_job *r) {
    r->own_params = *r->params;
    r->own_rig = *r->params->rig;
    r->own_params.rig = &r->own_rig;
    PTIE_TRY(ptie_run_cutoff(&r->own_rig.cutoff_m, r->params->rig, r->source, r->preparation,
                             r->params->frames.first, r->frames, r->params->frames.step));
    r->params = &r->own_params;
    return PTIE_OK;
}

static ptie_status make_plans(ptie_job *r) {
    PTIE_TRY(choose_cutoff(r));
    const ptie_run_params *p = r->params;
    const ptie_denoiser_params denoising = {.fast = p->fast, .all_threads = r->frames == 1};
    PTIE_TRY(ptie_frame_plan_create(&r->plan, r->engine, p->rig, ptie_prepare_mask(r->preparation), p->model,
                                    r->shape.width_px, r->shape.height_px, &denoising));
    PTIE_TRY(ptie_background_measure(r->plan, r->source, r->preparation, p->rig));
    return ptie_reprojection_create(&r->reprojection, p->rig, ptie_prepare_mask(r->preparation),
                                    r->shape.width_px, r->shape.height_px, ptie_pool_threads(r->engine->pool));
}

ptie_status ptie_job_planes(const ptie_job *r, const ptie_slot *s, const ptie_desk *d) {
    const float *images[PTIE_ROLES];
    for (int32_t i = 0; i < r->recorded.images; i++) images[i] = s->image[i];
    return ptie_prepare_run(r->preparation, images, d->plane, d->scratch);
}

double ptie_job_brightness(const ptie_job *r, const ptie_desk *d, double mean[PTIE_ROLES]) {
    double sum = 0;
    for (int32_t k = 0; k < r->shape.planes; k++) sum += mean[k] = ptie_run_mean(d->plane[k], r->pixels);
    return sum / r->shape.planes;
}

/* Of the first and the last frame as the solver gets them. */
static ptie_status hash_planes(ptie_job *r, uint64_t *hash) {
    double mean[PTIE_ROLES];
    *hash = PTIE_HASH_BEGIN;
    for (int end = 0; end < 2; end++) {
        PTIE_TRY(ptie_source_read(r->source, ptie_job_frame(r, end ? r->frames - 1 : 0), r->slots[0].image));
        PTIE_TRY(ptie_job_planes(r, &r->slots[0], &r->desks[0]));
        if (end == 0) r->first_brightness = ptie_job_brightness(r, &r->desks[0], mean);
        for (int32_t k = 0; k < r->shape.planes; k++)
            *hash = ptie_hash(*hash, r->desks[0].plane[k], r->pixels * sizeof(float));
    }
    return PTIE_OK;
}

static ptie_status open_result(ptie_job *r) {
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

static ptie_status label_what_is_given(ptie_job *r) {
    r->labelled = r->has_regions = regions_given(r->params);
    if (!r->labelled) return PTIE_OK;
    return ptie_metrics_label_rects(r->labels, r->shape.width_px, r->shape.height_px, r->params->jet,
                                    r->params->background);
}

/* Where the phase is made of light that every plane saw, and none that came from elsewhere. */
static ptie_status write_trusted(ptie_job *r) {
    const uint8_t *seen = ptie_prepare_seen(r->preparation);
    uint8_t *trusted;
    PTIE_TRY(ptie_alloc_status(&trusted, r->pixels, 1, "run"));
    ptie_frame_trusted(r->plan, trusted);
    for (size_t i = 0; seen && i < r->pixels; i++) trusted[i] &= seen[i];
    const ptie_status status = ptie_result_write(r->result, PTIE_RESULT_TRUSTED, trusted);
    ptie_free(trusted);
    return status;
}

ptie_status ptie_job_begin(ptie_job *r) {
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

void ptie_job_release(ptie_job *r) {
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
