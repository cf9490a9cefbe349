/* SPDX-License-Identifier: BSD-3-Clause */
/* The paper's network as what is measured, on its frames of 256 x 256. */
#ifndef PTIE_BENCH_NETWORK_H
#define PTIE_BENCH_NETWORK_H

#include "nn/graph.h"

enum { PTIE_BENCH_SIDE = 256, PTIE_BENCH_BATCH = 32 };

/* With fresh weights: how fast it is does not depend on them. */
ptie_status ptie_bench_model(ptie_model **out);

/* Operations of the convolutions on a frame of side x side, forward; a multiply-add counts as two.
   Everything else is below 2 % of them. */
double ptie_bench_forward_flops(const ptie_graph *graph, int32_t side);
/* Forward, and both gradients but that of the image. */
double ptie_bench_training_flops(const ptie_graph *graph, int32_t side);

#endif
