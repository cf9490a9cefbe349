/* SPDX-License-Identifier: BSD-3-Clause */
/* 1x1 convolution: as fast as memory. */
#include "kernel/vec/vec.h"

void VEC(conv1x1)(const ptie_map *out, const ptie_map *in, const float *weights,
                  const float *bias) {
    for (int32_t y = 0; y < out->height; y++)
        for (int32_t o = 0; o < out->channels; o++)
            for (int32_t x = 0; x < out->width; x += VEC_WIDTH) {
                const float *from = row_of(in, 0, y) + x;
                vf sum = vf_splat(bias ? bias[o] : 0);
                for (int32_t i = 0; i < in->channels; i++, from += in->plane)
                    sum += vf_splat(weights[o * in->channels + i]) * vf_load(from);
                vf_store_first(row_of(out, o, y) + x, sum, out->width - x);
            }
}

void VEC(conv1x1_weights)(double *grad, double *bias_grad, const ptie_map *out_grad,
                          const ptie_map *in) {
    for (int32_t o = 0; o < out_grad->channels; o++)
        for (int32_t y = 0; y < out_grad->height; y++) {
            const float *g = row_of(out_grad, o, y);
            for (int32_t i = 0; i <= in->channels; i++) { /* the last one is the bias */
                const float *from = i < in->channels ? row_of(in, i, y) : NULL;
                vf sum = {0};
                for (int32_t x = 0; x < out_grad->width; x += VEC_WIDTH) {
                    const vf value = vf_first(vf_load(g + x), out_grad->width - x);
                    sum += from ? value * vf_load(from + x) : value;
                }
                *(from ? &grad[o * in->channels + i] : &bias_grad[o]) += vf_sum(sum);
            }
        }
}
