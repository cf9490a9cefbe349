/* SPDX-License-Identifier: BSD-3-Clause */
/* The kernels in half precision, for AVX512-FP16: 32 halves per register.  conv3x3 is built as the
 * one in vec/conv3x3.c, and like it reaches the peak, which is twice as high here. */
#include "kernel/half.h"

#include <string.h>

#include "kernel/vec/vec.h"

enum { HALVES = 32, OUT = 8, PIXELS = 2 };

typedef _Float16 vh __attribute__((vector_size(64)));
typedef _Float16 vh_anywhere __attribute__((vector_size(64), aligned(2), may_alias));
typedef int32_t pair __attribute__((may_alias));

static const _Float16 three_quarters = 0.75f, quarter = 0.25f;

INLINE ptie_half *half_row(const ptie_map *map, int32_t c, int32_t y) {
    return (ptie_half *)row_of(map, c, y);
}

INLINE vh vh_load(const ptie_half *from) {
    return *(const vh_anywhere *)(const void *)from;
}

INLINE void vh_store(ptie_half *to, vh value) {
    *(vh_anywhere *)(void *)to = value;
}

static __attribute__((noinline)) void vh_store_rest(ptie_half *to, vh value, int32_t count) {
    if (count > 0) memcpy(to, &value, (size_t)count * sizeof *to);
}

/* The first `count` lanes; at most HALVES are stored. */
INLINE void vh_store_first(ptie_half *to, vh value, int32_t count) {
    if (count >= HALVES)
        vh_store(to, value);
    else
        vh_store_rest(to, value, count);
}

INLINE vh vh_splat(_Float16 value) {
    return value - (vh){0};
}

INLINE vh vh_splat_pair(pair value) {
    return (vh)(value - (vi){0});
}

INLINE vh vh_max(vh a, vh b) {
    return (vh)_mm512_max_ph((__m512h)a, (__m512h)b);
}

/* The ReLU; a sum that has become infinite is the largest number. */
INLINE vh vh_relu(vh a) {
    const vh largest = vh_splat((_Float16)65504.0f);
    return (vh)_mm512_min_ph((__m512h)vh_max(a, (vh){0}), (__m512h)largest);
}

#define VH_EVEN                                                                                    \
    0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30, 32, 34, 36, 38, 40, 42, 44, 46, 48, \
        50, 52, 54, 56, 58, 60, 62
#define VH_ODD                                                                                     \
    1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31, 33, 35, 37, 39, 41, 43, 45, 47, 49, \
        51, 53, 55, 57, 59, 61, 63
#define VH_LOW                                                                                     \
    0, 32, 1, 33, 2, 34, 3, 35, 4, 36, 5, 37, 6, 38, 7, 39, 8, 40, 9, 41, 10, 42, 11, 43, 12, 44,  \
        13, 45, 14, 46, 15, 47
#define VH_HIGH                                                                                    \
    16, 48, 17, 49, 18, 50, 19, 51, 20, 52, 21, 53, 22, 54, 23, 55, 24, 56, 25, 57, 26, 58, 27,    \
        59, 28, 60, 29, 61, 30, 62, 31, 63

/* What lies inside the image of a block at its edge. */
static void store_rest(ptie_half *out, ptrdiff_t plane, const ptie_half *block, int32_t channels,
                       int32_t width) {
    for (int32_t o = 0; o < channels; o++)
        memcpy(out + o * plane, block + o * PIXELS * HALVES, (size_t)width * sizeof *out);
}

/* OUT channels x (vectors * HALVES) pixels at one place, of which `channels` x `width` exist. `in`:
   the pixel of channel 0; `weights`: of the first output channel. */
INLINE void convolve_block(ptie_half *out, const ptie_map *out_map, const ptie_half *in,
                           const ptie_map *in_map, const float *weights, const float *bias,
                           const int vectors, int32_t channels, int32_t width) {
    const ptrdiff_t in_row = 2 * in_map->row, in_plane = 2 * in_map->plane;
    const pair *tap = (const pair *)weights;
    vh sum[OUT][PIXELS];
    UNROLL (o, OUT)
        UNROLL (v, vectors) sum[o][v] = vh_splat((_Float16)bias[o]);
    for (int32_t i = 0; i < in_map->channels; i++, in += in_plane) {
        const ptie_half *row = in - in_row - 1;
        for (int ky = 0; ky < 3; ky++, row += in_row, tap += 3 * PTIE_CONV_BLOCK)
            UNROLL (kx, 3) {
                vh pixel[PIXELS];
                UNROLL (v, vectors) pixel[v] = vh_load(row + kx + v * HALVES);
                UNROLL (o, OUT) {
                    const vh weight = vh_splat_pair(tap[kx * PTIE_CONV_BLOCK + o]);
                    UNROLL (v, vectors) sum[o][v] += weight * pixel[v];
                }
            }
    }
    const bool whole = channels == OUT && width >= vectors * HALVES;
    ptie_half rest[OUT * PIXELS * HALVES];
    ptie_half *to = whole ? out : rest;
    const ptrdiff_t step = whole ? 2 * out_map->plane : PIXELS * HALVES;
    UNROLL (o, OUT)
        UNROLL (v, vectors) vh_store(to + o * step + v * HALVES, vh_relu(sum[o][v]));
    if (!whole)
        store_rest(out, 2 * out_map->plane, rest, channels, smaller(width, vectors * HALVES));
}

static void convolve_row(const ptie_map *out, const ptie_map *in, const float *weights,
                         const float *bias, int32_t o, int32_t y) {
    const int32_t channels = smaller(out->channels - o, OUT);
    ptie_half *to = half_row(out, o, y);
    const ptie_half *from = half_row(in, 0, y);
    int32_t x = 0;
    for (; x + HALVES < out->width; x += 2 * HALVES)
        convolve_block(to + x, out, from + x, in, weights, bias, 2, channels, out->width - x);
    if (x < out->width)
        convolve_block(to + x, out, from + x, in, weights, bias, 1, channels, out->width - x);
}

static void conv3x3(const ptie_map *out, const ptie_map *in, const float *weights,
                    const float *bias) {
    const ptrdiff_t block_weights = (ptrdiff_t)in->channels * 9 * PTIE_CONV_BLOCK;
    for (int32_t y = 0; y < out->height; y++)
        for (int32_t o = 0; o < out->channels; o += OUT) {
            float block_bias[OUT] = {0};
            memcpy(block_bias, bias + o,
                   (size_t)smaller(out->channels - o, OUT) * sizeof *block_bias);
            convolve_row(out, in, weights + o / OUT * block_weights, block_bias, o, y);
        }
}

static void conv1x1(const ptie_map *out, const ptie_map *in, const float *weights,
                    const float *bias) {
    for (int32_t y = 0; y < out->height; y++)
        for (int32_t o = 0; o < out->channels; o++)
            for (int32_t x = 0; x < out->width; x += VEC_WIDTH) {
                const ptie_half *from = half_row(in, 0, y) + x;
                vf sum = vf_splat(bias[o]);
                for (int32_t i = 0; i < in->channels; i++, from += 2 * in->plane) {
                    const __m256i halves = _mm256_loadu_si256((const __m256i *)(const void *)from);
                    sum += vf_splat(weights[o * in->channels + i]) * (vf)_mm512_cvtph_ps(halves);
                }
                vf_store_first(row_of(out, o, y) + x, sum, out->width - x);
            }
}

static void maxpool(const ptie_map *out, const ptie_map *in) {
    for (int32_t c = 0; c < out->channels; c++)
        for (int32_t y = 0; y < out->height; y++) {
            const ptie_half *top = half_row(in, c, 2 * y), *bottom = half_row(in, c, 2 * y + 1);
            for (int32_t x = 0; x < out->width; x += HALVES) {
                const ptie_half *above = top + 2 * x, *below = bottom + 2 * x;
                const vh a = vh_max(vh_load(above), vh_load(below));
                const vh b = vh_max(vh_load(above + HALVES), vh_load(below + HALVES));
                vh_store_first(half_row(out, c, y) + x,
                               vh_max(__builtin_shufflevector(a, b, VH_EVEN),
                                      __builtin_shufflevector(a, b, VH_ODD)),
                               out->width - x);
            }
        }
}

/* Pixels x .. of the row between two, three quarters from the near one. */
INLINE vh blend(const ptie_half *near, const ptie_half *far, int32_t x) {
    return three_quarters * vh_load(near + x) + quarter * vh_load(far + x);
}

/* One row of the finer image from the two coarser rows around it. */
static void upsample_row(ptie_half *out, const ptie_half *near, const ptie_half *far,
                         int32_t width) {
    for (int32_t x = 0; x < width; x += HALVES) {
        const vh left = blend(near, far, x - 1), here = blend(near, far, x);
        const vh right = blend(near, far, x + 1);
        const vh even = three_quarters * here + quarter * left,
                 odd = three_quarters * here + quarter * right;
        vh_store_first(out + 2 * x, __builtin_shufflevector(even, odd, VH_LOW), 2 * (width - x));
        vh_store_first(out + 2 * x + HALVES, __builtin_shufflevector(even, odd, VH_HIGH),
                       2 * (width - x) - HALVES);
    }
    /* Where the neighbour was the halo, the edge continues. */
    const vh first = blend(near, far, 0), last = blend(near, far, width - 1);
    vh_store_rest(out, first, 1);
    vh_store_rest(out + 2 * width - 1, last, 1);
}

static void upsample(const ptie_map *out, const ptie_map *in, int32_t first) {
    const int32_t last = in->height - 1;
    for (int32_t c = 0; c < out->channels; c++)
        for (int32_t y = 0; y < out->height; y++) {
            const int32_t near = (first + y) / 2, next = (first + y) % 2 ? near + 1 : near - 1;
            const int32_t far = next < 0 ? 0 : smaller(next, last);
            upsample_row(half_row(out, c, y), half_row(in, c, near), half_row(in, c, far),
                         in->width);
        }
}

static void narrow(ptie_half *out, const float *in, int32_t count) {
    const __m512 largest = _mm512_set1_ps(65504);
    for (int32_t i = 0; i < count; i += VEC_WIDTH) {
        const __mmask16 some = (__mmask16)((1u << smaller(count - i, VEC_WIDTH)) - 1);
        const __m512 value = _mm512_min_ps(_mm512_maskz_loadu_ps(some, in + i), largest);
        const __m256i halves = _mm512_cvtps_ph(_mm512_max_ps(value, -largest),
                                               _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
        _mm256_mask_storeu_epi16(out + i, some, halves);
    }
}

extern const ptie_half_kernels ptie_half_kernels_vector;
const ptie_half_kernels ptie_half_kernels_vector = {
#define PTIE_KERNEL(name, parameters) .name = name,
#include "kernel/half_kernels.inc"
#undef PTIE_KERNEL
};
