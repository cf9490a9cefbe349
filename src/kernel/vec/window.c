/* SPDX-License-Identifier: BSD-3-Clause */
/* The separable window of SSIM and its adjoint: columns first, into `row`, then along the row. */
#include "kernel/vec/vec.h"

enum { TAPS = PTIE_SSIM_WINDOW, MARGIN = PTIE_SSIM_WINDOW - 1 };

/* to[x] = sum of taps[first ..] over from[x], from[x + step], ...; reads no more than is there. */
static void weigh(float *to, const float *from, ptrdiff_t step, const float *taps, int32_t count,
                  int32_t width) {
    int32_t x = 0;
    for (; x + VEC_WIDTH <= width; x += VEC_WIDTH) {
        vf sum = {0};
        for (int32_t k = 0; k < count; k++) sum += vf_splat(taps[k]) * vf_load(from + x + k * step);
        vf_store(to + x, sum);
    }
    for (; x < width; x++) {
        to[x] = 0;
        for (int32_t k = 0; k < count; k++) to[x] += taps[k] * from[x + k * step];
    }
}

void VEC(window)(float *out, const float *in, int32_t width, int32_t height, const float *taps,
                 float *row) {
    for (int32_t y = 0; y < height - MARGIN; y++) {
        weigh(row, in + (ptrdiff_t)y * width, width, taps, TAPS, width);
        weigh(out + (ptrdiff_t)y * (width - MARGIN), row, 1, taps, TAPS, width - MARGIN);
    }
}

void VEC(window_adjoint)(float *out, const float *in, int32_t width, int32_t height,
                         const float *taps, float *row) {
    const int32_t in_width = width - MARGIN, in_height = height - MARGIN;
    for (int32_t x = 0; x < MARGIN; x++) row[x] = row[MARGIN + in_width + x] = 0;
    for (int32_t y = 0; y < height; y++) {
        /* Rows y-10 .. y of the smaller image, as far as they exist; the taps are symmetric. */
        const int32_t first = y > MARGIN ? y - MARGIN : 0, last = smaller(y, in_height - 1);
        weigh(row + MARGIN, in + (ptrdiff_t)first * in_width, in_width,
              taps + (first - (y - MARGIN)), last - first + 1, in_width);
        weigh(out + (ptrdiff_t)y * width, row, 1, taps, TAPS, width);
    }
}
