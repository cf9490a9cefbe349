/* SPDX-License-Identifier: BSD-3-Clause */
/* Convolutions, docs/math.md (N1), (N6). */
#include "kernel/scalar/scalar.h"

/* to += weight * from */
static void add_row(float *to, const float *from, float weight, int32_t width) {
    for (int32_t x = 0; x < width; x++) to[x] += weight * from[x];
}

static void fill_row(float *to, float value, int32_t width) {
    for (int32_t x = 0; x < width; x++) to[x] = value;
}

static double dot_row(const float *a, const float *b, int32_t width) {
    double sum = 0;
    for (int32_t x = 0; x < width; x++) sum += (double)a[x] * (double)b[x];
    return sum;
}

void ptie_conv3x3_scalar(const ptie_map *out, const ptie_map *in, const float *weights,
                         const float *bias, bool relu) {
    for (int32_t o = 0; o < out->channels; o++) {
        const float *block =
            weights + (ptrdiff_t)(o / PTIE_CONV_BLOCK) * in->channels * 9 * PTIE_CONV_BLOCK;
        for (int32_t y = 0; y < out->height; y++) {
            float *to = row_of(out, o, y);
            const float *w = block + o % PTIE_CONV_BLOCK;
            fill_row(to, bias ? bias[o] : 0, out->width);
            for (int32_t i = 0; i < in->channels; i++)
                for (int ky = -1; ky <= 1; ky++)
                    for (int kx = -1; kx <= 1; kx++, w += PTIE_CONV_BLOCK)
                        add_row(to, row_of(in, i, y + ky) + kx, *w, out->width);
            for (int32_t x = 0; x < out->width && relu; x++)
                if (!(to[x] > 0)) to[x] = 0;
        }
    }
}

void ptie_conv3x3_weights_scalar(double *grad, const ptie_map *out_grad, const ptie_map *in,
                                 float *scratch, const ptie_ahead *ahead) {
    (void)scratch, (void)ahead;
    for (int32_t o = 0; o < out_grad->channels; o++)
        for (int32_t i = 0; i < in->channels; i++)
            for (int ky = -1; ky <= 1; ky++)
                for (int kx = -1; kx <= 1; kx++, grad++)
                    for (int32_t y = 0; y < out_grad->height; y++)
                        *grad += dot_row(row_of(out_grad, o, y), row_of(in, i, y + ky) + kx,
                                         out_grad->width);
}

void ptie_conv1x1_scalar(const ptie_map *out, const ptie_map *in, const float *weights,
                         const float *bias) {
    for (int32_t o = 0; o < out->channels; o++)
        for (int32_t y = 0; y < out->height; y++) {
            fill_row(row_of(out, o, y), bias ? bias[o] : 0, out->width);
            for (int32_t i = 0; i < in->channels; i++)
                add_row(row_of(out, o, y), row_of(in, i, y), weights[o * in->channels + i],
                        out->width);
        }
}

void ptie_conv1x1_weights_scalar(double *grad, double *bias_grad, const ptie_map *out_grad,
                                 const ptie_map *in) {
    for (int32_t o = 0; o < out_grad->channels; o++)
        for (int32_t y = 0; y < out_grad->height; y++) {
            const float *g = row_of(out_grad, o, y);
            for (int32_t i = 0; i < in->channels; i++)
                grad[o * in->channels + i] += dot_row(g, row_of(in, i, y), out_grad->width);
            for (int32_t x = 0; x < out_grad->width; x++) bias_grad[o] += (double)g[x];
        }
}
