/* SPDX-License-Identifier: BSD-3-Clause */
#include "tie/derivative.h"

#include <assert.h>
#include <math.h>

#include "base/clones.h"
#include "base/image.h"

#define LEAST_STEP_M 1e-9

static ptie_status weigh_pair(ptie_tie_weights *weights, double plus_m, double minus_m) {
    if (plus_m - minus_m < LEAST_STEP_M)
        return PTIE_FAIL(
            PTIE_EINVAL,
            "solver: distances do not fit a pair of planes (expected defocus_minus_m < "
            "defocus_plus_m, found %g and %g)",
            minus_m, plus_m);
    weights->plus = 1 / (plus_m - minus_m);
    weights->minus = -weights->plus;
    return PTIE_OK;
}

/* Derivative at z = 0 of the parabola through the three planes (M4b). */
static ptie_status weigh_triple(ptie_tie_weights *weights, double plus_m, double minus_m) {
    if (plus_m < LEAST_STEP_M || minus_m > -LEAST_STEP_M)
        return PTIE_FAIL(
            PTIE_EINVAL,
            "solver: distances do not fit three planes (expected defocus_minus_m < 0 < "
            "defocus_plus_m, found %g and %g)",
            minus_m, plus_m);
    const double up = plus_m, down = -minus_m;
    weights->plus = down / (up * (up + down));
    weights->minus = -up / (down * (up + down));
    weights->zero = (up - down) / (up * down);
    return PTIE_OK;
}

static ptie_status weigh_reference(ptie_tie_weights *weights, double plus_m) {
    if (fabs(plus_m) < LEAST_STEP_M)
        return PTIE_FAIL(PTIE_EINVAL,
                         "solver: distance does not fit a defocused plane (expected defocus_plus_m "
                         "other than 0, found %g)",
                         plus_m);
    weights->plus = 1 / plus_m;
    weights->zero = -weights->plus;
    return PTIE_OK;
}

ptie_status ptie_tie_weigh(ptie_tie_weights *weights, ptie_planes planes,
                           const ptie_solver_params *params) {
    *weights = (ptie_tie_weights){0};
    switch (planes) {
    case PTIE_PLANES_PAIR:
        return weigh_pair(weights, params->defocus_plus_m, params->defocus_minus_m);
    case PTIE_PLANES_TRIPLE:
        return weigh_triple(weights, params->defocus_plus_m, params->defocus_minus_m);
    case PTIE_PLANES_REFERENCE: return weigh_reference(weights, params->defocus_plus_m);
    }
    return PTIE_FAIL(PTIE_EINVAL, "solver: unknown planes (expected 0..2, found %d)", (int)planes);
}

/* Mean of (I+ + I-) / 2. */
PTIE_CLONES static double mean_of_pair(const float *i_plus, const float *i_minus, size_t count) {
    enum { LANES = 16 };
    double lane[LANES] = {0}, sum = 0;
    size_t i = 0;
    for (; i + LANES <= count; i += LANES)
        for (int k = 0; k < LANES; k++) lane[k] += (double)i_plus[i + (size_t)k] + (double)i_minus[i + (size_t)k];
    for (; i < count; i++) sum += (double)i_plus[i] + (double)i_minus[i];
    for (int k = 0; k < LANES; k++) sum += lane[k];
    return sum / (2 * (double)count);
}

PTIE_CLONES static void scale_difference(float *difference, const float *a, const float *b,
                                         double scale, size_t count) {
    for (size_t i = 0; i < count; i++)
        difference[i] = (float)(scale * ((double)a[i] - (double)b[i]));
}

static ptie_status pair_derivative(float *derivative, const ptie_tie_weights *weights,
                                   const float *i_plus, const float *i_minus, size_t count) {
    const double mean = mean_of_pair(i_plus, i_minus, count);
    if (!(mean > 0))
        return PTIE_FAIL(PTIE_ENUMERIC,
                         "i_plus, i_minus: mean intensity is not positive (expected > 0, found %g)",
                         mean);
    scale_difference(derivative, i_plus, i_minus, weights->plus / mean, count);
    return PTIE_OK;
}

static ptie_status check_divisor(const float *i_zero, size_t width, size_t height) {
    for (size_t i = 0; i < width * height; i++)
        if (!(i_zero[i] > 0))
            return PTIE_FAIL(PTIE_ENUMERIC,
                             "i_zero: intensity to divide by is not positive (at x=%zu, y=%zu; "
                             "expected > 0, found %g)",
                             i % width, i / width, (double)i_zero[i]);
    return PTIE_OK;
}

/* With I0 measured, every pixel is divided by its own.  i_minus NULL: its weight is 0.  The weights
   sum to 0, so differences from I0 are weighed: what is common to the planes cancels exactly. */
PTIE_CLONES static void pixelwise_derivative(float *derivative, const ptie_tie_weights *weights,
                                 const float *i_plus, const float *i_zero, const float *i_minus,
                                 size_t count) {
    for (size_t i = 0; i < count; i++) {
        const double zero = (double)i_zero[i];
        double sum = weights->plus * ((double)i_plus[i] - zero);
        if (i_minus) sum += weights->minus * ((double)i_minus[i] - zero);
        derivative[i] = (float)(sum / zero);
    }
}

ptie_status ptie_tie_derivative(float *derivative, const ptie_solver_params *params,
                                const float *i_plus, const float *i_zero, const float *i_minus) {
    assert(i_plus && (i_zero || i_minus));
    const int32_t w = params->width_px, h = params->height_px;
    const ptie_planes planes = !i_zero    ? PTIE_PLANES_PAIR
                               : !i_minus ? PTIE_PLANES_REFERENCE
                                          : PTIE_PLANES_TRIPLE;
    ptie_tie_weights weights;
    PTIE_TRY(ptie_tie_weigh(&weights, planes, params));
    PTIE_TRY(ptie_image_finite(i_plus, w, h, "i_plus"));
    if (i_minus) PTIE_TRY(ptie_image_finite(i_minus, w, h, "i_minus"));
    if (!i_zero)
        return pair_derivative(derivative, &weights, i_plus, i_minus, (size_t)w * (size_t)h);
    PTIE_TRY(ptie_image_finite(i_zero, w, h, "i_zero"));
    PTIE_TRY(check_divisor(i_zero, (size_t)w, (size_t)h));
    pixelwise_derivative(derivative, &weights, i_plus, i_zero, i_minus, (size_t)w * (size_t)h);
    return PTIE_OK;
}
