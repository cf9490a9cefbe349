/* SPDX-License-Identifier: BSD-3-Clause */
/* An image shifted, rotated and magnified. */
#ifndef PTIE_OPTICS_SIMILARITY_H
#define PTIE_OPTICS_SIMILARITY_H

#include "base/status.h"

/* A point at x of the input appears at centre + shift + magnification R(rotation) (x - centre); the centre is that of
   the frame, between the pixels (w - 1) / 2 and (h - 1) / 2. */
typedef struct ptie_placement {
    double shift_x_px, shift_y_px, magnification, rotation_rad;
} ptie_placement;

typedef struct ptie_similarity ptie_similarity;

ptie_status ptie_similarity_create(ptie_similarity **out, int32_t width_px, int32_t height_px,
                                   const ptie_placement *placement);
void ptie_similarity_free(ptie_similarity *similarity); /* NULL is fine */
/* out must not be in.  Edge pixels continue beyond the frame.  Error for a wave of a period of 4 px or more: 1e-3 of
   its amplitude, and 1/1024 px of place (tests/optics/camera.c). */
void ptie_similarity_run(const ptie_similarity *similarity, float *out, const float *in);

#endif
