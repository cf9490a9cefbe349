/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/random.h"

#include <math.h>
#include <string.h>

#include "base/clones.h"
#include "base/elementary.h"

#define TWO_PI 6.283185307179586476925

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
    random
        ->counter[0]++; /* 2^32 blocks per stream: 64 GiB of numbers, never reached by one sample */
    random->used = 0;
}

uint32_t ptie_random_u32(ptie_random *random) {
    if (random->used == 4) next_block(random);
    return random->block[random->used++];
}

/* Fills 4 numbers of 4 bytes per block of the generator, from counter[0] on. */
typedef void fill_blocks(void *out, size_t blocks, const uint32_t key[2],
                         const uint32_t counter[4]);

static void fill(ptie_random *random, void *out, size_t count, fill_blocks *fill_some) {
    const size_t blocks = count / 4, rest = count % 4;
    fill_some(out, blocks, random->key, random->counter);
    random->counter[0] += (uint32_t)blocks;
    if (rest) {
        uint32_t last[4];
        fill_some(last, 1, random->key, random->counter);
        random->counter[0]++;
        memcpy((uint32_t *)out + 4 * blocks, last, rest * sizeof *last);
    }
    random->used = 4;
}

PTIE_CLONES static void fill_words(void *out, size_t blocks, const uint32_t key[2],
                                   const uint32_t counter[4]) {
    uint32_t *word = out;
    for (size_t i = 0; i < blocks; i++) {
        const uint32_t own[4] = {counter[0] + (uint32_t)i, counter[1], counter[2], counter[3]};
        ptie_philox(word + 4 * i, own, key);
    }
}

void ptie_random_words(ptie_random *random, uint32_t *out, size_t count) {
    fill(random, out, count, fill_words);
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
PTIE_INLINE void box_muller(float out[2], uint32_t a, uint32_t b) {
    const float u = (float)(int32_t)((a >> 8) + 1) * 0x1p-24f; /* (0, 1] */
    const float radius = sqrtf(-2.0f * ptie_logf(u));
    float sine, cosine;
    ptie_turnf((float)(int32_t)(b >> 8) * 0x1p-24f, &sine, &cosine);
    out[0] = radius * cosine;
    out[1] = radius * sine;
}

/* Four normals per block of the generator. */
PTIE_CLONES static void fill_normals(void *out, size_t blocks, const uint32_t key[2],
                                     const uint32_t counter[4]) {
    float *normal = out;
    for (size_t i = 0; i < blocks; i++) {
        const uint32_t own[4] = {counter[0] + (uint32_t)i, counter[1], counter[2], counter[3]};
        uint32_t word[4];
        ptie_philox(word, own, key);
        box_muller(normal + 4 * i, word[0], word[1]);
        box_muller(normal + 4 * i + 2, word[2], word[3]);
    }
}

void ptie_random_normals(ptie_random *random, float *out, size_t count) {
    fill(random, out, count, fill_normals);
}
