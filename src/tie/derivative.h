/* SPDX-License-Identifier: BSD-3-Clause */
/* dI/dz relative to the intensity, from the planes that there are.  docs/math.md (M4)-(M4d). */
#ifndef PTIE_TIE_DERIVATIVE_H
#define PTIE_TIE_DERIVATIVE_H

#include "tie/solver.h"

/* dI/dz = sum of weight[i] plane[i], in 1/m; the weights sum to 0. */
typedef struct ptie_tie_weights {
    int32_t width_px, height_px;
    const uint8_t *mask; /* (H, W), 0 = opaque; NULL = light everywhere */
    int32_t count;
    int32_t base;  /* plane that the others are compared with: the one nearest to z = 0 */
    bool pixelwise;/* base lies at z = 0: divide by it; else by the mean of all planes */
    double weight[PTIE_MAX_PLANES];
    double z_m[PTIE_MAX_PLANES];
} ptie_tie_weights;

/* PTIE_EINVAL if two planes coincide. */
ptie_status ptie_tie_weigh(ptie_tie_weights *weights, const ptie_solver_params *params);

/* Variance of dI/dz per variance of a plane. */
double ptie_tie_noise_gain(const ptie_tie_weights *weights);

/* derivative (out): (dI/dz) / I in 1/m, 0 in opaque pixels.  Errors: those of ptie_solver_run. */
ptie_status ptie_tie_derivative(float *derivative, const ptie_tie_weights *weights,
                                const float *const *planes);

/* Both relative to the brightest pixel: light (out), the plane in focus or the mean of all planes, negative
   values as 0; slope (out): dI/dz in 1/m.  light is 0 in opaque pixels. */
ptie_status ptie_tie_slope(float *slope, float *light, const ptie_tie_weights *weights,
                           const float *const *planes);

/* Sets opaque pixels to 0.  mask: NULL is fine. */
void ptie_tie_blank(float *image, const uint8_t *mask, size_t pixels);

#endif
