/* SPDX-License-Identifier: BSD-3-Clause */
#include "kernel/scalar/scalar.h"

extern const ptie_kernels ptie_kernels_scalar;
const ptie_kernels ptie_kernels_scalar = {
#define PTIE_KERNEL(name, parameters) .name = ptie_##name##_scalar,
#include "kernel/kernels.inc"
#undef PTIE_KERNEL
};
