/* SPDX-License-Identifier: BSD-3-Clause */
#include "kernel/half.h"

#include <math.h>
#include <string.h>

enum { BIAS = 127 - 15, SHIFT = 23 - 10 }; /* of the exponents; of the fractions */

ptie_half ptie_half_from(float value) {
    const float magnitude = fminf(fabsf(value), 65504);
    uint32_t bits;
    if (magnitude < 0x1p-14f) { /* subnormal: multiples of 2^-24 */
        bits = (uint32_t)lrintf(magnitude * 0x1p24f);
    } else {
        memcpy(&bits, &magnitude, sizeof bits);
        bits += (1u << (SHIFT - 1)) - 1 + (bits >> SHIFT & 1); /* ties to even */
        bits = (bits >> SHIFT) - (BIAS << 10);
    }
    return (ptie_half)(bits | (signbit(value) ? 0x8000u : 0));
}

float ptie_half_to(ptie_half value) {
    const uint32_t magnitude = value & 0x7fffu,
                   bits = (magnitude << SHIFT) + ((uint32_t)BIAS << 23);
    float result;
    memcpy(&result, &bits, sizeof result);
    if (magnitude < 0x400) result = (float)magnitude * 0x1p-24f;
    return value & 0x8000u ? -result : result;
}

/* A float of zeros follows the floats that hold pixels, so that whole floats can be moved. */
ptie_map ptie_half_map_make(int32_t channels, int32_t height, int32_t width) {
    ptie_map map = ptie_map_make(channels, height, (width + 1) / 2);
    map.width = width;
    return map;
}

void ptie_half_pairs(float *packed, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const ptie_half half = ptie_half_from(packed[i]), pair[2] = {half, half};
        memcpy(&packed[i], pair, sizeof pair);
    }
}

#ifdef PTIE_HALF_LEVEL
extern const ptie_half_kernels ptie_half_kernels_vector;
#endif

const ptie_half_kernels *ptie_half_kernels_of(ptie_cpu_level level) {
#ifdef PTIE_HALF_LEVEL
    if (level == PTIE_CPU_AVX512 && ptie_cpu_has_half()) return &ptie_half_kernels_vector;
#endif
    (void)level;
    return NULL;
}
