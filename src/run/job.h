/* SPDX-License-Identifier: BSD-3-Clause */
/* A run while it lasts: what it reads, the plans it computes with, the frames on their way, what it writes. */
#ifndef PTIE_RUN_JOB_H
#define PTIE_RUN_JOB_H

#include "io/recording.h"
#include "rig/prepare.h"
#include "run/average.h"
#include "run/measure.h"
#include "run/reprojection.h"
#include "run/result.h"
#include "run/run.h"
#include "run/table.h"
#include "run/worker.h"

/* Frames that regions are proposed from.  A fixed number: what is proposed must not depend on how far a run came
   before it was interrupted. */
enum { SAMPLE = 32 };

/* One frame on its way. */
typedef struct ptie_slot {
    float *image[PTIE_ROLES];     /* as recorded */
    float *truth_raw, *truth;     /* as recorded; binned.  NULL without truth */
    float *phase, *denoised;      /* denoised: NULL without a model */
    double row[PTIE_ROW];
} ptie_slot;

/* What a worker has of its own. */
typedef struct ptie_desk {
    float *plane[PTIE_ROLES];
    void *scratch; /* for the preparation */
} ptie_desk;

typedef struct ptie_job {
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

    ptie_slot *slots;
    ptie_desk *desks;
    size_t slot_count;
    unsigned char *memory; /* of all slots and desks */

    uint8_t *labels;  /* (H, W) */
    bool has_regions; /* labels has both of them */
    bool labelled;    /* it is decided */
    double first_brightness;
    ptie_average phase_average, denoised_average;
    ptie_running running[PTIE_ROW];
    ptie_running early, late; /* background of the first and the last tenth */
} ptie_job;

/* Recording frame that is frame i of the run. */
static inline int64_t ptie_job_frame(const ptie_job *r, int64_t i) {
    return r->params->frames.first + i * r->params->frames.step;
}

/* Before the first frame: opens what is read, makes the plans, opens what is written.  job->engine and job->params
   are set. */
ptie_status ptie_job_begin(ptie_job *r);
/* Also after a failure: what is finished of the result is kept, to be resumed. */
void ptie_job_release(ptie_job *r);

/* Takes all frames, or those that an interrupted run did not finish, through the stages. */
ptie_status ptie_job_frames(ptie_job *r, ptie_progress progress);

/* The planes of a frame that was read, as the solver gets them: into the desk. */
ptie_status ptie_job_planes(const ptie_job *r, const ptie_slot *s, const ptie_desk *d);
/* Mean of all planes on the desk, and of each. */
double ptie_job_brightness(const ptie_job *r, const ptie_desk *d, double mean[PTIE_ROLES]);

#endif
