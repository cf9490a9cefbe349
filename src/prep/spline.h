/* SPDX-License-Identifier: BSD-3-Clause */
/* Cubic B-splines through the pixels of an image that is mirrored at its outer pixel edges (P6). */
#ifndef PTIE_PREP_SPLINE_H
#define PTIE_PREP_SPLINE_H

#include <stddef.h>
#include <stdint.h>

enum { PTIE_SPLINE_LANES = 16 }; /* rows that are filtered together */

/* Floats of scratch that the transform wants. */
size_t ptie_spline_scratch(int32_t width);

/* coefficient (out): (height + 2 margin, width + 2 margin), those of the mirrored image beyond the
   frame. margin <= min(width, height). */
void ptie_spline_transform(float *coefficient, const float *image, int32_t width, int32_t height,
                           int32_t margin, float *scratch);

/* out[i] = the spline at the fractions (x + i dx, y + i dy) of the cell whose upper left of 4 x 4
   coefficients is at[i]; the fractions stay within 0..1. */
void ptie_spline_run(float *out, const float *at, ptrdiff_t pitch, int32_t count, float x, float y,
                     float dx, float dy);

#endif
