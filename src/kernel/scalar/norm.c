/* SPDX-License-Identifier: BSD-3-Clause */
/* BatchNorm with ReLU, docs/math.md (N2), (N3). */
#include "kernel/scalar/scalar.h"

void ptie_normalise_scalar(const ptie_map *out, const ptie_map *z, const ptie_norm *norms) {
    for (int32_t c = 0; c < z->channels; c++)
        for (int32_t y = 0; y < z->height; y++) {
            const float *from = row_of(z, c, y);
            float *to = row_of(out, c, y);
            for (int32_t x = 0; x < z->width; x++) {
                float value = norms[c].scale * from[x] + norms[c].shift;
                to[x] = value > 0 ? value : 0;
            }
        }
}

void ptie_normalise_sums_scalar(double *sums, const ptie_map *grad, const ptie_map *z,
                                const ptie_norm *norms) {
    for (int32_t c = 0; c < z->channels; c++)
        for (int32_t y = 0; y < z->height; y++) {
            const float *from = row_of(z, c, y), *g = row_of(grad, c, y);
            for (int32_t x = 0; x < z->width; x++) {
                if (!(norms[c].scale * from[x] + norms[c].shift > 0)) continue;
                float xhat = (from[x] - norms[c].mean) * norms[c].inverse_std;
                sums[2 * c] += (double)g[x];
                sums[2 * c + 1] += (double)g[x] * (double)xhat;
            }
        }
}

void ptie_normalise_backward_scalar(const ptie_map *z_grad, const ptie_map *grad, const ptie_map *z,
                                    const ptie_norm *norms) {
    for (int32_t c = 0; c < z->channels; c++)
        for (int32_t y = 0; y < z->height; y++) {
            const float *from = row_of(z, c, y), *g = row_of(grad, c, y);
            float *to = row_of(z_grad, c, y);
            for (int32_t x = 0; x < z->width; x++) {
                float open = norms[c].scale * from[x] + norms[c].shift > 0 ? g[x] : 0;
                float xhat = (from[x] - norms[c].mean) * norms[c].inverse_std;
                to[x] = norms[c].scale * (open - norms[c].mean_g - xhat * norms[c].mean_gx);
            }
        }
}
