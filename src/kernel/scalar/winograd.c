/* SPDX-License-Identifier: BSD-3-Clause */
/* 3x3 convolution by minimal filtering F(4,3) down the columns, docs/math.md (N9). */
#include "kernel/scalar/scalar.h"

enum { ROWS = PTIE_WINOGRAD_ROWS, PARTS = PTIE_WINOGRAD_PARTS, TILE = 512, STEP = TILE + 2 };

static int32_t smaller(int32_t a, int32_t b) {
    return a < b ? a : b;
}

/* to += factor * from */
static void add_row(float *to, const float *from, float factor, int32_t width) {
    for (int32_t x = 0; x < width; x++) to[x] += factor * from[x];
}

static void clear_row(float *to, int32_t width) {
    for (int32_t x = 0; x < width; x++) to[x] = 0;
}

/* B' of (N9) and the six rows from y - 1 on, beginning at column x - 1, to (C, PARTS, STEP).  Rows
   below the lower neighbour stand for outputs that are not stored. */
static void transform_input(float *to, const ptie_map *in, int32_t y, int32_t x, int32_t width) {
    static const float matrix[PARTS][PARTS] = {{4, 0, -5, 0, 1, 0},  {0, -4, -4, 1, 1, 0},
                                               {0, 4, -4, -1, 1, 0}, {0, -2, -1, 2, 1, 0},
                                               {0, 2, -1, -2, 1, 0}, {0, 4, 0, -5, 0, 1}};
    for (int32_t c = 0; c < in->channels; c++)
        for (int part = 0; part < PARTS; part++, to += STEP) {
            clear_row(to, width + 2);
            for (int r = 0; r < PARTS; r++)
                add_row(to, row_of(in, c, smaller(y - 1 + r, in->height)) + x - 1, matrix[part][r],
                        width + 2);
        }
}

/* The six parts of one output channel, to (PARTS, STEP). */
static void multiply_parts(float *to, const float *input, const float *weights, int32_t o,
                           int32_t in_channels, int32_t width) {
    const float *w = weights +
                     (ptrdiff_t)(o / PTIE_CONV_BLOCK) * PARTS * in_channels * 3 * PTIE_CONV_BLOCK +
                     o % PTIE_CONV_BLOCK;
    for (int part = 0; part < PARTS; part++, to += STEP) {
        clear_row(to, width);
        for (int32_t i = 0; i < in_channels; i++)
            for (int kx = 0; kx < 3; kx++, w += PTIE_CONV_BLOCK)
                add_row(to, input + (i * PARTS + part) * STEP + kx, *w, width);
    }
}

/* A' of (N9): row r of a strip, and its part in the moments. */
static void join_parts(float *to, const float *parts, int r, float bias, bool relu, double *moments,
                       int32_t width) {
    static const float matrix[ROWS][PARTS] = {
        {1, 1, 1, 1, 1, 0}, {0, 1, -1, 2, -2, 0}, {0, 1, 1, 4, 4, 0}, {0, 1, -1, 8, -8, 1}};
    for (int32_t x = 0; x < width; x++) {
        float value = bias;
        for (int part = 0; part < PARTS; part++) value += matrix[r][part] * parts[part * STEP + x];
        to[x] = relu && !(value > 0) ? 0 : value;
        if (!moments) continue;
        moments[0] += (double)to[x];
        moments[1] += (double)to[x] * (double)to[x];
    }
}

void ptie_winograd3x3_scalar(const ptie_map *out, const ptie_map *in, const float *weights,
                             const float *bias, bool relu, double *moments, float *scratch,
                             const ptie_ahead *ahead) {
    float *input = scratch, *parts = input + (ptrdiff_t)in->channels * PARTS * STEP;
    (void)ahead;
    for (int32_t y = 0; y < out->height; y += ROWS)
        for (int32_t x = 0; x < out->width; x += TILE) {
            const int32_t width = smaller(out->width - x, TILE);
            const int32_t rows = smaller(out->height - y, ROWS);
            transform_input(input, in, y, x, width);
            for (int32_t o = 0; o < out->channels; o++) {
                multiply_parts(parts, input, weights, o, in->channels, width);
                for (int32_t r = 0; r < rows; r++)
                    join_parts(row_of(out, o, y + r) + x, parts, r, bias ? bias[o] : 0, relu,
                               moments ? moments + 2 * o : NULL, width);
            }
        }
}
