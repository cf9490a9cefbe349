/* SPDX-License-Identifier: BSD-3-Clause */
/* The reader's side of a run: the sensor images of a frame, as the camera wrote them, from the
   files that the rig and the caller name. */
#ifndef PTIE_RIG_SOURCE_H
#define PTIE_RIG_SOURCE_H

#include <ptie/run.h>

#include "base/status.h"

typedef struct ptie_source ptie_source;

typedef struct ptie_source_shape {
    int32_t width_px, height_px; /* of an image */
    int32_t images;              /* per frame: one per plane (PTIE_LAYOUT_SEPARATE, in the order of
                                    ptie_rig_planes without the reference), else 1 */
    int64_t frames;
    double frame_rate_hz, white_level; /* what the recording says, 0: nothing */
    const char *path;                  /* of the first image; the source owns it */
} ptie_source_shape;

/* Opens all recordings of a run's planes and checks that they fit together.  Errors name both files
   and both sizes. */
ptie_status ptie_source_open(ptie_source **out, const ptie_run_params *params);
void ptie_source_close(ptie_source *source); /* NULL is fine */
ptie_source_shape ptie_source_get_shape(const ptie_source *source);

/* What is wrong with the file of an image that can be read all the same (cut short), or "". */
const char *ptie_source_warning(const ptie_source *source, int32_t image);
const char *ptie_source_path(const ptie_source *source, int32_t image);

/* images (out): shape.images maps of (height, width). */
ptie_status ptie_source_read(ptie_source *source, int64_t frame, float *const *images);

/* The frame that is sample i of `samples`, spread from the first frame to the last. */
int64_t ptie_source_sample(const ptie_source *source, int64_t i, int64_t samples);
/* mean (out): shape.images maps: the mean of all frames or, where there are more, of `most`
 * samples. */
ptie_status ptie_source_average(ptie_source *source, float *const *mean, int64_t most);

/* mean (out): as many maps as a frame like `like` has images: the mean over all frames of a still
   recording (dark, no flow) that was taken with the same rig.  A file without data sets serves all
   planes. */
ptie_status ptie_source_mean(float *const *mean, const ptie_source_shape *like, const ptie_rig *rig,
                             const char *path);

#endif
