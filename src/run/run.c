/* SPDX-License-Identifier: BSD-3-Clause */
/* recording -> planes -> phase -> denoised phase -> numbers, as a stream: frames are read ahead, computed on all
   threads, and written in order. */
#include "run/run.h"

#include <string.h>

#include "base/clock.h"
#include "run/job.h"
#include "run/warnings.h"

static ptie_status write_average(ptie_job *r, const ptie_average *average, ptie_result_field mean, ptie_result_field rms) {
    float *map = r->slots[0].phase;
    ptie_average_mean(average, map);
    PTIE_TRY(ptie_result_write(r->result, mean, map));
    ptie_average_rms(average, map);
    return ptie_result_write(r->result, rms, map);
}

static ptie_run_row row_of(const ptie_job *r, int map) {
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

static void summarise(const ptie_job *r, ptie_run_summary *summary) {
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

static ptie_status finish(ptie_job *r, ptie_run_summary *summary) {
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

const char *ptie_run_name(const ptie_run_params *params) {
    return params->recording ? params->recording : params->plane[PTIE_PLUS];
}

ptie_status ptie_run_pipeline(const ptie_engine *engine, const ptie_run_params *params,
                              ptie_run_summary *summary, ptie_progress progress) {
    const double start = ptie_now_s();
    ptie_job r = {.engine = engine, .params = params};
    *summary = (ptie_run_summary){0};
    ptie_status status = ptie_job_begin(&r);
    if (status == PTIE_OK) status = ptie_job_frames(&r, progress);
    if (status == PTIE_OK) status = finish(&r, summary);
    if (status != PTIE_OK && r.result) summary->frames = ptie_result_finished(r.result);
    summary->seconds = ptie_now_s() - start;
    ptie_job_release(&r);
    return status;
}
