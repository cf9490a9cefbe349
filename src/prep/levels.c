/* SPDX-License-Identifier: BSD-3-Clause */
/* Dark, mixing, flat field, gain.  docs/math.md (P1), (P3)-(P5). */
#include "base/clones.h"
#include "base/image.h"
#include "prep/prep.h"

PTIE_CLONES void ptie_subtract_dark(float *restrict image, const float *restrict dark,
                                    size_t pixels) {
    for (size_t i = 0; i < pixels; i++) image[i] -= dark[i];
}

PTIE_CLONES static void scale(float *out, const float *in, float weight, size_t count) {
    for (size_t i = 0; i < count; i++) out[i] = weight * in[i];
}

PTIE_CLONES static void add_scaled(float *restrict out, const float *restrict in, float weight,
                                   size_t count) {
    for (size_t i = 0; i < count; i++) out[i] += weight * in[i];
}

/* In blocks that stay in the cache, by way of a buffer: the plane may be a channel. */
void ptie_mix_channels(float *plane, const float *const *channel, const double *weight,
                       int32_t count, size_t pixels) {
    enum { BLOCK = 1024 };
    float sum[BLOCK];
    for (size_t first = 0; first < pixels; first += BLOCK) {
        const size_t n = pixels - first < BLOCK ? pixels - first : BLOCK;
        for (size_t i = 0; i < n; i++) sum[i] = 0;
        for (int32_t c = 0; c < count; c++)
            if (weight[c] != 0) add_scaled(sum, channel[c] + first, (float)weight[c], n);
        scale(plane + first, sum, 1, n);
    }
}

PTIE_CLONES void ptie_apply_gain(float *restrict image, const float *restrict gain, size_t pixels) {
    for (size_t i = 0; i < pixels; i++) image[i] *= gain[i];
}

void ptie_scale_image(float *image, double factor, size_t pixels) {
    scale(image, image, (float)factor, pixels);
}

/* Lanes of doubles: the order of the sum is fixed, and it vectorises.  mask may be NULL. */
PTIE_CLONES double ptie_masked_mean(const float *restrict image, const uint8_t *restrict mask,
                                    size_t pixels) {
    enum { LANES = 16 };
    double sums[LANES] = {0}, sum = 0;
    size_t count = 0, i = 0;
    for (; i + LANES <= pixels; i += LANES)
        for (size_t k = 0; k < LANES; k++)
            sums[k] += !mask || mask[i + k] ? (double)image[i + k] : 0;
    for (; i < pixels; i++) sum += !mask || mask[i] ? (double)image[i] : 0;
    for (i = 0; i < pixels; i++) count += !mask || mask[i];
    for (size_t k = 0; k < LANES; k++) sum += sums[k];
    return sum / (double)count;
}

ptie_status ptie_prep_flat_gain(float *gain, const float *reference, const uint8_t *mask,
                                int32_t width, int32_t height, double floor) {
    PTIE_TRY(ptie_image_finite(reference, width, height, "reference"));
    const size_t pixels = (size_t)width * (size_t)height;
    const double mean = ptie_masked_mean(reference, mask, pixels);
    if (!(mean > 0))
        return PTIE_FAIL(PTIE_ENUMERIC,
                         "reference: mean intensity is not positive (expected > 0, found %g)",
                         mean);
    const float lowest = (float)(floor * mean), level = (float)mean;
    for (size_t i = 0; i < pixels; i++)
        gain[i] = level / (reference[i] > lowest ? reference[i] : lowest);
    return PTIE_OK;
}
