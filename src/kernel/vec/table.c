/* SPDX-License-Identifier: BSD-3-Clause */
#include "kernel/vec/vec.h"

extern const ptie_kernels VEC(kernels);
const ptie_kernels VEC(kernels) = {
#define PTIE_KERNEL(name, parameters) .name = VEC(name),
#include "kernel/kernels.inc"
#undef PTIE_KERNEL
};
