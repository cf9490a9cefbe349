/* SPDX-License-Identifier: BSD-3-Clause */
/* The output's sigmoid. */
#include "kernel/vec/vec.h"

/* exp(x) for |x| <= 87: 2^n exp(r) with n = round(x / ln 2), |r| <= ln 2 / 2, ln 2 in two parts,
   and exp(r) as its Taylor polynomial of degree 7, whose rest is below 2e-8 there. */
INLINE vf vf_exp(vf x) {
    const vf magic = vf_splat(12582912.0f); /* 1.5 * 2^23: adding it rounds to an integer */
    const vf shifted = x * vf_splat(1.44269504f) + magic, n = shifted - magic;
    const vf r = x - n * vf_splat(0.693359375f) + n * vf_splat(2.12194440e-4f);
    vf p = vf_splat(1.0f / 5040);
    static const float factors[] = {1.0f / 720, 1.0f / 120, 1.0f / 24, 1.0f / 6, 0.5f, 1.0f, 1.0f};
    UNROLL (i, 7) p = p * r + vf_splat(factors[i]);
    const vi exponent = ((vi)shifted - (vi)magic + 127) << 23;
    return p * (vf)exponent;
}

void VEC(sigmoid)(const ptie_map *out, const ptie_map *in) {
    const vf limit = vf_splat(87);
    for (int32_t c = 0; c < in->channels; c++)
        for (int32_t y = 0; y < in->height; y++)
            for (int32_t x = 0; x < in->width; x += VEC_WIDTH) {
                const vf value = -vf_load_first(row_of(in, c, y) + x, in->width - x);
                const vf within = vf_max(vf_select(value > limit, limit, value), -limit);
                vf_store_first(row_of(out, c, y) + x, vf_splat(1) / (vf_splat(1) + vf_exp(within)),
                               in->width - x);
            }
}
