/* SPDX-License-Identifier: BSD-3-Clause */
/* Medians without sorting: the value of a rank is found bit by bit, from the highest, by counting
 * how many values lie below.  Exact, in place, and vectors count.  docs/math.md (P11). */
#include "prep/median.h"

#include <string.h>

#include "base/clones.h"
#include "prep/prep.h"

/* Integers in the order of the floats, and back. */
PTIE_INLINE int32_t key_of(float value) {
    int32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits ^ (bits >> 31 & INT32_MAX);
}

static float value_of(int32_t key) {
    const int32_t bits = key ^ (key >> 31 & INT32_MAX);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* The next trial: `key` with `bit` set, in the order of unsigned numbers that begins at INT32_MIN.
 */
PTIE_INLINE int32_t with_bit(int32_t key, int bit) {
    return (int32_t)((uint32_t)key ^ (uint32_t)1 << bit);
}

PTIE_CLONES static size_t count_below(const float *values, size_t count, int32_t key) {
    uint32_t below = 0;
    for (size_t i = 0; i < count; i++) below += key_of(values[i]) < key;
    return below;
}

PTIE_CLONES static int32_t next_above(const float *values, size_t count, int32_t key) {
    int32_t next = INT32_MAX;
    for (size_t i = 0; i < count; i++) {
        const int32_t k = key_of(values[i]);
        next = k > key && k < next ? k : next;
    }
    return next;
}

double ptie_median(const float *values, size_t count) {
    int32_t low = INT32_MIN;
    for (int bit = 31; bit >= 0; bit--) {
        const int32_t trial = with_bit(low, bit);
        if (count_below(values, count, trial) <= (count - 1) / 2) low = trial;
    }
    int32_t high = low;
    if (count % 2 == 0 && count_below(values, count, low + 1) <= count / 2)
        high = next_above(values, count, low);
    return ((double)value_of(low) + (double)value_of(high)) / 2;
}

enum { BLOCK = 64 }; /* pixels whose frames stay in the cache */

/* below (out): frames whose pixel lies below its key; n <= BLOCK pixels. */
PTIE_CLONES static void count_frames(int32_t *restrict below, const int32_t *restrict key,
                                     const float *restrict stack, int32_t frames, size_t stride,
                                     int32_t n) {
    for (int32_t i = 0; i < n; i++) below[i] = 0;
    for (int32_t t = 0; t < frames; t++) {
        const float *restrict row = stack + (size_t)t * stride;
        for (int32_t i = 0; i < n; i++) below[i] += key_of(row[i]) < key[i];
    }
}

/* key (in): of the lower of the two middle frames; (out): of the upper. */
PTIE_CLONES static void raise(int32_t *restrict key, const float *restrict stack, int32_t frames,
                              size_t stride, int32_t n) {
    int32_t upto[BLOCK] = {0}, next[BLOCK];
    for (int32_t i = 0; i < n; i++) next[i] = INT32_MAX;
    for (int32_t t = 0; t < frames; t++) {
        const float *restrict row = stack + (size_t)t * stride;
        for (int32_t i = 0; i < n; i++) {
            const int32_t k = key_of(row[i]);
            upto[i] += k <= key[i];
            next[i] = k > key[i] && k < next[i] ? k : next[i];
        }
    }
    for (int32_t i = 0; i < n; i++) key[i] = upto[i] > frames / 2 ? key[i] : next[i];
}

static void median_block(float *median, const float *stack, int32_t frames, size_t stride,
                         int32_t n) {
    int32_t low[BLOCK], high[BLOCK], below[BLOCK];
    for (int32_t i = 0; i < n; i++) low[i] = INT32_MIN;
    for (int bit = 31; bit >= 0; bit--) {
        for (int32_t i = 0; i < n; i++) high[i] = with_bit(low[i], bit);
        count_frames(below, high, stack, frames, stride, n);
        for (int32_t i = 0; i < n; i++) low[i] = below[i] <= (frames - 1) / 2 ? high[i] : low[i];
    }
    memcpy(high, low, sizeof high);
    if (frames % 2 == 0) raise(high, stack, frames, stride, n);
    for (int32_t i = 0; i < n; i++) median[i] = (value_of(low[i]) + value_of(high[i])) / 2;
}

void ptie_temporal_median(float *median, const float *stack, int32_t frames, size_t stride,
                          size_t pixels) {
    for (size_t i = 0; i < pixels; i += BLOCK)
        median_block(median + i, stack + i, frames, stride,
                     (int32_t)(pixels - i < BLOCK ? pixels - i : BLOCK));
}
