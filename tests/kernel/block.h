/* SPDX-License-Identifier: BSD-3-Clause */
/* Maps in memory that is watched: odd strides, unaligned rows, everything outside the interior must
 * stay as it was, and before and behind lie pages that nobody may touch.
 */
#ifndef PTIE_TESTS_KERNEL_BLOCK_H
#define PTIE_TESTS_KERNEL_BLOCK_H

#include "support/support.h"

#include <math.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/random.h"
#include "kernel/kernel.h"

/* Bytes of `floats` and of the page before and the page behind them. */
static inline size_t guarded_bytes(size_t floats) {
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    return (floats * sizeof(float) + page - 1) / page * page + 2 * page;
}

/* Floats between two pages without access; they touch the one behind or, `low`, the one before. */
static inline float *guarded_make(size_t floats, bool low) {
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), bytes = guarded_bytes(floats);
    char *all = mmap(NULL, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    assert_true(all != MAP_FAILED);
    assert_int_equal(mprotect(all + page, bytes - 2 * page, PROT_READ | PROT_WRITE), 0);
    return (float *)(void *)(low ? all + page : all + bytes - page - floats * sizeof(float));
}

static inline void guarded_free(float *memory, size_t floats) {
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    char *first = (char *)((uintptr_t)memory / page * page);
    assert_int_equal(munmap(first - page, guarded_bytes(floats)), 0);
}

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
    b.memory = guarded_make(b.floats, ptie_random_integer(random, 0, 1) == 0);
    b.map.data = b.memory + lead;
    block_fill(&b, random);
    return b;
}

static inline block block_copy(const block *b) {
    block copy = *b;
    copy.memory = guarded_make(b->floats, (uintptr_t)b->memory % 64 == 0);
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
    guarded_free(b->memory, b->floats);
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
    block_free(b);
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

typedef struct block_sizes {
    int32_t in_channels, out_channels, height, width;
} block_sizes;

/* Case `at` of widest + count^2: all widths with channels and heights that go round, then all pairs
   of channel counts. */
static inline block_sizes block_case(int32_t at, int32_t widest, const int32_t *channels,
                                     int32_t count) {
    static const int32_t widths[] = {5, 16, 37, 47, 64}; /* tails and whole vectors */
    const int32_t width = at + 1, pair = at - widest;
    if (at < widest)
        return (block_sizes){channels[width % (count - 1)], channels[width / 3 % count],
                             1 + width % 4, width};
    return (block_sizes){channels[pair % count], channels[pair / count], 1 + pair % 3,
                         widths[pair % 5]};
}

/* Rounding of n operations in single precision: gamma_n = n u / (1 - n u). */
static inline double gamma_n(double n) {
    const double u = 0x1p-24;
    return n * u / (1 - n * u);
}

#endif
