/* SPDX-License-Identifier: BSD-3-Clause */
#include "bench/network.h"

#include "nn/nn.h"

ptie_status ptie_bench_model(ptie_model **out) {
    ptie_model_params params;
    ptie_model_params_init(&params);
    return ptie_nn_create(out, &params);
}

static double layer_flops(const ptie_layer *layer, int32_t side) {
    const double here = side >> layer->level;
    return 2.0 * 9 * layer->in_channels * layer->out_channels * here * here;
}

double ptie_bench_forward_flops(const ptie_graph *graph, int32_t side) {
    double flops = 2.0 * (double)graph->params[graph->head].count * side * side;
    for (int32_t k = 0; k < graph->layer_count; k++) flops += layer_flops(&graph->layers[k], side);
    return flops;
}

double ptie_bench_training_flops(const ptie_graph *graph, int32_t side) {
    return 3 * ptie_bench_forward_flops(graph, side) - layer_flops(&graph->layers[0], side);
}
