/* SPDX-License-Identifier: BSD-3-Clause */
/* Kernels in half precision (IEEE 754 binary16: 11 significant bits, up to 65504), for inference
 * where the processor computes with halves: twice the pixels per register.
 *
 * A map of halves is a ptie_map in the same kind of memory: `data` points to a half, `width` counts
 * pixels, but `row` and `plane` still count floats, two halves each.  What lies around the pixels
 * is as in kernel/kernel.h.  Nothing is ever infinite: what is too large becomes the largest half.
 */
#ifndef PTIE_KERNEL_HALF_H
#define PTIE_KERNEL_HALF_H

#include "kernel/kernel.h"

typedef uint16_t __attribute__((may_alias)) ptie_half; /* its bits */

/* The nearest half, ties to even. */
ptie_half ptie_half_from(float value);
float ptie_half_to(ptie_half value);

/* ptie_map_make for halves. */
ptie_map ptie_half_map_make(int32_t channels, int32_t height, int32_t width);

/* Makes each of the weights packed by ptie_conv3x3_pack a pair of equal halves, in its place: a
   register is filled from 32 bits without an instruction that competes with the arithmetic. */
void ptie_half_pairs(float *packed, size_t count);

typedef struct ptie_half_kernels {
#define PTIE_KERNEL(name, parameters) void(*name) parameters;
#include "kernel/half_kernels.inc"
#undef PTIE_KERNEL
} ptie_half_kernels;

extern const ptie_half_kernels ptie_half_kernels_scalar; /* twins for tests, slow */

/* Those that go with a level; NULL if it, this processor or this build computes with single
   precision only. */
const ptie_half_kernels *ptie_half_kernels_of(ptie_cpu_level level);

#endif
