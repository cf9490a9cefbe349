/* SPDX-License-Identifier: BSD-3-Clause */
/* Counter-based random numbers: Philox 4x32-10 (Salmon et al., SC'11).  A stream is named by
   (seed, stream, sample), so sample i is the same whatever was drawn before it, on any thread. */
#ifndef PTIE_BASE_RANDOM_H
#define PTIE_BASE_RANDOM_H

#include <stddef.h>
#include <stdint.h>

#include "base/clones.h"

/* Streams in use.  One number per purpose, never reused. */
enum {
    PTIE_STREAM_FLOW = 1,    /* parameters of a flow */
    PTIE_STREAM_TEXTURE = 2, /* its random fields */
    PTIE_STREAM_CAMERA = 3,  /* noise level and gain of a sample */
    PTIE_STREAM_NOISE_PLUS = 4,
    PTIE_STREAM_NOISE_MINUS = 5,
    PTIE_STREAM_NOISE_ZERO = 6,
    PTIE_STREAM_WEIGHTS = 7, /* initial weights */
    PTIE_STREAM_ORDER = 8,   /* order of samples in an epoch */
    PTIE_STREAM_DROPOUT = 9,
    PTIE_STREAM_SENSOR = 10,  /* shot and read noise of a camera */
    PTIE_STREAM_FLICKER = 11, /* power of its light */
    PTIE_STREAM_PATTERN = 12  /* its fringes, dust and unequal pixels */
};

typedef struct ptie_random {
    uint32_t key[2], counter[4]; /* counter: block, stream, sample low, sample high */
    uint32_t block[4];
    uint32_t used; /* words of block already handed out; 4 = none left */
} ptie_random;

/* One block of the generator: out = Philox4x32-10(counter, key).  Inline, so that loops over counters
   vectorise. */
PTIE_INLINE void ptie_philox(uint32_t out[4], const uint32_t counter[4], const uint32_t key[2]) {
    uint32_t c0 = counter[0], c1 = counter[1], c2 = counter[2], c3 = counter[3];
    uint32_t k0 = key[0], k1 = key[1];
    for (int round = 0; round < 10; round++) {
        /* Multipliers and Weyl increments of Philox4x32 (Salmon et al. 2011, table 2). */
        const uint64_t p0 = UINT64_C(0xD2511F53) * c0;
        const uint64_t p1 = UINT64_C(0xCD9E8D57) * c2;
        c0 = (uint32_t)(p1 >> 32) ^ c1 ^ k0;
        c2 = (uint32_t)(p0 >> 32) ^ c3 ^ k1;
        c1 = (uint32_t)p1;
        c3 = (uint32_t)p0;
        k0 += 0x9E3779B9u;
        k1 += 0xBB67AE85u;
    }
    out[0] = c0, out[1] = c1, out[2] = c2, out[3] = c3;
}

void ptie_random_init(ptie_random *random, uint64_t seed, uint32_t stream, uint64_t sample);
uint32_t ptie_random_u32(ptie_random *random);
/* count words; what is left of a block at the end is not used. */
void ptie_random_words(ptie_random *random, uint32_t *out, size_t count);
/* Uniform in [low, high); 53 random bits. */
double ptie_random_uniform(ptie_random *random, double low, double high);
/* exp(uniform(log low, log high)); 0 < low <= high. */
double ptie_random_log_uniform(ptie_random *random, double low, double high);
/* Uniform integer in low..high, both included. */
int32_t ptie_random_integer(ptie_random *random, int32_t low, int32_t high);
/* Standard normal (Box-Muller). */
double ptie_random_normal(ptie_random *random);
/* count standard normal floats; the same values however the array is cut into calls of a multiple of 4. */
void ptie_random_normals(ptie_random *random, float *out, size_t count);

#endif
