/* SPDX-License-Identifier: BSD-3-Clause */
/* Reference twins of the kernels: written to be read, and what the vector kernels are tested
 * against. */
#ifndef PTIE_KERNEL_SCALAR_H
#define PTIE_KERNEL_SCALAR_H

#include "kernel/kernel.h"

#define PTIE_KERNEL(name, parameters) void ptie_##name##_scalar parameters;
#include "kernel/kernels.inc"
#undef PTIE_KERNEL

static inline float *row_of(const ptie_map *map, int32_t c, int32_t y) {
    return map->data + c * map->plane + y * map->row;
}

#endif
