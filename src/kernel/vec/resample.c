/* SPDX-License-Identifier: BSD-3-Clause */
/* Between resolutions: 2x2 maximum, bilinear x2. */
#include "kernel/vec/vec.h"

void VEC(maxpool)(const ptie_map *out, const ptie_map *in) {
    for (int32_t c = 0; c < out->channels; c++)
        for (int32_t y = 0; y < out->height; y++) {
            const float *top = row_of(in, c, 2 * y), *bottom = row_of(in, c, 2 * y + 1);
            float *to = row_of(out, c, y);
            for (int32_t x = 0; x < out->width; x += VEC_WIDTH) {
                const vf a = vf_max(vf_load(top + 2 * x), vf_load(bottom + 2 * x));
                const vf b =
                    vf_max(vf_load(top + 2 * x + VEC_WIDTH), vf_load(bottom + 2 * x + VEC_WIDTH));
                vf_store_first(to + x, vf_max(vf_even(a, b), vf_odd(a, b)), out->width - x);
            }
        }
}

/* Adds the even and odd lanes' gradients to a row; `count` pixels of it remain. */
INLINE void add_pairs(float *to, vf even, vf odd, int32_t count) {
    const vf low = vf_load(to) + vf_interleave_low(even, odd);
    const vf high = vf_load(to + VEC_WIDTH) + vf_interleave_high(even, odd);
    vf_store_first(to, low, count);
    vf_store_first(to + VEC_WIDTH, high, count - VEC_WIDTH);
}

void VEC(maxpool_backward)(const ptie_map *in_grad, const ptie_map *out_grad, const ptie_map *in,
                           const ptie_map *out) {
    for (int32_t c = 0; c < out->channels; c++)
        for (int32_t y = 0; y < out->height; y++)
            for (int32_t x = 0; x < out->width; x += VEC_WIDTH) {
                const float *top = row_of(in, c, 2 * y) + 2 * x,
                            *bottom = row_of(in, c, 2 * y + 1) + 2 * x;
                const vf top0 = vf_load(top), top1 = vf_load(top + VEC_WIDTH),
                         bottom0 = vf_load(bottom);
                const vf maximum = vf_load(row_of(out, c, y) + x);
                const vi g = (vi)vf_load(row_of(out_grad, c, y) + x);
                const vi first = vf_even(top0, top1) == maximum;
                const vi second = (vf_odd(top0, top1) == maximum) & ~first;
                const vi third =
                    (vf_even(bottom0, vf_load(bottom + VEC_WIDTH)) == maximum) & ~(first | second);
                const vi fourth = ~(first | second | third);
                const int32_t left = 2 * (out->width - x);
                add_pairs(row_of(in_grad, c, 2 * y) + 2 * x, (vf)(first & g), (vf)(second & g),
                          left);
                add_pairs(row_of(in_grad, c, 2 * y + 1) + 2 * x, (vf)(third & g), (vf)(fourth & g),
                          left);
            }
}

/* 3/4 near + 1/4 far */
INLINE vf blend(const float *near, const float *far) {
    return vf_splat(0.75f) * vf_load(near) + vf_splat(0.25f) * vf_load(far);
}

/* One row of the finer image from the two coarser rows around it. */
static void upsample_row(float *out, const float *near, const float *far, int32_t width) {
    const vf most = vf_splat(0.75f), rest = vf_splat(0.25f);
    for (int32_t x = 0; x < width; x += VEC_WIDTH) {
        const vf left = blend(near + x - 1, far + x - 1), here = blend(near + x, far + x);
        const vf right = blend(near + x + 1, far + x + 1);
        const vf even = most * here + rest * left, odd = most * here + rest * right;
        vf_store_first(out + 2 * x, vf_interleave_low(even, odd), 2 * (width - x));
        vf_store_first(out + 2 * x + VEC_WIDTH, vf_interleave_high(even, odd),
                       2 * (width - x) - VEC_WIDTH);
    }
    /* Where the neighbour was the halo, the edge continues. */
    out[0] = 0.75f * near[0] + 0.25f * far[0];
    out[2 * width - 1] = 0.75f * near[width - 1] + 0.25f * far[width - 1];
}

void VEC(upsample)(const ptie_map *out, const ptie_map *in, int32_t first) {
    const int32_t last = in->height - 1;
    for (int32_t c = 0; c < out->channels; c++)
        for (int32_t y = 0; y < out->height; y++) {
            const int32_t near = (first + y) / 2, next = (first + y) % 2 ? near + 1 : near - 1;
            const int32_t far = next < 0 ? 0 : smaller(next, last);
            upsample_row(row_of(out, c, y), row_of(in, c, near), row_of(in, c, far), in->width);
        }
}

/* Weighted sum of four rows of the finer image: 2y-1, 2y, 2y+1, 2y+2. */
INLINE vf blend4(const float *const rows[4], const float weights[4], int32_t x) {
    return vf_splat(weights[0]) * vf_load(rows[0] + x) +
           vf_splat(weights[1]) * vf_load(rows[1] + x) +
           (vf_splat(weights[2]) * vf_load(rows[2] + x) +
            vf_splat(weights[3]) * vf_load(rows[3] + x));
}

/* Adds to a row of the coarser image what four rows of the finer one give it. */
static void spread_back(float *to, const float *const rows[4], const float weights[4],
                        int32_t width) {
    for (int32_t x = 0; x < width; x += VEC_WIDTH) {
        const vf a = blend4(rows, weights, 2 * x), b = blend4(rows, weights, 2 * x + VEC_WIDTH);
        const vf before =
            vf_even(blend4(rows, weights, 2 * x - 1), blend4(rows, weights, 2 * x - 1 + VEC_WIDTH));
        const vf after =
            vf_even(blend4(rows, weights, 2 * x + 2), blend4(rows, weights, 2 * x + 2 + VEC_WIDTH));
        const vf sum =
            vf_splat(0.75f) * (vf_even(a, b) + vf_odd(a, b)) + vf_splat(0.25f) * (before + after);
        vf_store_first(to + x, vf_load(to + x) + sum, width - x);
    }
    for (int k = 0; k < 4; k++) { /* at its ends the row continues itself */
        to[0] += 0.25f * weights[k] * rows[k][0];
        to[width - 1] += 0.25f * weights[k] * rows[k][2 * width - 1];
    }
}

void VEC(upsample_backward)(const ptie_map *in_grad, const ptie_map *out_grad, int32_t first) {
    const int32_t last = in_grad->height - 1, end = first + out_grad->height;
    const int32_t from = first > 0 ? (first - 1) / 2 : 0, to = smaller(last, end / 2);
    for (int32_t c = 0; c < out_grad->channels; c++)
        for (int32_t y = from; y <= to; y++) {
            /* The image's first and last row continue themselves. */
            const float full[4] = {0.25f, y > 0 ? 0.75f : 1, y < last ? 0.75f : 1, 0.25f};
            const float *rows[4];
            float weights[4];
            for (int32_t k = 0; k < 4; k++) {
                const int32_t row = 2 * y - 1 + k;
                const bool given = row >= first && row < end;
                weights[k] = given ? full[k] : 0;
                rows[k] = row_of(out_grad, c, given ? row - first : 0);
            }
            spread_back(row_of(in_grad, c, y), rows, weights, in_grad->width);
        }
}
