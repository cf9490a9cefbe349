/* SPDX-License-Identifier: BSD-3-Clause */
#include "bench/network.h"

#include "nn/nn.h"

ptie_status ptie_bench_model(ptie_model **out) {
    ptie_model_params params;
    ptie_model_params_init(&params);
    return ptie_nn_create(out, &params);
}

static double op_flops(const ptie_graph *graph, const ptie_op *op, int32_t side) {
    const int32_t taps = op->kind == PTIE_OP_CONV ? 9 : op->kind == PTIE_OP_HEAD ? 1 : 0;
    const double here = side >> graph->tensors[op->out.tensor].level;
    return 2.0 * taps * op->in.channels * op->out.channels * here * here;
}

double ptie_bench_forward_flops(const ptie_graph *graph, int32_t side) {
    double flops = 0;
    for (int32_t i = 0; i < graph->op_count; i++) flops += op_flops(graph, &graph->ops[i], side);
    return flops;
}

double ptie_bench_training_flops(const ptie_graph *graph, int32_t side) {
    return 3 * ptie_bench_forward_flops(graph, side) - op_flops(graph, &graph->ops[0], side);
}
