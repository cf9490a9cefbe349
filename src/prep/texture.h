/* SPDX-License-Identifier: BSD-3-Clause */
/* What two planes of the same light have in common, at one scale of a pyramid (P7). */
#ifndef PTIE_PREP_TEXTURE_H
#define PTIE_PREP_TEXTURE_H

#include "fft/fft.h"
#include "prep/resample.h"

/* A similarity transform as complex numbers: r -> shift + turn r. */
typedef struct ptie_motion {
    double shift_x, shift_y, turn_re, turn_im;
} ptie_motion;

typedef struct ptie_texture {
    int32_t scale, width, height; /* sensor pixels per pixel; size in pixels of this scale */
    float *fixed, *moving;        /* (height, width), band-passed, relative to their means */
    uint8_t *use;                 /* 1 where fixed counts */
    float *warped;                /* moving on the grid of fixed */
    uint8_t *inside;              /* 1 where warped was not mirrored */
} ptie_texture;

/* Bins and filters both planes.  mask: 1 = light, or NULL. */
ptie_status ptie_texture_create(ptie_texture *texture, const float *fixed, const float *moving,
                                const uint8_t *mask, int32_t width, int32_t height, int32_t scale);
void ptie_texture_free(ptie_texture *texture);

/* Brings moving onto the grid of fixed: fills warped, and inside if `choose`.  The shift is in
 * sensor pixels. */
ptie_status ptie_texture_warp(ptie_texture *texture, ptie_motion motion, bool choose);

/* The best of a grid of rotations (up to 8 degrees) and magnifications (up to 8 %), each with its
   best shift by cross-correlation. */
ptie_status ptie_texture_search(ptie_texture *texture, ptie_motion *best);

#endif
