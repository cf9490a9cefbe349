/* SPDX-License-Identifier: BSD-3-Clause */
/* Between resolutions: 2x2 maximum (N4), bilinear x2 (N5). */
#include "kernel/scalar/scalar.h"

static float max2(float a, float b) {
    return a > b ? a : b;
}

void ptie_maxpool_scalar(const ptie_map *out, const ptie_map *in) {
    for (int32_t c = 0; c < out->channels; c++)
        for (int32_t y = 0; y < out->height; y++) {
            const float *top = row_of(in, c, 2 * y), *bottom = row_of(in, c, 2 * y + 1);
            float *to = row_of(out, c, y);
            for (int32_t x = 0; x < out->width; x++)
                to[x] =
                    max2(max2(top[2 * x], top[2 * x + 1]), max2(bottom[2 * x], bottom[2 * x + 1]));
        }
}

void ptie_maxpool_backward_scalar(const ptie_map *in_grad, const ptie_map *out_grad,
                                  const ptie_map *in, const ptie_map *out) {
    for (int32_t c = 0; c < out->channels; c++)
        for (int32_t y = 0; y < out->height; y++)
            for (int32_t x = 0; x < out->width; x++) {
                int32_t first = 0; /* place in the window, row by row */
                while (first < 3 &&
                       row_of(in, c, 2 * y + first / 2)[2 * x + first % 2] != row_of(out, c, y)[x])
                    first++;
                row_of(in_grad, c, 2 * y + first / 2)[2 * x + first % 2] +=
                    row_of(out_grad, c, y)[x];
            }
}

/* Pixel `to` of the finer axis lies between `near` (weight 3/4) and `far` (weight 1/4) of the
 * coarser. */
static void neighbours(int32_t to, int32_t size, int32_t *near, int32_t *far) {
    *near = to / 2;
    *far = to % 2 ? *near + 1 : *near - 1;
    if (*far < 0) *far = 0;
    if (*far > size - 1) *far = size - 1;
}

void ptie_upsample_scalar(const ptie_map *out, const ptie_map *in, int32_t first) {
    for (int32_t c = 0; c < out->channels; c++)
        for (int32_t y = 0; y < out->height; y++)
            for (int32_t x = 0; x < out->width; x++) {
                int32_t y0, y1, x0, x1;
                neighbours(first + y, in->height, &y0, &y1);
                neighbours(x, in->width, &x0, &x1);
                const float *a = row_of(in, c, y0), *b = row_of(in, c, y1);
                row_of(out, c, y)[x] = 0.75f * (0.75f * a[x0] + 0.25f * b[x0]) +
                                       0.25f * (0.75f * a[x1] + 0.25f * b[x1]);
            }
}

void ptie_upsample_backward_scalar(const ptie_map *in_grad, const ptie_map *out_grad,
                                   int32_t first) {
    for (int32_t c = 0; c < out_grad->channels; c++)
        for (int32_t y = 0; y < out_grad->height; y++)
            for (int32_t x = 0; x < out_grad->width; x++) {
                int32_t y0, y1, x0, x1;
                neighbours(first + y, in_grad->height, &y0, &y1);
                neighbours(x, in_grad->width, &x0, &x1);
                float g = row_of(out_grad, c, y)[x];
                row_of(in_grad, c, y0)[x0] += 0.5625f * g;
                row_of(in_grad, c, y0)[x1] += 0.1875f * g;
                row_of(in_grad, c, y1)[x0] += 0.1875f * g;
                row_of(in_grad, c, y1)[x1] += 0.0625f * g;
            }
}
