/* SPDX-License-Identifier: BSD-3-Clause */
/* Counter-based random numbers: Philox 4x32-10 (Salmon et al., SC'11).  A stream is named by
   (seed, stream, sample), so sample i is the same whatever was drawn before it, on any thread. */
#ifndef PTIE_BASE_RANDOM_H
#define PTIE_BASE_RANDOM_H

#include <stddef.h>
#include <stdint.h>

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
    PTIE_STREAM_DROPOUT = 9
};

typedef struct ptie_random {
    uint32_t key[2], counter[4]; /* counter: block, stream, sample low, sample high */
    uint32_t block[4];
    uint32_t used; /* words of block already handed out; 4 = none left */
} ptie_random;

/* One block of the generator: out = Philox4x32-10(counter, key). */
void ptie_philox(uint32_t out[4], const uint32_t counter[4], const uint32_t key[2]);

void ptie_random_init(ptie_random *random, uint64_t seed, uint32_t stream, uint64_t sample);
uint32_t ptie_random_u32(ptie_random *random);
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
