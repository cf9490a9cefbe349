/* SPDX-License-Identifier: BSD-3-Clause */
/* Some frames of a recording, as planes before flat field and matching: what checks and
 * calibrations look at. */
#ifndef PTIE_RIG_SAMPLING_H
#define PTIE_RIG_SAMPLING_H

#include "rig/prepare_plan.h"

enum { PTIE_SAMPLES = 8 }; /* frames at most, spread over the recording */

typedef struct ptie_sampling {
    ptie_rig rig; /* as given, but means are not matched */
    ptie_source *source;
    ptie_source_shape shape;
    ptie_prepare *plan;
    int32_t frames;                               /* looked at */
    float *image[PTIE_ROLES], *frame[PTIE_ROLES]; /* mean, and one frame, as recorded */
    float *plane[PTIE_ROLES];                     /* of either, as asked */
    unsigned char *scratch;
} ptie_sampling;

/* Opens the recording and reads the mean of its samples.  flat: planes are divided by their
   reference, if the rig has one.  Free it also after a failure. */
ptie_status ptie_sampling_open(ptie_sampling *s, const ptie_rig *rig, const char *recording,
                               const char *const plane[PTIE_ROLES], bool flat);
void ptie_sampling_close(ptie_sampling *s);

/* Sample i, 0..frames-1, into s->frame. */
ptie_status ptie_sampling_read(ptie_sampling *s, int32_t i);
/* s->plane from images, after a step. */
ptie_status ptie_sampling_planes(ptie_sampling *s, float *const *images, ptie_step last);

#endif
