/* SPDX-License-Identifier: BSD-3-Clause */
/* Order of the 3x3 weights: the eight output channels a kernel computes together lie side by side.
 */
#include <string.h>

#include "kernel/kernel.h"

size_t ptie_conv3x3_packed(int32_t out_channels, int32_t in_channels) {
    size_t blocks = ((size_t)out_channels + PTIE_CONV_BLOCK - 1) / PTIE_CONV_BLOCK;
    return blocks * (size_t)in_channels * 9 * PTIE_CONV_BLOCK;
}

/* Place of tap 0 of one filter; the next tap is PTIE_CONV_BLOCK further. */
static float *filter(float *packed, int32_t out, int32_t in, int32_t in_channels) {
    size_t block = (size_t)(out / PTIE_CONV_BLOCK) * (size_t)in_channels + (size_t)in;
    return packed + block * 9 * PTIE_CONV_BLOCK + out % PTIE_CONV_BLOCK;
}

void ptie_conv3x3_pack(float *packed, const float *weights, int32_t out_channels,
                       int32_t in_channels, const float *scale) {
    memset(packed, 0, ptie_conv3x3_packed(out_channels, in_channels) * sizeof *packed);
    for (int32_t o = 0; o < out_channels; o++)
        for (int32_t i = 0; i < in_channels; i++, weights += 9) {
            float *to = filter(packed, o, i, in_channels);
            for (int tap = 0; tap < 9; tap++)
                to[tap * PTIE_CONV_BLOCK] = scale ? scale[o] * weights[tap] : weights[tap];
        }
}

void ptie_conv3x3_pack_adjoint(float *packed, const float *weights, int32_t out_channels,
                               int32_t in_channels) {
    memset(packed, 0, ptie_conv3x3_packed(in_channels, out_channels) * sizeof *packed);
    for (int32_t o = 0; o < out_channels; o++)
        for (int32_t i = 0; i < in_channels; i++, weights += 9) {
            float *to = filter(packed, i, o, out_channels);
            for (int tap = 0; tap < 9; tap++) to[tap * PTIE_CONV_BLOCK] = weights[8 - tap];
        }
}
