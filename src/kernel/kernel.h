/* SPDX-License-Identifier: BSD-3-Clause */
/* Micro-kernels: the inner loops of the network.  They know pointers, strides and sizes, nothing
 * else; they cannot fail.  One list, kernels.inc, drives declarations, tables and tests.
 *
 * Tensors are planes with a halo: every row is followed by at least one zero column and every plane
 * is preceded and followed by a zero row, so that a 3x3 window needs no edge cases.  Kernels store
 * to the interior only, which keeps the halo zero for ever; they may read up to PTIE_MAP_OVERREAD
 * floats past the last pixel of a row or the first pixel's left neighbour, and what they read there
 * never matters as long as it is finite.
 */
#ifndef PTIE_KERNEL_KERNEL_H
#define PTIE_KERNEL_KERNEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/cpu.h"

#define PTIE_MAP_OVERREAD 48

/* Planes of one tensor, or of a part of its channels and rows. */
typedef struct ptie_map {
    float *data;                     /* pixel (0, 0) of channel 0 */
    int32_t channels, height, width; /* (C, H, W) */
    ptrdiff_t row, plane;            /* floats from one row, one channel, to the next */
} ptie_map;

/* Layout of a fresh tensor: `data` is NULL.  Rows are multiples of 64 bytes, planes are not
   multiples of 4 KiB (they would compete for the same cache lines). */
ptie_map ptie_map_make(int32_t channels, int32_t height, int32_t width);
/* Floats of its block, halo and overread included; a zeroed block has a zero halo. */
size_t ptie_map_floats(const ptie_map *map);
/* The same map with `data` in a 64-byte aligned block. */
ptie_map ptie_map_in(ptie_map map, float *block);
ptie_map ptie_map_channels(ptie_map map, int32_t first, int32_t count);
ptie_map ptie_map_rows(ptie_map map, int32_t first, int32_t count);
/* Zeroes the halo, for memory that was something else before. */
void ptie_map_clear_halo(const ptie_map *map);
/* Copies between a map and contiguous (C, H, W). */
void ptie_map_load(const ptie_map *map, const float *image);
void ptie_map_store(float *image, const ptie_map *map);

/* Maps that will be read next.  A kernel that computes for long asks memory for them on the way, a
   little at a time, so that they wait in the second-level cache. */
typedef struct ptie_ahead {
    const ptie_map *maps;
    int32_t count;
} ptie_ahead;

/* BatchNorm of one channel, (N2) and (N3): out = max(0, scale * z + shift). */
typedef struct ptie_norm {
    float scale, shift;      /* gamma / std, beta - mean * scale */
    float mean, inverse_std; /* xhat = (z - mean) * inverse_std */
    float mean_g,
        mean_gx; /* backward: batch means of g and g * xhat, g = gradient behind the ReLU */
} ptie_norm;

/* 3x3 weights in the order the kernel reads them: (O/8, I, 3, 3, 8), zero where O is not a multiple
 * of 8. */
#define PTIE_CONV_BLOCK 8
size_t ptie_conv3x3_packed(int32_t out_channels, int32_t in_channels); /* floats */
/* weights (O, I, 3, 3); scale per output channel or NULL. */
void ptie_conv3x3_pack(float *packed, const float *weights, int32_t out_channels,
                       int32_t in_channels, const float *scale);
/* The weights of the adjoint, which maps O channels to I: transposed and turned by 180 degrees. */
void ptie_conv3x3_pack_adjoint(float *packed, const float *weights, int32_t out_channels,
                               int32_t in_channels);

/* Minimal filtering F(4,3) down the columns, docs/math.md (N9): strips of 4 output rows in 6 parts.
 * Weights (O/8, 6, I, 3, 8), otherwise as above. */
#define PTIE_WINOGRAD_ROWS 4
#define PTIE_WINOGRAD_PARTS 6
size_t ptie_winograd_packed(int32_t out_channels, int32_t in_channels); /* floats */
void ptie_winograd_pack(float *packed, const float *weights, int32_t out_channels,
                        int32_t in_channels, const float *scale);
void ptie_winograd_pack_adjoint(float *packed, const float *weights, int32_t out_channels,
                                int32_t in_channels);
/* Floats that winograd3x3 or conv3x3_weights need between these numbers of channels. */
size_t ptie_winograd_scratch(int32_t out_channels, int32_t in_channels);

#define PTIE_SSIM_WINDOW 11

/* Independent chains of multiply_add: a multiple of what every level keeps in registers at once. */
#define PTIE_CHAIN_FLOATS 192

typedef struct ptie_kernels {
#define PTIE_KERNEL(name, parameters) void(*name) parameters;
#include "kernel/kernels.inc"
#undef PTIE_KERNEL
} ptie_kernels;

/* The table of a level; NULL if this build does not have it. */
const ptie_kernels *ptie_kernels_of(ptie_cpu_level level);

#endif
