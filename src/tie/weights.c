/* SPDX-License-Identifier: BSD-3-Clause */
/* What each plane contributes to dI/dz at z = 0.  docs/math.md (M4)-(M4d). */
#include <math.h>

#include "tie/derivative.h"

#define LEAST_STEP_M 1e-9

static ptie_status check_distinct(const double *z, int32_t count) {
    for (int32_t i = 0; i < count; i++)
        for (int32_t j = 0; j < i; j++)
            if (fabs(z[i] - z[j]) < LEAST_STEP_M)
                return PTIE_FAIL(PTIE_EINVAL,
                                 "solver: planes %d and %d lie at the same place (expected z apart by at "
                                 "least %g m, found %g and %g)",
                                 j, i, LEAST_STEP_M, z[j], z[i]);
    return PTIE_OK;
}

/* The plane nearest to focus; of two as near, the one below. */
static int32_t nearest_to_focus(const double *z, int32_t count) {
    int32_t best = 0;
    for (int32_t i = 1; i < count; i++)
        if (fabs(z[i]) < fabs(z[best]) || (fabs(z[i]) == fabs(z[best]) && z[i] < z[best])) best = i;
    return best;
}

/* Slope at 0 of the parabola through three planes (M4b). */
static void weigh_parabola(double *weight, const double *z) {
    for (int i = 0; i < 3; i++) {
        const double a = z[(i + 1) % 3], b = z[(i + 2) % 3];
        weight[i] = -(a + b) / ((z[i] - a) * (z[i] - b));
    }
}

/* Slope at 0 of the least-squares polynomial (M4d): sum over j of p_j'(0) p_j(z_i) / |p_j|^2, with the
   monic polynomials that are orthogonal on the planes (Forsythe 1957), p_j+1 = (z - a_j) p_j - b_j p_j-1. */
static void weigh_least_squares(double *weight, const double *z, int32_t count, int32_t order) {
    double now[PTIE_MAX_PLANES], before[PTIE_MAX_PLANES] = {0};
    double value = 1, slope = 0, value_before = 0, slope_before = 0, norm_before = 1;
    for (int32_t i = 0; i < count; i++) now[i] = 1, weight[i] = 0;
    for (int32_t j = 0; j <= order; j++) {
        double norm = 0, moment = 0;
        for (int32_t i = 0; i < count; i++) norm += now[i] * now[i], moment += z[i] * now[i] * now[i];
        for (int32_t i = 0; i < count; i++) weight[i] += slope * now[i] / norm;
        const double a = moment / norm, b = j > 0 ? norm / norm_before : 0;
        for (int32_t i = 0; i < count; i++) {
            const double next = (z[i] - a) * now[i] - b * before[i];
            before[i] = now[i];
            now[i] = next;
        }
        const double next_slope = value - a * slope - b * slope_before;
        const double next_value = -a * value - b * value_before;
        value_before = value, slope_before = slope, norm_before = norm;
        value = next_value, slope = next_slope;
    }
}

double ptie_tie_noise_gain(const ptie_tie_weights *weights) {
    double squares = 0;
    for (int32_t i = 0; i < weights->count; i++) squares += weights->weight[i] * weights->weight[i];
    return squares;
}

ptie_status ptie_tie_weigh(ptie_tie_weights *weights, const ptie_solver_params *params) {
    const int32_t count = params->plane_count;
    const double *z = params->z_m;
    PTIE_TRY(check_distinct(z, count));
    *weights = (ptie_tie_weights){.width_px = params->width_px,
                                  .height_px = params->height_px,
                                  .mask = params->mask,
                                  .count = count,
                                  .base = nearest_to_focus(z, count)};
    weights->pixelwise = fabs(z[weights->base]) < LEAST_STEP_M;
    for (int32_t i = 0; i < count; i++) weights->z_m[i] = z[i];
    const int32_t order = params->polynomial_order > 0 ? params->polynomial_order : count > 2 ? 2 : 1;
    if (count == 2)
        weights->weight[0] = 1 / (z[0] - z[1]), weights->weight[1] = -weights->weight[0];
    else if (count == 3 && order == 2)
        weigh_parabola(weights->weight, z);
    else
        weigh_least_squares(weights->weight, z, count, order);
    return PTIE_OK;
}
