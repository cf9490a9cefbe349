/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/mask.h"

#include <string.h>

/* One line of ptie_mask_grow: a running count of `value` in the window around each point. */
static void grow_line(uint8_t *out, const uint8_t *in, int32_t n, ptrdiff_t stride, int32_t radius,
                      uint8_t value) {
    int32_t inside = 0;
    for (int32_t i = 0; i < n && i < radius; i++) inside += in[i * stride] == value;
    for (int32_t i = 0; i < n; i++) {
        if (i + radius < n) inside += in[(i + radius) * stride] == value;
        if (i - radius > 0) inside -= in[(i - radius - 1) * stride] == value;
        out[i * stride] = inside > 0 ? value : in[i * stride];
    }
}

void ptie_mask_grow(uint8_t *mask, int32_t width, int32_t height, int32_t radius, uint8_t value,
                    uint8_t *work) {
    for (int32_t y = 0; y < height; y++) {
        const ptrdiff_t row = (ptrdiff_t)y * width;
        grow_line(work + row, mask + row, width, 1, radius, value);
    }
    for (int32_t x = 0; x < width; x++) grow_line(mask + x, work + x, height, width, radius, value);
}

/* Writes to `size` of every pixel connected with `seed` how many there are; returns that number. */
static int32_t flood(int32_t *size, const uint8_t *mask, int32_t width, int32_t height,
                     int32_t seed, int32_t *queue) {
    const int32_t seen = -1;
    int32_t count = 0;
    size[seed] = seen;
    queue[count++] = seed;
    for (int32_t i = 0; i < count; i++) {
        const int32_t x = queue[i] % width, y = queue[i] / width;
        for (int32_t v = y > 0 ? y - 1 : 0; v <= y + 1 && v < height; v++)
            for (int32_t u = x > 0 ? x - 1 : 0; u <= x + 1 && u < width; u++) {
                const int32_t next = v * width + u;
                if (!mask[next] || size[next] == seen) continue;
                size[next] = seen;
                queue[count++] = next;
            }
    }
    for (int32_t i = 0; i < count; i++) size[queue[i]] = count;
    return count;
}

void ptie_mask_keep_large(uint8_t *mask, int32_t width, int32_t height, double share, int32_t *size,
                          int32_t *queue) {
    const size_t pixels = (size_t)width * (size_t)height;
    int32_t largest = 0;
    memset(size, 0, pixels * sizeof *size);
    for (size_t i = 0; i < pixels; i++) {
        if (!mask[i] || size[i] != 0) continue;
        const int32_t count = flood(size, mask, width, height, (int32_t)i, queue);
        if (count > largest) largest = count;
    }
    for (size_t i = 0; i < pixels; i++)
        if (size[i] < share * largest) mask[i] = 0;
}
