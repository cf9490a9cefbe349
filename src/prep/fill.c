/* SPDX-License-Identifier: BSD-3-Clause */
/* Masked pixels from what surrounds them, by pull and push (Gortler et al., SIGGRAPH 1996): means
 * of the light at ever coarser scales, then back, the coarser scale interpolated where a finer one
 * has no light.  docs/math.md (P9). */
#include "base/memory.h"
#include "prep/prep.h"

enum { LEVELS = 16 }; /* 2^15 pixels per side and below */

typedef struct level {
    int32_t width, height;
    float *value;
    uint8_t *known;
} level;

/* Levels above the image itself, in scratch; their number. */
static int carve(level *levels, ptie_slicer *slicer, int32_t width, int32_t height) {
    int count = 0;
    while (width > 1 || height > 1) {
        width = (width + 1) / 2, height = (height + 1) / 2;
        const size_t pixels = (size_t)width * (size_t)height;
        levels[count].width = width, levels[count].height = height;
        levels[count].value = ptie_slice(slicer, pixels, sizeof(float));
        levels[count].known = ptie_slice(slicer, pixels, 1);
        count++;
    }
    return count;
}

size_t ptie_fill_scratch_bytes(int32_t width_px, int32_t height_px) {
    ptie_slicer slicer = {0};
    level levels[LEVELS];
    carve(levels, &slicer, width_px, height_px);
    return slicer.used;
}

/* Each pixel of `coarse` is the mean of what is known of its four. */
static void pull(const level *coarse, const level *fine, const uint8_t *fine_known) {
    for (int32_t y = 0; y < coarse->height; y++)
        for (int32_t x = 0; x < coarse->width; x++) {
            float sum = 0;
            int known = 0;
            for (int32_t v = 2 * y; v < 2 * y + 2 && v < fine->height; v++)
                for (int32_t u = 2 * x; u < 2 * x + 2 && u < fine->width; u++) {
                    const ptrdiff_t i = (ptrdiff_t)v * fine->width + u;
                    if (fine_known[i]) sum += fine->value[i], known++;
                }
            const ptrdiff_t i = (ptrdiff_t)y * coarse->width + x;
            coarse->value[i] = known ? sum / (float)known : 0;
            coarse->known[i] = known > 0;
        }
}

static int32_t clamped(int32_t i, int32_t n) {
    return i < 0 ? 0 : i < n ? i : n - 1;
}

/* What is not known of `fine`: `coarse` interpolated linearly; its pixels' centres are a quarter
 * off. */
static void push(const level *fine, const uint8_t *fine_known, const level *coarse) {
    for (int32_t y = 0; y < fine->height; y++)
        for (int32_t x = 0; x < fine->width; x++) {
            const ptrdiff_t i = (ptrdiff_t)y * fine->width + x;
            if (fine_known[i]) continue;
            const int32_t u = x / 2, u2 = clamped(x % 2 ? u + 1 : u - 1, coarse->width);
            const int32_t v = y / 2, v2 = clamped(y % 2 ? v + 1 : v - 1, coarse->height);
            const float *near = coarse->value + (ptrdiff_t)v * coarse->width;
            const float *far = coarse->value + (ptrdiff_t)v2 * coarse->width;
            fine->value[i] = 0.75f * (0.75f * near[u] + 0.25f * near[u2]) +
                             0.25f * (0.75f * far[u] + 0.25f * far[u2]);
        }
}

void ptie_fill_masked(float *image, const uint8_t *mask, int32_t width_px, int32_t height_px,
                      void *scratch) {
    ptie_slicer slicer = {.base = scratch};
    level levels[LEVELS + 1] = {{width_px, height_px, image, NULL}};
    const int count = carve(levels + 1, &slicer, width_px, height_px);
    for (int i = 1; i <= count; i++)
        pull(&levels[i], &levels[i - 1], i > 1 ? levels[i - 1].known : mask);
    for (int i = count; i >= 1; i--)
        push(&levels[i - 1], i > 1 ? levels[i - 1].known : mask, &levels[i]);
}
