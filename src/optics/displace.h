/* SPDX-License-Identifier: BSD-3-Clause */
/* An image shifted, rotated and magnified. */
#ifndef PTIE_OPTICS_DISPLACE_H
#define PTIE_OPTICS_DISPLACE_H

#include <ptie/preprocess.h>

#include "base/status.h"

typedef struct ptie_displacer ptie_displacer;

/* The input is what the plane would show if it lay on the grid, the output what it shows where it lies. */
ptie_status ptie_displacer_create(ptie_displacer **out, int32_t width_px, int32_t height_px,
                                  const ptie_similarity *place);
void ptie_displacer_free(ptie_displacer *displacer); /* NULL is fine */
/* out must not be in.  Edge pixels continue beyond the frame.  Error for a wave of a period of 4 px or more: 1e-3 of
   its amplitude, and 1/1024 px of place (tests/optics/camera.c). */
void ptie_displacer_run(const ptie_displacer *displacer, float *out, const float *in);

#endif
