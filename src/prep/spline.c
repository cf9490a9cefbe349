/* SPDX-License-Identifier: BSD-3-Clause */
/* The recursive filter of Unser, Aldroubi and Eden (IEEE Trans. Signal Process. 41, 821, 1993):
 * pole sqrt(3) - 2, forwards then backwards along each axis. */
#include "prep/spline.h"

#include <string.h>

#include "base/clones.h"

enum { LANES = PTIE_SPLINE_LANES };

static const float POLE = -0.267949192431122706f;
static const float GAIN = 6; /* (1 - pole)(1 - 1/pole), per axis */

/* Terms of the mirrored past that count: |pole|^14 < 1e-8. */
enum { HORIZON = 14 };

/* Index i >= 0 beyond an axis of n points, mirrored at its edges as often as needed. */
static int32_t mirrored(int32_t i, int32_t n) {
    i %= 2 * n;
    return i < n ? i : 2 * n - 1 - i;
}

size_t ptie_spline_scratch(int32_t width) {
    return (size_t)width * LANES;
}

/* Both filters along n steps of `count` neighbouring values each, `step` apart, in place. */
PTIE_CLONES static void filter(float *line, int32_t n, ptrdiff_t step, int32_t count) {
    const float last_gain = POLE / (POLE - 1);
    float power[HORIZON] = {POLE};
    for (int j = 1; j < HORIZON; j++) power[j] = power[j - 1] * POLE;
    for (int32_t i = 0; i < count; i++) { /* what came before, by symmetry */
        float past = 0;
        for (int j = HORIZON - 1; j >= 0; j--) past += power[j] * line[mirrored(j, n) * step + i];
        line[i] += past;
    }
    for (int32_t k = 1; k < n; k++) {
        float *restrict now = line + k * step;
        const float *restrict before = now - step;
        for (int32_t i = 0; i < count; i++) now[i] += POLE * before[i];
    }
    for (int32_t i = 0; i < count; i++) line[(n - 1) * step + i] *= last_gain;
    for (int32_t k = n - 2; k >= 0; k--) {
        float *restrict now = line + k * step;
        const float *restrict after = now + step;
        for (int32_t i = 0; i < count; i++) now[i] = POLE * (after[i] - now[i]);
    }
}

/* Up to LANES rows, filtered side by side: lanes (width, LANES) is the block transposed. */
PTIE_CLONES static void filter_rows(float *restrict out, ptrdiff_t pitch,
                                    const float *restrict image, int32_t width, int32_t rows,
                                    float *restrict lanes) {
    for (int32_t r = 0; r < rows; r++)
        for (int32_t x = 0; x < width; x++)
            lanes[x * LANES + r] = GAIN * GAIN * image[(ptrdiff_t)r * width + x];
    filter(lanes, width, LANES, LANES);
    for (int32_t r = 0; r < rows; r++)
        for (int32_t x = 0; x < width; x++) out[r * pitch + x] = lanes[x * LANES + r];
}

/* Coefficients of a mirrored image are mirrored. */
static void mirror_edges(float *coefficient, ptrdiff_t pitch, int32_t width, int32_t height,
                         int32_t margin) {
    for (int32_t y = 0; y < height; y++) {
        float *row = coefficient + (margin + y) * pitch + margin;
        for (int32_t x = 1; x <= margin; x++) {
            row[-x] = row[x - 1];
            row[width - 1 + x] = row[width - x];
        }
    }
    const size_t bytes = (size_t)pitch * sizeof *coefficient;
    float *top = coefficient + margin * pitch, *bottom = top + (height - 1) * pitch;
    for (int32_t y = 1; y <= margin; y++) {
        memcpy(top - y * pitch, top + (y - 1) * pitch, bytes);
        memcpy(bottom + y * pitch, bottom - (y - 1) * pitch, bytes);
    }
}

void ptie_spline_transform(float *coefficient, const float *image, int32_t width, int32_t height,
                           int32_t margin, float *scratch) {
    const ptrdiff_t pitch = width + 2 * margin;
    float *core = coefficient + margin * pitch + margin;
    for (int32_t y = 0; y < height; y += LANES) {
        const int32_t rows = height - y < LANES ? height - y : LANES;
        filter_rows(core + y * pitch, pitch, image + (ptrdiff_t)y * width, width, rows, scratch);
    }
    filter(core, height, pitch, width);
    mirror_edges(coefficient, pitch, width, height, margin);
}

/* Weights of the four coefficients around a point at fraction t between the middle two. */
typedef struct weights {
    float a, b, c, d;
} weights;

PTIE_INLINE weights weights_at(float t) {
    const float s = 1 - t, t2 = t * t, s2 = s * s;
    const float third = 2.0f / 3, sixth = 1.0f / 6;
    return (weights){sixth * s2 * s, third - 0.5f * t2 * (1 + s), third - 0.5f * s2 * (1 + t),
                     sixth * t2 * t};
}

PTIE_INLINE float row_at(const float *at, weights w) {
    return w.a * at[0] + w.b * at[1] + w.c * at[2] + w.d * at[3];
}

PTIE_CLONES void ptie_spline_run(float *restrict out, const float *restrict at, ptrdiff_t pitch,
                                 int32_t count, float x, float y, float dx, float dy) {
    for (int32_t i = 0; i < count; i++) {
        const weights wx = weights_at(x + (float)i * dx), wy = weights_at(y + (float)i * dy);
        out[i] = wy.a * row_at(at + i, wx) + wy.b * row_at(at + pitch + i, wx) +
                 wy.c * row_at(at + 2 * pitch + i, wx) + wy.d * row_at(at + 3 * pitch + i, wx);
    }
}
