/* SPDX-License-Identifier: BSD-3-Clause */
/* 3x3 convolution by minimal filtering F(4,3) down the columns, docs/math.md (N9). */
#include "kernel/scalar/scalar.h"

enum { ROWS = PTIE_WINOGRAD_ROWS, PARTS = PTIE_WINOGRAD_PARTS };

/* B' of (N9) and the pixel's six rows; rows below the lower neighbour stand for outputs that are
   not stored. */
static void transform_column(float parts[PARTS], const ptie_map *in, int32_t c, int32_t y,
                             int32_t x) {
    static const float matrix[PARTS][PARTS] = {{4, 0, -5, 0, 1, 0},  {0, -4, -4, 1, 1, 0},
                                               {0, 4, -4, -1, 1, 0}, {0, -2, -1, 2, 1, 0},
                                               {0, 2, -1, -2, 1, 0}, {0, 4, 0, -5, 0, 1}};
    for (int part = 0; part < PARTS; part++) {
        parts[part] = 0;
        for (int r = 0; r < PARTS; r++) {
            const int32_t row = y - 1 + r < in->height ? y - 1 + r : in->height;
            parts[part] += matrix[part][r] * row_of(in, c, row)[x];
        }
    }
}

/* The six parts of output channel o at rows y .. y + 3 of column x. */
static void multiply_parts(float sums[PARTS], const ptie_map *in, const float *weights, int32_t o,
                           int32_t y, int32_t x) {
    const ptrdiff_t part_floats = (ptrdiff_t)in->channels * 3 * PTIE_CONV_BLOCK;
    const float *block = weights + o / PTIE_CONV_BLOCK * PARTS * part_floats + o % PTIE_CONV_BLOCK;
    for (int part = 0; part < PARTS; part++) sums[part] = 0;
    for (int32_t i = 0; i < in->channels; i++)
        for (int kx = 0; kx < 3; kx++) {
            float parts[PARTS];
            transform_column(parts, in, i, y, x + kx - 1);
            for (int part = 0; part < PARTS; part++)
                sums[part] +=
                    block[part * part_floats + (i * 3 + kx) * PTIE_CONV_BLOCK] * parts[part];
        }
}

void ptie_winograd3x3_scalar(const ptie_map *out, const ptie_map *in, const float *weights,
                             const float *bias, bool relu, double *moments, float *scratch,
                             const ptie_ahead *ahead) {
    static const float matrix[ROWS][PARTS] = {
        {1, 1, 1, 1, 1, 0}, {0, 1, -1, 2, -2, 0}, {0, 1, 1, 4, 4, 0}, {0, 1, -1, 8, -8, 1}};
    (void)scratch, (void)ahead;
    for (int32_t o = 0; o < out->channels; o++)
        for (int32_t y = 0; y < out->height; y += ROWS)
            for (int32_t x = 0; x < out->width; x++) {
                float sums[PARTS];
                multiply_parts(sums, in, weights, o, y, x);
                for (int r = 0; r < ROWS && y + r < out->height; r++) {
                    float value = bias ? bias[o] : 0;
                    for (int part = 0; part < PARTS; part++) value += matrix[r][part] * sums[part];
                    value = relu && !(value > 0) ? 0 : value;
                    row_of(out, o, y + r)[x] = value;
                    if (!moments) continue;
                    moments[2 * o] += (double)value;
                    moments[2 * o + 1] += (double)value * (double)value;
                }
            }
}
