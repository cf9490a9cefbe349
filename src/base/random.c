/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/random.h"

#include <math.h>
#include <string.h>

#define TWO_PI 6.283185307179586476925

void ptie_philox(uint32_t out[4], const uint32_t counter[4], const uint32_t key[2]) {
    uint32_t c0 = counter[0], c1 = counter[1], c2 = counter[2], c3 = counter[3];
    uint32_t k0 = key[0], k1 = key[1];
    for (int round = 0; round < 10; round++) {
        /* Multipliers and Weyl increments of Philox4x32 (Salmon et al. 2011, table 2). */
        uint64_t p0 = UINT64_C(0xD2511F53) * c0;
        uint64_t p1 = UINT64_C(0xCD9E8D57) * c2;
        uint32_t n0 = (uint32_t)(p1 >> 32) ^ c1 ^ k0;
        uint32_t n2 = (uint32_t)(p0 >> 32) ^ c3 ^ k1;
        c1 = (uint32_t)p1;
        c3 = (uint32_t)p0;
        c0 = n0;
        c2 = n2;
        k0 += 0x9E3779B9u;
        k1 += 0xBB67AE85u;
    }
    out[0] = c0, out[1] = c1, out[2] = c2, out[3] = c3;
}

void ptie_random_init(ptie_random *random, uint64_t seed, uint32_t stream, uint64_t sample) {
    memset(random, 0, sizeof *random);
    random->key[0] = (uint32_t)seed;
    random->key[1] = (uint32_t)(seed >> 32);
    random->counter[1] = stream;
    random->counter[2] = (uint32_t)sample;
    random->counter[3] = (uint32_t)(sample >> 32);
    random->used = 4;
}

static void next_block(ptie_random *random) {
    ptie_philox(random->block, random->counter, random->key);
    random->counter[0]++; /* 2^32 blocks per stream: 64 GiB of numbers, never reached by one sample */
    random->used = 0;
}

uint32_t ptie_random_u32(ptie_random *random) {
    if (random->used == 4) next_block(random);
    return random->block[random->used++];
}

double ptie_random_uniform(ptie_random *random, double low, double high) {
    uint32_t a = ptie_random_u32(random) >> 5, b = ptie_random_u32(random) >> 6;
    double unit = (a * 67108864.0 + b) / 9007199254740992.0; /* (27 + 26 bits) / 2^53 */
    return low + (high - low) * unit;
}

double ptie_random_log_uniform(ptie_random *random, double low, double high) {
    return exp(ptie_random_uniform(random, log(low), log(high)));
}

int32_t ptie_random_integer(ptie_random *random, int32_t low, int32_t high) {
    uint64_t span = (uint64_t)((int64_t)high - low) + 1;
    return (int32_t)(low + (int64_t)(((uint64_t)ptie_random_u32(random) * span) >> 32));
}

double ptie_random_normal(ptie_random *random) {
    double u = 1.0 - ptie_random_uniform(random, 0.0, 1.0); /* (0, 1] */
    double v = ptie_random_uniform(random, 0.0, TWO_PI);
    return sqrt(-2.0 * log(u)) * cos(v);
}

/* Two uniforms to two normals.  24 bits each: the tail ends at sqrt(2 ln 2^24) = 5.8 sigma. */
static void box_muller(float out[2], uint32_t a, uint32_t b) {
    float u = ((float)(a >> 8) + 1.0f) * 0x1p-24f; /* (0, 1] */
    float angle = (float)(b >> 8) * (float)(TWO_PI * 0x1p-24);
    float radius = sqrtf(-2.0f * logf(u));
    out[0] = radius * cosf(angle);
    out[1] = radius * sinf(angle);
}

void ptie_random_normals(ptie_random *random, float *out, size_t count) {
    for (size_t i = 0; i < count; i += 4) {
        float normal[4];
        next_block(random);
        box_muller(normal, random->block[0], random->block[1]);
        box_muller(normal + 2, random->block[2], random->block[3]);
        size_t left = count - i < 4 ? count - i : 4;
        memcpy(out + i, normal, left * sizeof *out);
    }
    random->used = 4;
}
