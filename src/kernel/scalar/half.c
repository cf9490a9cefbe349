/* SPDX-License-Identifier: BSD-3-Clause */
/* Reference twins of the kernels in half precision: single precision, rounded once at the end. */
#include "kernel/half.h"

#include "kernel/scalar/scalar.h"

static ptie_half *half_row(const ptie_map *map, int32_t c, int32_t y) {
    return (ptie_half *)row_of(map, c, y);
}

static float pixel(const ptie_map *map, int32_t c, int32_t y, int32_t x) {
    return ptie_half_to(half_row(map, c, y)[x]);
}

/* Around pixel (y, x), without the bias; `pairs` of output channel o. */
static float sum3x3(const ptie_map *in, const ptie_half *pairs, int32_t y, int32_t x) {
    float sum = 0;
    for (int32_t i = 0; i < in->channels; i++)
        for (int ky = -1; ky <= 1; ky++)
            for (int kx = -1; kx <= 1; kx++, pairs += 2 * PTIE_CONV_BLOCK)
                sum += ptie_half_to(*pairs) * pixel(in, i, y + ky, x + kx);
    return sum;
}

static void conv3x3(const ptie_map *out, const ptie_map *in, const float *weights,
                    const float *bias) {
    for (int32_t o = 0; o < out->channels; o++) {
        const float *block =
            weights + (ptrdiff_t)(o / PTIE_CONV_BLOCK) * in->channels * 9 * PTIE_CONV_BLOCK;
        for (int32_t y = 0; y < out->height; y++)
            for (int32_t x = 0; x < out->width; x++) {
                const ptie_half *pairs = (const ptie_half *)(block + o % PTIE_CONV_BLOCK);
                const float sum = bias[o] + sum3x3(in, pairs, y, x);
                half_row(out, o, y)[x] = ptie_half_from(sum > 0 ? sum : 0);
            }
    }
}

static void conv1x1(const ptie_map *out, const ptie_map *in, const float *weights,
                    const float *bias) {
    for (int32_t o = 0; o < out->channels; o++)
        for (int32_t y = 0; y < out->height; y++)
            for (int32_t x = 0; x < out->width; x++) {
                float sum = bias[o];
                for (int32_t i = 0; i < in->channels; i++)
                    sum += weights[o * in->channels + i] * pixel(in, i, y, x);
                row_of(out, o, y)[x] = sum;
            }
}

static ptie_half larger(ptie_half a, ptie_half b) {
    return a > b ? a : b; /* numbers that are not negative are ordered as their bits are */
}

static void maxpool(const ptie_map *out, const ptie_map *in) {
    for (int32_t c = 0; c < out->channels; c++)
        for (int32_t y = 0; y < out->height; y++) {
            const ptie_half *top = half_row(in, c, 2 * y), *bottom = half_row(in, c, 2 * y + 1);
            for (int32_t x = 0; x < out->width; x++)
                half_row(out, c, y)[x] = larger(larger(top[2 * x], top[2 * x + 1]),
                                                larger(bottom[2 * x], bottom[2 * x + 1]));
        }
}

/* The pixel next to that of the coarser axis `to` lies in, on its side; edges are clamped. */
static int32_t beside(int32_t to, int32_t size) {
    const int32_t next = to % 2 ? to / 2 + 1 : to / 2 - 1;
    return next < 0 ? 0 : next < size ? next : size - 1;
}

static void upsample(const ptie_map *out, const ptie_map *in, int32_t first) {
    for (int32_t c = 0; c < out->channels; c++)
        for (int32_t y = 0; y < out->height; y++)
            for (int32_t x = 0; x < out->width; x++) {
                const int32_t near = (first + y) / 2, far = beside(first + y, in->height);
                const int32_t here = x / 2, next = beside(x, in->width);
                half_row(out, c, y)[x] = ptie_half_from(
                    0.5625f * pixel(in, c, near, here) + 0.1875f * pixel(in, c, near, next) +
                    0.1875f * pixel(in, c, far, here) + 0.0625f * pixel(in, c, far, next));
            }
}

static void narrow(ptie_half *out, const float *in, int32_t count) {
    for (int32_t i = 0; i < count; i++) out[i] = ptie_half_from(in[i]);
}

const ptie_half_kernels ptie_half_kernels_scalar = {
#define PTIE_KERNEL(name, parameters) .name = name,
#include "kernel/half_kernels.inc"
#undef PTIE_KERNEL
};
