/* SPDX-License-Identifier: BSD-3-Clause */
#include "nn/graph.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

static void add_param(ptie_graph *graph, const char *stage, const char *name, bool trainable,
                      int32_t rank, const int64_t shape[4]) {
    assert(graph->param_count < PTIE_MAX_PARAMS);
    ptie_param *param = &graph->params[graph->param_count++];
    snprintf(param->name, sizeof param->name, "%s.%s", stage, name);
    param->rank = rank;
    param->trainable = trainable;
    param->count = 1;
    for (int i = 0; i < 4; i++) {
        param->shape[i] = shape[i];
        param->count *= (size_t)shape[i];
    }
}

/* `number` 1 or 2: which of the two convolutions of its stage. */
static void add_layer(ptie_graph *graph, const char *stage, int number, ptie_layer layer) {
    static const char *const norms[] = {"weight", "bias", "running_mean", "running_var"};
    assert(graph->layer_count < PTIE_MAX_LAYERS);
    ptie_layer *added = &graph->layers[graph->layer_count++];
    *added = layer;
    added->params = graph->param_count;
    char name[24];
    snprintf(name, sizeof name, "conv%d.weight", number);
    add_param(graph, stage, name, true, 4,
              (int64_t[4]){layer.out_channels, layer.in_channels, 3, 3});
    for (int i = 0; i < 4; i++) {
        snprintf(name, sizeof name, "bn%d.%s", number, norms[i]);
        add_param(graph, stage, name, i < 2, 1, (int64_t[4]){layer.out_channels, 1, 1, 1});
    }
}

/* Two convolutions; `first` says what the first one reads. */
static void add_stage(ptie_graph *graph, const char *stage, ptie_layer first) {
    ptie_layer second = {.level = first.level,
                         .in_channels = first.out_channels,
                         .out_channels = first.out_channels,
                         .input = PTIE_INPUT_SAME};
    add_layer(graph, stage, 1, first);
    add_layer(graph, stage, 2, second);
}

static void place_params(ptie_graph *graph) {
    for (int pass = 0; pass < 2; pass++) { /* trainable ones first */
        for (int32_t i = 0; i < graph->param_count; i++) {
            if (graph->params[i].trainable != (pass == 0)) continue;
            graph->params[i].offset = graph->values;
            graph->values += graph->params[i].count;
        }
        if (pass == 0) graph->trainable = graph->values;
    }
}

void ptie_graph_build(ptie_graph *graph, const ptie_model_params *params) {
    *graph = (ptie_graph){0};
    const int32_t bottom = params->levels - 1, *width = params->width;
    char stage[16];
    for (int32_t level = 0; level <= bottom; level++) {
        snprintf(stage, sizeof stage, "enc%d", level + 1);
        add_stage(graph, level < bottom ? stage : "bottleneck",
                  (ptie_layer){.level = level,
                               .in_channels = level ? width[level - 1] : params->in_channels,
                               .out_channels = width[level],
                               .input = level ? PTIE_INPUT_POOL : PTIE_INPUT_IMAGE});
    }
    for (int32_t level = bottom - 1; level >= 0; level--) {
        snprintf(stage, sizeof stage, "dec%d", level + 1);
        add_stage(graph, stage,
                  (ptie_layer){.level = level,
                               .in_channels = width[level + 1] + width[level],
                               .out_channels = width[level],
                               .input = PTIE_INPUT_JOIN,
                               .skip = 2 * level + 1, /* the second convolution of its encoder */
                               .dropout = level == bottom - 1});
    }
    graph->head = graph->param_count;
    add_param(graph, "out", "weight", true, 4, (int64_t[4]){1, width[0], 1, 1});
    add_param(graph, "out", "bias", true, 1, (int64_t[4]){1, 1, 1, 1});
    place_params(graph);
}

const ptie_param *ptie_graph_find(const ptie_graph *graph, const char *name) {
    for (int32_t i = 0; i < graph->param_count; i++)
        if (strcmp(graph->params[i].name, name) == 0) return &graph->params[i];
    return NULL;
}

void ptie_nn_layout_add(ptie_nn_layout *layout, int32_t which, int32_t channels, int32_t height,
                     int32_t width) {
    const size_t line = 16; /* floats in 64 bytes */
    const ptie_map map = ptie_map_make(channels, height, width);
    layout->maps[which] = map;
    layout->offsets[which] = layout->floats;
    if (channels > 0) layout->floats += (ptie_map_floats(&map) + line - 1) / line * line;
}

ptie_map ptie_nn_layout_map(const ptie_nn_layout *layout, float *block, int32_t which) {
    return ptie_map_in(layout->maps[which], block + layout->offsets[which]);
}
