/* SPDX-License-Identifier: BSD-3-Clause */
/* Order of the 3x3 weights: the eight output channels a kernel computes together lie side by side.
 */
#include <string.h>

#include "kernel/kernel.h"

enum { BLOCK = PTIE_CONV_BLOCK, PARTS = PTIE_WINOGRAD_PARTS };

static size_t blocks(int32_t channels) {
    return ((size_t)channels + BLOCK - 1) / BLOCK;
}

/* Filter (o, i) of (O, I, 3, 3), or of the adjoint: channels exchanged, turned by 180 degrees. */
typedef struct filters {
    const float *weights;
    int32_t out_channels, in_channels; /* of the convolution that is packed */
    bool adjoint;
} filters;

static float tap(const filters *f, int32_t o, int32_t i, int32_t at) {
    const ptrdiff_t filter =
        f->adjoint ? (ptrdiff_t)i * f->out_channels + o : (ptrdiff_t)o * f->in_channels + i;
    return f->weights[filter * 9 + (f->adjoint ? 8 - at : at)];
}

size_t ptie_conv3x3_packed(int32_t out_channels, int32_t in_channels) {
    return blocks(out_channels) * (size_t)in_channels * 9 * BLOCK;
}

static void pack_direct(float *packed, const filters *f, const float *scale) {
    memset(packed, 0, ptie_conv3x3_packed(f->out_channels, f->in_channels) * sizeof *packed);
    for (int32_t o = 0; o < f->out_channels; o++)
        for (int32_t i = 0; i < f->in_channels; i++) {
            const size_t block = (size_t)(o / BLOCK) * (size_t)f->in_channels + (size_t)i;
            float *to = packed + block * 9 * BLOCK + o % BLOCK;
            for (int at = 0; at < 9; at++)
                to[at * BLOCK] = (scale ? scale[o] : 1) * tap(f, o, i, at);
        }
}

void ptie_conv3x3_pack(float *packed, const float *weights, int32_t out_channels,
                       int32_t in_channels, const float *scale) {
    pack_direct(packed, &(filters){weights, out_channels, in_channels, false}, scale);
}

void ptie_conv3x3_pack_adjoint(float *packed, const float *weights, int32_t out_channels,
                               int32_t in_channels) {
    pack_direct(packed, &(filters){weights, in_channels, out_channels, true}, NULL);
}

size_t ptie_winograd_packed(int32_t out_channels, int32_t in_channels) {
    return blocks(out_channels) * PARTS * (size_t)in_channels * 3 * BLOCK;
}

/* G of (N9): the three taps of a column become the weights of the six parts. */
static void transform_taps(float parts[PARTS], double top, double middle, double bottom) {
    const double outer1 = top + bottom, outer2 = top + 4 * bottom;
    parts[0] = (float)(top / 4);
    parts[1] = (float)(-(outer1 + middle) / 6);
    parts[2] = (float)(-(outer1 - middle) / 6);
    parts[3] = (float)((outer2 + 2 * middle) / 24);
    parts[4] = (float)((outer2 - 2 * middle) / 24);
    parts[5] = (float)bottom;
}

static void pack_parts(float *packed, const filters *f, const float *scale) {
    const size_t part_floats = (size_t)f->in_channels * 3 * BLOCK;
    memset(packed, 0, ptie_winograd_packed(f->out_channels, f->in_channels) * sizeof *packed);
    for (int32_t o = 0; o < f->out_channels; o++)
        for (int32_t i = 0; i < f->in_channels; i++)
            for (int kx = 0; kx < 3; kx++) {
                const double factor = scale ? (double)scale[o] : 1;
                float parts[PARTS];
                transform_taps(parts, factor * (double)tap(f, o, i, kx),
                               factor * (double)tap(f, o, i, 3 + kx),
                               factor * (double)tap(f, o, i, 6 + kx));
                float *to = packed + (size_t)(o / BLOCK) * PARTS * part_floats +
                            ((size_t)i * 3 + (size_t)kx) * BLOCK + o % BLOCK;
                for (int part = 0; part < PARTS; part++)
                    to[(size_t)part * part_floats] = parts[part];
            }
}

void ptie_winograd_pack(float *packed, const float *weights, int32_t out_channels,
                        int32_t in_channels, const float *scale) {
    pack_parts(packed, &(filters){weights, out_channels, in_channels, false}, scale);
}

void ptie_winograd_pack_adjoint(float *packed, const float *weights, int32_t out_channels,
                                int32_t in_channels) {
    pack_parts(packed, &(filters){weights, in_channels, out_channels, true}, NULL);
}

size_t ptie_winograd_scratch(int32_t out_channels, int32_t in_channels) {
    /* Six parts of a slab of 1024 pixels with 16 strips' margins at most, for every channel; then
       sums for 8 x 3 taps per part and input channel.  A tile of winograd3x3 is smaller. */
    const size_t slab = 1024 + 16 * 16;
    return PARTS * slab * ((size_t)out_channels + (size_t)in_channels) +
           PARTS * 3 * BLOCK * (size_t)in_channels;
}
