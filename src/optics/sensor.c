/* SPDX-License-Identifier: BSD-3-Clause */
/* From electrons to counts: shot noise, read noise, converter.  docs/math.md (C6), (C7). */
#include <math.h>

#include "base/clones.h"
#include "base/elementary.h"
#include "base/random.h"
#include "optics/camera.h"

/* From here on the expansion in z is used: mean and variance are exact, the third moment to 1/54. */
#define FEW_ELECTRONS 16.0f

/* The smallest k whose distribution function reaches that of the standard normal at z. */
static float few(double mean, double z) {
    const double rank = 0.5 * erfc(-z / sqrt(2));
    double term = exp(-mean), sum = term;
    int k = 0;
    while (sum < rank && k < 100) {
        term *= mean / ++k;
        sum += term;
    }
    return (float)k;
}

/* Cornish and Fisher's expansion to the first order in the skewness, its variance made exact. */
PTIE_INLINE float many(float mean, float z) {
    return mean + sqrtf(mean - 1.0f / 18) * z + (z * z - 1) * (1.0f / 6);
}

float ptie_poisson(float mean, float z) {
    return mean < FEW_ELECTRONS ? few((double)mean, (double)z) : many(mean, z);
}

/* normal: two per pixel, for shot and read noise. */
PTIE_CLONES static void add_many(float *image, const float *normal, size_t count) {
    for (size_t i = 0; i < count; i++) image[i] = many(image[i], normal[2 * i]);
}

/* Blocks with dark pixels take the slow way. */
static void add_shot_noise(float *image, const float *normal, size_t count) {
    bool dark = false;
    for (size_t i = 0; i < count; i++) dark |= image[i] < FEW_ELECTRONS;
    if (!dark) add_many(image, normal, count);
    else
        for (size_t i = 0; i < count; i++) image[i] = ptie_poisson(image[i], normal[2 * i]);
}

PTIE_CLONES static void convert(const ptie_noise_source *source, float *image, const float *normal, const float *black,
                                size_t count) {
    for (size_t i = 0; i < count; i++) {
        const float electrons = image[i] + source->read_noise * normal[2 * i + 1];
        const float counts = ptie_floorf(electrons * source->counts_per_electron + black[i] + 0.5f);
        image[i] = ptie_minf(ptie_maxf(counts, 0), source->last_count);
    }
}

void ptie_sensor_digitise(const ptie_noise_source *source, float *image, const float *black, size_t count) {
    enum { BLOCK = 256 };
    float normal[2 * BLOCK];
    ptie_random random;
    ptie_random_init(&random, source->seed, PTIE_STREAM_SENSOR, source->sample);
    for (size_t first = 0; first < count; first += BLOCK) {
        const size_t n = count - first < BLOCK ? count - first : BLOCK;
        ptie_random_normals(&random, normal, 2 * n);
        add_shot_noise(image + first, normal, n);
        convert(source, image + first, normal, black + first, n);
    }
}
