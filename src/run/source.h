/* SPDX-License-Identifier: BSD-3-Clause */
/* The frames of a run: the planes a rig names, binned, with the no-flow reference. */
#ifndef PTIE_RUN_SOURCE_H
#define PTIE_RUN_SOURCE_H

#include <ptie/run.h>

#include "base/status.h"

typedef struct ptie_source ptie_source;

/* Opens all recordings of a run and checks that they fit together.  Errors name both files and both
   sizes. */
ptie_status ptie_source_open(ptie_source **out, const ptie_run_params *params);
void ptie_source_close(ptie_source *source); /* NULL is fine */

/* Size after binning, frames in the recording, and what the recording says of its rate (0: nothing). */
typedef struct ptie_source_shape {
    int32_t width_px, height_px;
    int64_t frames;
    double frame_rate_hz;
    bool has_zero, has_minus; /* planes ptie_source_read fills; i_plus always */
} ptie_source_shape;

ptie_source_shape ptie_source_get_shape(const ptie_source *source);

/* Reads one frame's planes; i_zero gets the reference when the rig has one. */
ptie_status ptie_source_read(ptie_source *source, int64_t frame, float *i_plus, float *i_zero,
                             float *i_minus);

/* Averages binning x binning pixels; what does not fill a bin at the right and the bottom is left out. */
void ptie_bin(float *out, const float *image, int32_t width, int32_t height, int32_t binning);

#endif
