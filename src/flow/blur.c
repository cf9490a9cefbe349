/* SPDX-License-Identifier: BSD-3-Clause */
#include "flow/blur.h"

#include <math.h>
#include <string.h>

#include "base/clones.h"
#include "base/memory.h"

/* Weights of offsets 0 .. radius; they and their mirror images sum to 1. */
static void fill_weights(float *weights, int32_t radius, double sigma) {
    double sum = -1;
    for (int32_t i = 0; i <= radius; i++) sum += 2 * exp(-0.5 * i * i / (sigma * sigma));
    for (int32_t i = 0; i <= radius; i++)
        weights[i] = (float)(exp(-0.5 * i * i / (sigma * sigma)) / sum);
}

/* Index into 0 .. count-1 of the line mirrored at both ends, edge points twice. */
static int32_t mirror(int32_t i, int32_t count) {
    int32_t period = 2 * count;
    i %= period;
    if (i < 0) i += period;
    return i < count ? i : period - 1 - i;
}

PTIE_CLONES static void blur_rows(float *map, int32_t width, int32_t height, const float *weights,
                      int32_t radius, float *line) {
    for (int32_t y = 0; y < height; y++) {
        float *row = map + (size_t)y * (size_t)width;
        for (int32_t i = 0; i < width + 2 * radius; i++) line[i] = row[mirror(i - radius, width)];
        for (int32_t x = 0; x < width; x++) row[x] = weights[0] * line[x + radius];
        for (int32_t k = 1; k <= radius; k++) {
            const float *before = line + radius - k, *after = line + radius + k;
            for (int32_t x = 0; x < width; x++) row[x] += weights[k] * (before[x] + after[x]);
        }
    }
}

PTIE_CLONES static void blur_columns(float *out, const float *in, int32_t width, int32_t height,
                         const float *weights, int32_t radius) {
    for (int32_t y = 0; y < height; y++) {
        float *row = out + (size_t)y * (size_t)width;
        const float *centre = in + (size_t)y * (size_t)width;
        for (int32_t x = 0; x < width; x++) row[x] = weights[0] * centre[x];
        for (int32_t k = 1; k <= radius; k++) {
            const float *before = in + (size_t)mirror(y - k, height) * (size_t)width;
            const float *after = in + (size_t)mirror(y + k, height) * (size_t)width;
            for (int32_t x = 0; x < width; x++) row[x] += weights[k] * (before[x] + after[x]);
        }
    }
}

ptie_status ptie_blur(float *map, int32_t width, int32_t height, double sigma_px) {
    if (sigma_px < 0.1) return PTIE_OK;
    int32_t radius = (int32_t)ceil(3.5 * sigma_px);
    size_t pixels = (size_t)width * (size_t)height;
    ptie_slicer slicer = {0};
    float *weights, *line, *copy;
    for (int pass = 0; pass < 2; pass++) {
        slicer.used = 0;
        weights = ptie_slice(&slicer, (size_t)radius + 1, sizeof *weights);
        line = ptie_slice(&slicer, (size_t)width + 2 * (size_t)radius, sizeof *line);
        copy = ptie_slice(&slicer, pixels, sizeof *copy);
        if (pass == 0)
            PTIE_TRY(ptie_alloc_status(&slicer.base, slicer.used, 1, "scratch of the blur"));
    }
    fill_weights(weights, radius, sigma_px);
    blur_rows(map, width, height, weights, radius, line);
    memcpy(copy, map, pixels * sizeof *copy);
    blur_columns(map, copy, width, height, weights, radius);
    ptie_free(slicer.base);
    return PTIE_OK;
}
