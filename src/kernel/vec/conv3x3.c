/* SPDX-License-Identifier: BSD-3-Clause */
/* 3x3 convolution, every product as it stands.
 *
 * What decides is how often a loaded number is used while it is in a register.  Forward, a block of
 * OUT output channels times PIXELS vectors of pixels keeps its sums in registers: every input
 * vector feeds OUT multiply-adds, every weight PIXELS.  With 32 registers (AVX-512) 8 x 2 reaches
 * 96-99 % of the peak; with 16 (AVX2) the same block is done in two halves of 4 x 2.
 */
#include <string.h>

#include "kernel/vec/vec.h"

#if PTIE_VEC_WIDTH == 16
enum { OUT = 8 };
#else
enum { OUT = 4 };
#endif
enum { PIXELS = 2 };

/* What lies inside the image of a block at its edge. */
static void store_rest(float *out, ptrdiff_t plane, const float *block, int32_t channels,
                       int32_t width) {
    for (int32_t o = 0; o < channels; o++)
        memcpy(out + o * plane, block + o * PIXELS * VEC_WIDTH, (size_t)width * sizeof *out);
}

/* OUT channels x (vectors * VEC_WIDTH) pixels at one place.  `in`: the pixel of channel 0;
   `weights`: of the first output channel; stores `channels` x `width`. */
INLINE void convolve_block(float *out, const ptie_map *out_map, const float *in,
                           const ptie_map *in_map, const float *weights, const float *bias,
                           const int vectors, int32_t channels, int32_t width, bool relu) {
    vf sum[OUT][PIXELS];
    UNROLL (o, OUT)
        UNROLL (v, vectors) sum[o][v] = vf_splat(bias[o]);
    for (int32_t i = 0; i < in_map->channels; i++, in += in_map->plane) {
        const float *row = in - in_map->row - 1;
        for (int ky = 0; ky < 3; ky++, row += in_map->row, weights += 3 * PTIE_CONV_BLOCK)
            UNROLL (kx, 3) {
                const float *tap = weights + kx * PTIE_CONV_BLOCK;
                vf pixel[PIXELS];
                UNROLL (v, vectors) pixel[v] = vf_load(row + kx + v * VEC_WIDTH);
                UNROLL (o, OUT) {
                    const vf weight = vf_splat(tap[o]);
                    UNROLL (v, vectors) sum[o][v] += weight * pixel[v];
                }
            }
    }
    const bool whole = channels == OUT && width >= vectors * VEC_WIDTH;
    float rest[OUT * PIXELS * VEC_WIDTH];
    float *to = whole ? out : rest;
    const ptrdiff_t step = whole ? out_map->plane : PIXELS * VEC_WIDTH;
    UNROLL (o, OUT)
        UNROLL (v, vectors)
            vf_store(to + o * step + v * VEC_WIDTH, relu ? vf_positive(sum[o][v]) : sum[o][v]);
    if (!whole)
        store_rest(out, out_map->plane, rest, channels, smaller(width, vectors * VEC_WIDTH));
}

static void convolve_row(const ptie_map *out, const ptie_map *in, const float *weights,
                         const float *bias, int32_t o, int32_t y, bool relu) {
    const int32_t channels = smaller(out->channels - o, OUT);
    int32_t x = 0;
    for (; x + VEC_WIDTH < out->width; x += 2 * VEC_WIDTH)
        convolve_block(row_of(out, o, y) + x, out, row_of(in, 0, y) + x, in, weights, bias, 2,
                       channels, out->width - x, relu);
    if (x < out->width)
        convolve_block(row_of(out, o, y) + x, out, row_of(in, 0, y) + x, in, weights, bias, 1,
                       channels, out->width - x, relu);
}

void VEC(conv3x3)(const ptie_map *out, const ptie_map *in, const float *weights, const float *bias,
                  bool relu) {
    const ptrdiff_t block_floats = (ptrdiff_t)in->channels * 9 * PTIE_CONV_BLOCK;
    for (int32_t y = 0; y < out->height; y++)
        for (int32_t o = 0; o < out->channels; o += OUT) {
            float block_bias[OUT] = {0};
            for (int32_t c = 0; bias && c < OUT && o + c < out->channels; c++)
                block_bias[c] = bias[o + c];
            convolve_row(out, in,
                         weights + o / PTIE_CONV_BLOCK * block_floats + o % PTIE_CONV_BLOCK,
                         block_bias, o, y, relu);
        }
}
