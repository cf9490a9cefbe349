/* SPDX-License-Identifier: BSD-3-Clause */
/* BatchNorm with ReLU.  Sums run in single precision over a few rows, in double beyond.
 */
#include "kernel/vec/vec.h"

/* Rows summed in single precision before they go on in double. */
enum { SUM_ROWS = 4 };

void VEC(normalise)(const ptie_map *out, const ptie_map *z, const ptie_norm *norms) {
    for (int32_t c = 0; c < z->channels; c++) {
        const vf scale = vf_splat(norms[c].scale), shift = vf_splat(norms[c].shift);
        for (int32_t y = 0; y < z->height; y++) {
            const float *from = row_of(z, c, y);
            float *to = row_of(out, c, y);
            for (int32_t x = 0; x < z->width; x += VEC_WIDTH)
                vf_store_first(to + x, vf_positive(scale * vf_load(from + x) + shift),
                               z->width - x);
        }
    }
}

/* The gradient where the ReLU was open. */
INLINE vf open_gradient(vf g, vf z, const ptie_norm *norm) {
    return (vf)((z * vf_splat(norm->scale) + vf_splat(norm->shift) > 0) & (vi)g);
}

void VEC(normalise_sums)(double *sums, const ptie_map *grad, const ptie_map *z,
                         const ptie_norm *norms) {
    for (int32_t c = 0; c < z->channels; c++) {
        const vf mean = vf_splat(norms[c].mean), inverse_std = vf_splat(norms[c].inverse_std);
        for (int32_t y = 0; y < z->height; y += SUM_ROWS) {
            vf sum = {0}, product = {0};
            for (int32_t r = y; r < smaller(y + SUM_ROWS, z->height); r++) {
                const float *from = row_of(z, c, r), *g = row_of(grad, c, r);
                for (int32_t x = 0; x < z->width; x += VEC_WIDTH) {
                    const vf value = vf_load(from + x);
                    const vf open =
                        vf_first(open_gradient(vf_load(g + x), value, &norms[c]), z->width - x);
                    sum += open;
                    product += open * ((value - mean) * inverse_std);
                }
            }
            sums[2 * c] += vf_sum(sum);
            sums[2 * c + 1] += vf_sum(product);
        }
    }
}

void VEC(normalise_backward)(const ptie_map *z_grad, const ptie_map *grad, const ptie_map *z,
                             const ptie_norm *norms) {
    for (int32_t c = 0; c < z->channels; c++) {
        const vf mean = vf_splat(norms[c].mean), inverse_std = vf_splat(norms[c].inverse_std);
        const vf mean_g = vf_splat(norms[c].mean_g), mean_gx = vf_splat(norms[c].mean_gx);
        const vf scale = vf_splat(norms[c].scale);
        for (int32_t y = 0; y < z->height; y++) {
            const float *from = row_of(z, c, y), *g = row_of(grad, c, y);
            float *to = row_of(z_grad, c, y);
            for (int32_t x = 0; x < z->width; x += VEC_WIDTH) {
                const vf value = vf_load(from + x), xhat = (value - mean) * inverse_std;
                const vf open = open_gradient(vf_load(g + x), value, &norms[c]);
                vf_store_first(to + x, scale * (open - mean_g - xhat * mean_gx), z->width - x);
            }
        }
    }
}
