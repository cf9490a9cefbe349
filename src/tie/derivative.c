/* SPDX-License-Identifier: BSD-3-Clause */
#include "tie/derivative.h"

#include <assert.h>

#include "base/clones.h"
#include "base/image.h"
#include "base/text.h"

enum { BLOCK = 512 }; /* pixels of a pass whose sums stay in the cache */

/* Mean of all planes. */
PTIE_CLONES static double mean_of_planes(const float *const *planes, int32_t count, size_t pixels) {
    enum { LANES = 16 };
    double lane[LANES] = {0}, sum = 0;
    size_t i = 0;
    for (; i + LANES <= pixels; i += LANES)
        for (int k = 0; k < LANES; k++) {
            double total = (double)planes[0][i + (size_t)k];
            for (int32_t p = 1; p < count; p++) total += (double)planes[p][i + (size_t)k];
            lane[k] += total;
        }
    for (; i < pixels; i++) {
        double total = (double)planes[0][i];
        for (int32_t p = 1; p < count; p++) total += (double)planes[p][i];
        sum += total;
    }
    for (int k = 0; k < LANES; k++) sum += lane[k];
    return sum / ((double)count * (double)pixels);
}

PTIE_CLONES static void add_difference(double *sum, const float *plane, const float *base, double weight,
                                       size_t count) {
    for (size_t i = 0; i < count; i++) sum[i] += weight * ((double)plane[i] - (double)base[i]);
}

PTIE_CLONES static void divide(float *out, const double *sum, const float *by, size_t count) {
    for (size_t i = 0; i < count; i++) out[i] = (float)(sum[i] / (double)by[i]);
}

PTIE_CLONES static void narrow(float *out, const double *sum, size_t count) {
    for (size_t i = 0; i < count; i++) out[i] = (float)sum[i];
}

/* The weights sum to 0, so differences from one plane are weighed: what is common to the planes cancels
   exactly.  divisor: of every weight. */
static void weigh_planes(float *derivative, const ptie_tie_weights *w, const float *const *planes,
                         double divisor, size_t pixels) {
    for (size_t start = 0; start < pixels; start += BLOCK) {
        const size_t count = pixels - start < BLOCK ? pixels - start : BLOCK;
        const float *base = planes[w->base] + start;
        double sum[BLOCK] = {0};
        for (int32_t p = 0; p < w->count; p++)
            if (p != w->base) add_difference(sum, planes[p] + start, base, w->weight[p] / divisor, count);
        if (w->pixelwise)
            divide(derivative + start, sum, base, count);
        else
            narrow(derivative + start, sum, count);
    }
}

static ptie_status check_divisor(const float *base, int32_t plane, size_t width, size_t height) {
    for (size_t i = 0; i < width * height; i++)
        if (!(base[i] > 0))
            return PTIE_FAIL(PTIE_ENUMERIC,
                             "plane %d (in focus or reference): intensity to divide by is not positive "
                             "(at x=%zu, y=%zu; expected > 0, found %g)",
                             plane, i % width, i / width, (double)base[i]);
    return PTIE_OK;
}

static ptie_status check_finite(const ptie_tie_weights *w, const float *const *planes, int32_t width,
                                int32_t height) {
    for (int32_t p = 0; p < w->count; p++) {
        char name[64];
        ptie_print(name, sizeof name, "plane %d (z = %g m)", p, w->z_m[p]);
        PTIE_TRY(ptie_image_finite(planes[p], width, height, name));
    }
    return PTIE_OK;
}

ptie_status ptie_tie_derivative(float *derivative, const ptie_tie_weights *weights,
                                const float *const *planes, int32_t width_px, int32_t height_px) {
    const size_t pixels = (size_t)width_px * (size_t)height_px;
    PTIE_TRY(check_finite(weights, planes, width_px, height_px));
    double divisor = 1;
    if (weights->pixelwise)
        PTIE_TRY(check_divisor(planes[weights->base], weights->base, (size_t)width_px, (size_t)height_px));
    else {
        divisor = mean_of_planes(planes, weights->count, pixels);
        if (!(divisor > 0))
            return PTIE_FAIL(PTIE_ENUMERIC,
                             "planes: mean intensity is not positive (expected > 0, found %g)", divisor);
    }
    weigh_planes(derivative, weights, planes, divisor, pixels);
    return PTIE_OK;
}
