/* SPDX-License-Identifier: BSD-3-Clause */
/* The loss of one pair and its gradient with respect to the estimate, docs/math.md (L1)-(L4). */
#ifndef PTIE_NN_LOSS_H
#define PTIE_NN_LOSS_H

#include "kernel/kernel.h"
#include "nn/nn.h"

/* gradient (out): height x width, `scale` times the gradient of parts->loss; NULL: only measure.
   scratch: ptie_loss_scratch bytes. */
void ptie_loss_evaluate(const ptie_kernels *kernels, ptie_loss_parts *parts, float *gradient,
                        const float *estimate, const float *clean, int32_t width, int32_t height,
                        ptie_loss_weights weights, double scale, void *scratch);

#endif
