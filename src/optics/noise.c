/* SPDX-License-Identifier: BSD-3-Clause */
/* Camera noise. */
#include <ptie/optics.h>

#include "base/random.h"

void ptie_add_gaussian_noise(float *image, size_t count, double sigma, uint64_t seed,
                             uint32_t stream, uint64_t index) {
    enum { BLOCK = 256 }; /* a multiple of 4: the same numbers as one long draw */
    float normal[BLOCK];
    ptie_random random;
    ptie_random_init(&random, seed, stream, index);
    for (size_t first = 0; first < count; first += BLOCK) {
        const size_t n = count - first < BLOCK ? count - first : BLOCK;
        ptie_random_normals(&random, normal, n);
        for (size_t i = 0; i < n; i++) image[first + i] += (float)sigma * normal[i];
    }
}
