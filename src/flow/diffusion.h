/* SPDX-License-Identifier: BSD-3-Clause */
/* Gas that diffuses as a Gaussian, seen along one of the directions it spreads in.  docs/math.md
 * (F13). */
#ifndef PTIE_FLOW_DIFFUSION_H
#define PTIE_FLOW_DIFFUSION_H

#include "flow/scene.h"

typedef struct ptie_diffusion {
    float start; /* standard deviation at the source, units */
    float lag;   /* way after which the variance has doubled, units */
} ptie_diffusion;

/* sigma / sigma0, sigma^2 = sigma0^2 (1 + way / lag): diffusion widens with the square root of time. */
PTIE_INLINE float ptie_diffusion_growth(const ptie_diffusion *diffusion, float way) {
    return sqrtf(1 + ptie_maxf(way, 0) / diffusion->lag);
}

/* Path through the middle, in units of pure gas times sqrt(2 pi).  A steady plume carries the same
   flux through every cross-section, sigma * depth; a puff keeps what it holds, sigma^2 * depth. */
PTIE_INLINE float ptie_plume_depth(const ptie_diffusion *diffusion, float growth) {
    return diffusion->start / growth;
}

PTIE_INLINE float ptie_puff_depth(const ptie_diffusion *diffusion, float growth) {
    return diffusion->start / (growth * growth);
}

#endif
