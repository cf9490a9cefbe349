/* SPDX-License-Identifier: BSD-3-Clause */
/* Maps in memory that is watched: odd strides, unaligned rows, and everything outside the interior
 * must stay as it was.
 */
#ifndef PTIE_TESTS_KERNEL_BLOCK_H
#define PTIE_TESTS_KERNEL_BLOCK_H

#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include "base/random.h"
#include "kernel/kernel.h"

typedef struct block {
    float *memory;
    size_t floats;
    ptie_map map;
} block;

/* Uniform in [-1, 1], halo included. */
static inline void block_fill(block *b, ptie_random *random) {
    for (size_t i = 0; i < b->floats; i++) b->memory[i] = (float)ptie_random_uniform(random, -1, 1);
}

static inline block block_make(int32_t channels, int32_t height, int32_t width,
                               ptie_random *random) {
    block b = {.map = {.channels = channels, .height = height, .width = width}};
    b.map.row = width + 1 + ptie_random_integer(random, 0, 7);
    b.map.plane = (height + 2) * b.map.row + ptie_random_integer(random, 0, 9);
    size_t lead = (size_t)(b.map.row + 1 + ptie_random_integer(random, 0, 15));
    b.floats = lead + (size_t)(channels * b.map.plane) + PTIE_MAP_OVERREAD;
    b.memory = malloc(b.floats * sizeof *b.memory);
    b.map.data = b.memory + lead;
    block_fill(&b, random);
    return b;
}

static inline block block_copy(const block *b) {
    block copy = *b;
    copy.memory = malloc(b->floats * sizeof *b->memory);
    memcpy(copy.memory, b->memory, b->floats * sizeof *b->memory);
    copy.map.data = copy.memory + (b->map.data - b->memory);
    return copy;
}

/* The same with magnitudes: what a kernel makes of it bounds its rounding. */
static inline block block_absolute(const block *b) {
    block copy = block_copy(b);
    for (size_t i = 0; i < copy.floats; i++) copy.memory[i] = fabsf(copy.memory[i]);
    return copy;
}

static inline void block_free(block *b) {
    free(b->memory);
}

static inline float *block_pixel(const block *b, int32_t c, int32_t y, int32_t x) {
    return b->map.data + c * b->map.plane + y * b->map.row + x;
}

/* Zeroes everything but the interior. */
static inline void block_clear_halo(block *b) {
    block zero = block_copy(b);
    memset(zero.memory, 0, zero.floats * sizeof *zero.memory);
    for (int32_t c = 0; c < b->map.channels; c++)
        for (int32_t y = 0; y < b->map.height; y++)
            for (int32_t x = 0; x < b->map.width; x++)
                *block_pixel(&zero, c, y, x) = *block_pixel(b, c, y, x);
    free(b->memory);
    *b = zero;
}

/* <a, b> over the interior. */
static inline double block_dot(const block *a, const block *b) {
    double sum = 0;
    for (int32_t c = 0; c < a->map.channels; c++)
        for (int32_t y = 0; y < a->map.height; y++)
            for (int32_t x = 0; x < a->map.width; x++)
                sum += (double)*block_pixel(a, c, y, x) * (double)*block_pixel(b, c, y, x);
    return sum;
}

/* Rounding of n operations in single precision: gamma_n = n u / (1 - n u). */
static inline double gamma_n(double n) {
    const double u = 0x1p-24;
    return n * u / (1 - n * u);
}

#endif
