/* SPDX-License-Identifier: BSD-3-Clause */
/* recording -> phase -> denoised phase -> metrics, in blocks of frames.  The metrics need regions, the
   regions the mean of all frames: so maps are written first and measured in a second pass. */
#include "run/run.h"

#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "io/recording.h"
#include "metrics/metrics.h"
#include "run/output.h"
#include "run/prepare.h"
#include "run/reprojection.h"
#include "run/worker.h"

typedef struct run {
    const ptie_engine *engine;
    const ptie_run_params *params;
    ptie_source *source;
    ptie_prepare *preparation;
    ptie_recording *truth; /* or NULL */
    ptie_frame_plan *plan;
    ptie_reprojection *reprojection;
    ptie_h5 *output;
    ptie_output_file csv; /* open when the metrics go to a table too */
    ptie_source_shape recorded;
    ptie_prepare_shape shape;
    size_t pixels;
    int64_t frames; /* to do */
    int64_t block;  /* frames per block */

    float *image[PTIE_ROLES];             /* one frame as recorded */
    unsigned char *scratch;               /* of its preparation */
    float *plane[PTIE_ROLES];             /* (block, H, W), shape.planes of them */
    float *phase, *denoised;              /* (block, H, W); denoised may be NULL */
    float *true_phase, *true_raw;                  /* (block, H, W); one frame as recorded */
    double *mean;                                  /* (H, W): sum of the best map over frames */
    uint8_t *labels;                               /* (H, W) */
    bool has_regions;                              /* labels has both of them */
    double *phase_metrics, *denoised_metrics, *truth_metrics; /* (frames, PTIE_RUN_METRICS) */
    int64_t done; /* frames of the current block's first */
} run;

/* Recording frame that is frame i of the run. */
static int64_t recorded_frame(const run *r, int64_t i) {
    return r->params->first + i * r->params->step;
}

static ptie_status choose_frames(run *r) {
    const ptie_run_params *p = r->params;
    if (p->first >= r->recorded.frames)
        return PTIE_FAIL(PTIE_EINVAL, "%s: first frame out of range (expected 0..%lld, found %lld)", ptie_run_name(p),
                         (long long)r->recorded.frames - 1, (long long)p->first);
    int64_t available = (r->recorded.frames - p->first + p->step - 1) / p->step;
    if (p->count > available)
        return PTIE_FAIL(PTIE_EINVAL, "%s: too few frames (expected %lld from frame %lld in steps of %lld, "
                                      "found %lld)", ptie_run_name(p), (long long)p->count, (long long)p->first,
                         (long long)p->step, (long long)available);
    r->frames = p->count ? p->count : available;
    r->block = 4 * ptie_pool_threads(r->engine->pool);
    if (r->block > r->frames) r->block = r->frames;
    return PTIE_OK;
}

static ptie_status open_truth(run *r) {
    const char *path = r->params->truth;
    if (!path) return PTIE_OK;
    PTIE_TRY(ptie_io_open(&r->truth, path));
    const ptie_recording_info *info = ptie_io_info(r->truth);
    int32_t binning = r->params->rig->binning;
    if (info->width_px / binning != r->shape.width_px || info->height_px / binning != r->shape.height_px)
        return PTIE_FAIL(PTIE_ESIZE, "%s: truth does not fit the phase (expected %d x %d px, found %d x %d)",
                         path, r->shape.width_px * binning, r->shape.height_px * binning, info->width_px,
                         info->height_px);
    if (info->frames < r->recorded.frames)
        return PTIE_FAIL(PTIE_ESIZE, "%s: too few frames of truth (expected %lld, found %lld)", path,
                         (long long)r->recorded.frames, (long long)info->frames);
    return ptie_alloc_status(&r->true_raw, (size_t)info->width_px * (size_t)info->height_px, sizeof(float),
                             path);
}

static ptie_status allocate(run *r) {
    size_t block = (size_t)r->block * r->pixels, table = (size_t)r->frames * PTIE_RUN_METRICS;
    const size_t recorded = (size_t)r->recorded.width_px * (size_t)r->recorded.height_px;
    for (int32_t i = 0; i < r->recorded.images; i++)
        PTIE_TRY(ptie_alloc_status(&r->image[i], recorded, sizeof(float), "run"));
    for (int32_t i = 0; i < r->shape.planes; i++)
        PTIE_TRY(ptie_alloc_status(&r->plane[i], block, sizeof(float), "run"));
    PTIE_TRY(ptie_alloc_status(&r->scratch, ptie_prepare_scratch_bytes(r->preparation), 1, "run: scratch"));
    PTIE_TRY(ptie_alloc_status(&r->phase, block, sizeof(float), "run"));
    if (r->truth) {
        PTIE_TRY(ptie_alloc_status(&r->true_phase, block, sizeof(float), "run"));
        PTIE_TRY(ptie_alloc_status(&r->truth_metrics, table, sizeof(double), "run"));
    }
    if (r->params->model) {
        PTIE_TRY(ptie_alloc_status(&r->denoised, block, sizeof(float), "run"));
        PTIE_TRY(ptie_alloc_status(&r->denoised_metrics, table, sizeof(double), "run"));
    }
    PTIE_TRY(ptie_alloc_status(&r->phase_metrics, table, sizeof(double), "run"));
    PTIE_TRY(ptie_alloc_status(&r->mean, r->pixels, sizeof(double), "run"));
    return ptie_alloc_status(&r->labels, r->pixels, 1, "run");
}

static bool regions_given(const ptie_run_params *p) {
    const ptie_rect none = {0};
    return memcmp(&p->jet, &none, sizeof none) != 0 || memcmp(&p->background, &none, sizeof none) != 0;
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

static ptie_status prepare(run *r) {
    const ptie_run_params *p = r->params;
    PTIE_TRY(check_outputs(p));
    PTIE_TRY(ptie_source_open(&r->source, p));
    r->recorded = ptie_source_get_shape(r->source);
    PTIE_TRY(ptie_prepare_create(&r->preparation, r->source, p->rig));
    r->shape = ptie_prepare_get_shape(r->preparation);
    r->pixels = (size_t)r->shape.width_px * (size_t)r->shape.height_px;
    PTIE_TRY(choose_frames(r));
    PTIE_TRY(open_truth(r));
    const ptie_denoiser_params denoising = {.fast = p->fast, .all_threads = r->frames == 1};
    PTIE_TRY(ptie_frame_plan_create(&r->plan, r->engine, p->rig, p->model, r->shape.width_px,
                                    r->shape.height_px, &denoising));
    PTIE_TRY(ptie_reprojection_create(&r->reprojection, p->rig, r->shape.width_px, r->shape.height_px,
                                      ptie_pool_threads(r->engine->pool)));
    PTIE_TRY(allocate(r));
    r->has_regions = regions_given(p);
    if (r->has_regions) /* before the work: they may lie outside the frame */
        PTIE_TRY(ptie_metrics_label_rects(r->labels, r->shape.width_px, r->shape.height_px, p->jet,
                                          p->background));
    double rate_hz = p->rig->frame_rate_hz > 0 ? p->rig->frame_rate_hz : r->recorded.frame_rate_hz;
    if (p->metrics_csv) PTIE_TRY(ptie_output_open(&r->csv, p->metrics_csv, p->overwrite));
    return ptie_output_create(&r->output, p,
                              &(ptie_nexus_axes){.frames = (uint64_t)r->frames,
                                                 .width_px = r->shape.width_px,
                                                 .height_px = r->shape.height_px,
                                                 .first_frame = p->first,
                                                 .frame_step = p->step,
                                                 .frame_rate_hz = rate_hz,
                                                 .pixel_m = r->shape.pixel_m});
}

static float *frame_of(float *block, const run *r, size_t i) {
    return block ? block + i * r->pixels : NULL;
}

static void planes_of(const float *planes[PTIE_ROLES], const run *r, size_t i) {
    for (int32_t k = 0; k < r->shape.planes; k++) planes[k] = frame_of(r->plane[k], r, i);
}

/* What the planes say of the maps of frame i, while they are at hand. */
static ptie_status compare_with_planes(run *r, size_t i, int32_t worker) {
    const float *const blocks[] = {r->phase, r->denoised, r->true_phase};
    double *const metrics[] = {r->phase_metrics, r->denoised_metrics, r->truth_metrics}, residual[3];
    const float *maps[3], *planes[PTIE_ROLES];
    size_t count = 0;
    planes_of(planes, r, i);
    for (int k = 0; k < 3; k++)
        if (blocks[k]) maps[count++] = blocks[k] + i * r->pixels;
    PTIE_TRY(ptie_reprojection_measure(r->reprojection, worker, residual, maps, count, planes));
    count = 0;
    for (int k = 0; k < 3; k++)
        if (blocks[k]) metrics[k][((size_t)r->done + i) * PTIE_RUN_METRICS + PTIE_RESIDUAL] = residual[count++];
    return PTIE_OK;
}

static ptie_status solve_task(void *context, size_t i, int32_t worker) {
    run *r = context;
    const float *planes[PTIE_ROLES];
    planes_of(planes, r, i);
    PTIE_TRY(ptie_frame_solve(r->plan, worker, frame_of(r->phase, r, i), frame_of(r->denoised, r, i), planes));
    return compare_with_planes(r, i, worker);
}

/* Frame i of the block, as planes. */
static ptie_status read_planes(run *r, size_t i) {
    const float *images[PTIE_ROLES];
    float *planes[PTIE_ROLES];
    PTIE_TRY(ptie_source_read(r->source, recorded_frame(r, r->done + (int64_t)i), r->image));
    for (int32_t k = 0; k < r->recorded.images; k++) images[k] = r->image[k];
    for (int32_t k = 0; k < r->shape.planes; k++) planes[k] = frame_of(r->plane[k], r, i);
    return ptie_prepare_run(r->preparation, images, planes, r->scratch);
}

static ptie_status read_truth(run *r, int64_t first, size_t count) {
    if (!r->truth) return PTIE_OK;
    const ptie_recording_info *info = ptie_io_info(r->truth);
    for (size_t i = 0; i < count; i++) {
        PTIE_TRY(ptie_io_read(r->truth, recorded_frame(r, first + (int64_t)i), r->true_raw));
        ptie_bin(frame_of(r->true_phase, r, i), r->true_raw, info->width_px, info->height_px,
                 r->params->rig->binning);
    }
    return PTIE_OK;
}

static void add_to_mean(run *r, size_t count) {
    const float *best = r->denoised ? r->denoised : r->phase;
    for (size_t n = 0; n < count; n++)
        for (size_t i = 0; i < r->pixels; i++) r->mean[i] += (double)best[n * r->pixels + i];
}

/* First pass: solve, denoise and write every frame. */
static ptie_status solve_frames(run *r, ptie_progress progress) {
    for (r->done = 0; r->done < r->frames; r->done += r->block) {
        const int64_t first = r->done;
        size_t count = (size_t)(r->frames - first < r->block ? r->frames - first : r->block);
        PTIE_TRY(read_truth(r, first, count));
        for (size_t i = 0; i < count; i++) PTIE_TRY(read_planes(r, i));
        PTIE_TRY(r->frames == 1 ? solve_task(r, 0, 0) /* takes the pool itself */
                                : ptie_pool_run(r->engine->pool, count, solve_task, r));
        PTIE_TRY(ptie_h5_write(r->output, PTIE_RUN_PHASE, PTIE_H5_F32, (uint64_t)first, count, r->phase));
        if (r->denoised)
            PTIE_TRY(ptie_h5_write(r->output, PTIE_RUN_DENOISED, PTIE_H5_F32, (uint64_t)first, count,
                                   r->denoised));
        add_to_mean(r, count);
        PTIE_TRY(ptie_progress_report(progress, (uint64_t)first + count, (uint64_t)r->frames, NULL));
    }
    return PTIE_OK;
}

/* Maps without flow have none, which is no reason to give up the maps. */
static ptie_status propose_regions(run *r) {
    float *mean = r->phase; /* the block is free now */
    for (size_t i = 0; i < r->pixels; i++) mean[i] = (float)(r->mean[i] / (double)r->frames);
    ptie_status status = ptie_metrics_propose(r->labels, mean, r->shape.width_px, r->shape.height_px);
    r->has_regions = status == PTIE_OK;
    return status == PTIE_ENUMERIC ? PTIE_OK : status;
}

static ptie_status measure_task(void *context, size_t i, int32_t worker) {
    (void)worker;
    run *r = context;
    size_t row = ((size_t)r->done + i) * PTIE_RUN_METRICS;
    const float *truth = frame_of(r->true_phase, r, i);
    const uint8_t *labels = r->has_regions ? r->labels : NULL;
    const int32_t width = r->shape.width_px, height = r->shape.height_px;
    PTIE_TRY(ptie_run_measure(r->phase_metrics + row, frame_of(r->phase, r, i), truth, labels, width, height));
    if (truth) PTIE_TRY(ptie_run_measure(r->truth_metrics + row, truth, NULL, labels, width, height));
    if (!r->denoised) return PTIE_OK;
    return ptie_run_measure(r->denoised_metrics + row, frame_of(r->denoised, r, i), truth, labels, width, height);
}

/* Second pass: the metrics of every frame. */
static ptie_status measure_frames(run *r) {
    if (!r->has_regions) PTIE_TRY(propose_regions(r));
    for (r->done = 0; r->done < r->frames; r->done += r->block) {
        size_t count = (size_t)(r->frames - r->done < r->block ? r->frames - r->done : r->block);
        uint64_t first = (uint64_t)r->done;
        PTIE_TRY(ptie_h5_read(r->output, PTIE_RUN_PHASE, PTIE_H5_F32, first, count, r->phase));
        if (r->denoised)
            PTIE_TRY(ptie_h5_read(r->output, PTIE_RUN_DENOISED, PTIE_H5_F32, first, count, r->denoised));
        PTIE_TRY(read_truth(r, r->done, count));
        PTIE_TRY(ptie_pool_run(r->engine->pool, count, measure_task, r));
    }
    if (r->has_regions)
        PTIE_TRY(ptie_output_regions(r->output, r->labels, r->shape.width_px, r->shape.height_px));
    PTIE_TRY(ptie_output_metrics(r->output, "phase", r->phase_metrics, r->frames));
    if (r->denoised)
        PTIE_TRY(ptie_output_metrics(r->output, "denoised", r->denoised_metrics, r->frames));
    if (r->truth) PTIE_TRY(ptie_output_metrics(r->output, "truth", r->truth_metrics, r->frames));
    return PTIE_OK;
}

/* values may be NULL: nothing was measured. */
static ptie_run_row row_of(const double *values, int64_t frames) {
    const ptie_stat none = {(double)NAN, (double)NAN};
    return values ? ptie_run_summarise(values, frames) : (ptie_run_row){none, none, none, none, none, none, none, none};
}

static ptie_run_summary summarise(const run *r) {
    return (ptie_run_summary){
        .frames = r->frames,
        .width_px = r->shape.width_px,
        .height_px = r->shape.height_px,
        .pixel_m = r->shape.pixel_m,
        .phase = row_of(r->phase_metrics, r->frames),
        .denoised = row_of(r->denoised_metrics, r->frames),
        .truth = row_of(r->truth_metrics, r->frames),
        .has_regions = r->has_regions,
    };
}

static void release(run *r) {
    void *const blocks[] = {r->scratch, r->phase, r->denoised, r->true_phase, r->true_raw, r->mean,
                            r->labels, r->phase_metrics, r->denoised_metrics, r->truth_metrics};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) ptie_free(blocks[i]);
    for (int i = 0; i < PTIE_ROLES; i++) {
        ptie_free(r->image[i]);
        ptie_free(r->plane[i]);
    }
    ptie_h5_discard(r->output);
    ptie_output_discard(&r->csv);
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
    double start = ptie_now_s();
    run r = {.engine = engine, .params = params};
    ptie_status status;
    PTIE_TRY_DONE(prepare(&r));
    PTIE_TRY_DONE(solve_frames(&r, progress));
    PTIE_TRY_DONE(measure_frames(&r));
    if (params->metrics_csv)
        PTIE_TRY_DONE(ptie_output_csv(&r.csv, params, r.phase_metrics, r.denoised_metrics, r.frames));
    ptie_h5 *output = r.output;
    r.output = NULL;
    PTIE_TRY_DONE(ptie_h5_close(output));
    if (params->metrics_csv) PTIE_TRY_DONE(ptie_output_commit(&r.csv));
    *summary = summarise(&r);
    summary->seconds = ptie_now_s() - start;
done:
    release(&r);
    return status;
}
