/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef PTIE_NN_ADAMW_H
#define PTIE_NN_ADAMW_H

#include "nn/nn.h"

/* One step on `count` values; first, second: the moments, 0 before step 1. */
void ptie_adamw_apply(float *values, float *first, float *second, const float *gradient,
                      size_t count, const ptie_adamw *adamw, uint64_t step);

#endif
