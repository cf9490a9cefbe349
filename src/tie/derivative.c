/* SPDX-License-Identifier: BSD-3-Clause */
#include "tie/derivative.h"

#include <math.h>
#include <string.h>

#include "base/clones.h"
#include "base/image.h"
#include "base/text.h"

enum { BLOCK = 512 }; /* pixels of a pass whose sums stay in the cache */

/* Mean of all planes. */
PTIE_CLONES static double mean_of_planes(const float *const *planes, int32_t count, size_t pixels) {
    enum { LANES = 16 };
    double lane[LANES] = {0}, sum = 0;
    size_t i = 0;
    for (; i + LANES <= pixels; i += LANES) {
        double total[LANES];
        for (int k = 0; k < LANES; k++) total[k] = (double)planes[0][i + (size_t)k];
        for (int32_t p = 1; p < count; p++)
            for (int k = 0; k < LANES; k++) total[k] += (double)planes[p][i + (size_t)k];
        for (int k = 0; k < LANES; k++) lane[k] += total[k];
    }
    for (; i < pixels; i++) {
        double total = (double)planes[0][i];
        for (int32_t p = 1; p < count; p++) total += (double)planes[p][i];
        sum += total;
    }
    for (int k = 0; k < LANES; k++) sum += lane[k];
    return sum / ((double)count * (double)pixels);
}

static double mean_in_light(const float *const *planes, int32_t count, const uint8_t *mask, size_t pixels) {
    if (!mask) return mean_of_planes(planes, count, pixels);
    double sum = 0;
    size_t lit = 0;
    for (size_t i = 0; i < pixels; i++)
        if (mask[i]) {
            lit++;
            for (int32_t p = 0; p < count; p++) sum += (double)planes[p][i];
        }
    return sum / ((double)count * (double)lit);
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

/* sum (out): of weight / divisor times plane; the weights sum to 0, so differences from one plane are
   weighed: what is common to the planes cancels exactly. */
static void weigh_block(double *sum, const ptie_tie_weights *w, const float *const *planes, double divisor,
                        size_t start, size_t count) {
    memset(sum, 0, count * sizeof *sum);
    for (int32_t p = 0; p < w->count; p++)
        if (p != w->base)
            add_difference(sum, planes[p] + start, planes[w->base] + start, w->weight[p] / divisor, count);
}

/* pixelwise: divided by the base as well. */
static void weigh_planes(float *derivative, const ptie_tie_weights *w, const float *const *planes,
                         double divisor, bool pixelwise) {
    const size_t pixels = (size_t)w->width_px * (size_t)w->height_px;
    for (size_t start = 0; start < pixels; start += BLOCK) {
        const size_t count = pixels - start < BLOCK ? pixels - start : BLOCK;
        double sum[BLOCK];
        weigh_block(sum, w, planes, divisor, start, count);
        if (pixelwise)
            divide(derivative + start, sum, planes[w->base] + start, count);
        else
            narrow(derivative + start, sum, count);
    }
}

void ptie_tie_blank(float *image, const uint8_t *mask, size_t pixels) {
    for (size_t i = 0; mask && i < pixels; i++)
        if (!mask[i]) image[i] = 0;
}

static ptie_status check_divisor(const ptie_tie_weights *w, const float *base) {
    const size_t width = (size_t)w->width_px, pixels = width * (size_t)w->height_px;
    for (size_t i = 0; i < pixels; i++)
        if (!(base[i] > 0) && (!w->mask || w->mask[i]))
            return PTIE_FAIL(PTIE_ENUMERIC,
                             "plane %d (in focus or reference): intensity to divide by is not positive "
                             "(at x=%zu, y=%zu; expected > 0, found %g)",
                             w->base, i % width, i / width, (double)base[i]);
    return PTIE_OK;
}

static ptie_status check_finite(const ptie_tie_weights *w, const float *const *planes) {
    for (int32_t p = 0; p < w->count; p++) {
        char name[64];
        ptie_print(name, sizeof name, "plane %d (z = %g m)", p, w->z_m[p]);
        PTIE_TRY(ptie_image_finite(planes[p], w->width_px, w->height_px, name));
    }
    return PTIE_OK;
}

static ptie_status check_light(double light, const char *what) {
    if (light > 0) return PTIE_OK;
    return PTIE_FAIL(PTIE_ENUMERIC, "planes: %s intensity is not positive (expected > 0, found %g)", what,
                     light);
}

ptie_status ptie_tie_derivative(float *derivative, const ptie_tie_weights *w, const float *const *planes) {
    const size_t pixels = (size_t)w->width_px * (size_t)w->height_px;
    PTIE_TRY(check_finite(w, planes));
    if (w->pixelwise) {
        PTIE_TRY(check_divisor(w, planes[w->base]));
        weigh_planes(derivative, w, planes, 1, true);
    } else {
        const double mean = mean_in_light(planes, w->count, w->mask, pixels);
        PTIE_TRY(check_light(mean, "mean"));
        weigh_planes(derivative, w, planes, mean, false);
    }
    ptie_tie_blank(derivative, w->mask, pixels);
    return PTIE_OK;
}

/* The plane in focus, or the mean of all. */
static void set_light(float *light, const ptie_tie_weights *w, const float *const *planes, size_t pixels) {
    for (size_t i = 0; i < pixels; i++) {
        double sum = (double)planes[w->base][i];
        for (int32_t p = 0; p < w->count && !w->pixelwise; p++)
            if (p != w->base) sum += (double)planes[p][i];
        light[i] = (float)fmax(0, w->pixelwise ? sum : sum / w->count);
    }
    ptie_tie_blank(light, w->mask, pixels);
}

ptie_status ptie_tie_slope(float *slope, float *light, const ptie_tie_weights *w,
                           const float *const *planes) {
    const size_t pixels = (size_t)w->width_px * (size_t)w->height_px;
    PTIE_TRY(check_finite(w, planes));
    set_light(light, w, planes, pixels);
    const double brightest = (double)ptie_image_extent(light, pixels).high;
    PTIE_TRY(check_light(brightest, "largest"));
    weigh_planes(slope, w, planes, brightest, false);
    for (size_t i = 0; i < pixels; i++) light[i] = (float)((double)light[i] / brightest);
    return PTIE_OK;
}
