/* SPDX-License-Identifier: BSD-3-Clause */
/* The planes of a recording as the solver sees them, or as they are after any step before, so that
 * each step can be looked at.  docs/math.md (P1)-(P9).
 */
#ifndef PTIE_PREPARE_H
#define PTIE_PREPARE_H

#include <ptie/context.h>
#include <ptie/recording.h>
#include <ptie/rig.h>

/* The steps from sensor image to planes, in their order. */
typedef enum ptie_step {
    PTIE_STEP_DARK,         /* sensor images without their dark level */
    PTIE_STEP_SPLIT,        /* channels of the sensor image, on one grid */
    PTIE_STEP_MIX,          /* planes as sums of channels */
    PTIE_STEP_FLAT,         /* divided by their no-flow reference */
    PTIE_STEP_GAIN,         /* times the rig's gains, then scaled to equal means */
    PTIE_STEP_REGISTRATION, /* on the grid of I+ */
    PTIE_STEP_MASK          /* filled where they are opaque, binned: what the solver takes */
} ptie_step;

typedef struct ptie_prepare_params {
    uint32_t struct_size;  /* set by ptie_prepare_params_init */
    const ptie_rig *rig;   /* required */
    const char *recording; /* as in ptie_run_params */
    const char *plane[PTIE_ROLES];
    const char *reference, *dark, *mask;
    ptie_step until;         /* last step, default PTIE_STEP_MASK */
    const char *output;      /* .h5; required */
    const char *provenance;  /* command line to keep in the file, or NULL */
    ptie_frame_range frames; /* frames to take; default 0, 0, 1 */
    bool overwrite;
} ptie_prepare_params;

PTIE_API void ptie_prepare_params_init(ptie_prepare_params *params);

/* Takes the frames through the steps and writes
     /entry/data/NAME  [T, H, W] float32, one per image, channel or plane, in the recording's unit
   whole or not at all.  The bytes do not depend on the number of threads.  Errors: those of
   ptie_run. */
PTIE_API PTIE_NODISCARD ptie_status ptie_prepare_planes(ptie_ctx *ctx,
                                                        const ptie_prepare_params *params,
                                                        ptie_progress progress);

#endif
