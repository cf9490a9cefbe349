/* SPDX-License-Identifier: BSD-3-Clause */
#include "nn/graph.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

static ptie_view add_tensor(ptie_graph *graph, int32_t channels, int32_t level) {
    assert(graph->tensor_count < PTIE_MAX_TENSORS);
    graph->tensors[graph->tensor_count] = (ptie_tensor){channels, level};
    return (ptie_view){graph->tensor_count++, 0, channels};
}

static ptie_view part(ptie_view tensor, int32_t first, int32_t channels) {
    return (ptie_view){tensor.tensor, first, channels};
}

static ptie_op *add_op(ptie_graph *graph, ptie_op_kind kind, ptie_view in, ptie_view out) {
    assert(graph->op_count < PTIE_MAX_OPS);
    ptie_op *op = &graph->ops[graph->op_count++];
    *op = (ptie_op){.kind = kind, .in = in, .out = out, .params = graph->param_count};
    return op;
}

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
static void add_conv(ptie_graph *graph, const char *stage, int number, ptie_view in,
                     ptie_view out) {
    static const char *const norms[] = {"weight", "bias", "running_mean", "running_var"};
    add_op(graph, PTIE_OP_CONV, in, out)->conv = graph->conv_count++;
    char name[24];
    snprintf(name, sizeof name, "conv%d.weight", number);
    add_param(graph, stage, name, true, 4, (int64_t[4]){out.channels, in.channels, 3, 3});
    for (int i = 0; i < 4; i++) {
        snprintf(name, sizeof name, "bn%d.%s", number, norms[i]);
        add_param(graph, stage, name, i < 2, 1, (int64_t[4]){out.channels, 1, 1, 1});
    }
}

static void add_stage(ptie_graph *graph, const char *stage, int32_t level, ptie_view in,
                      ptie_view out) {
    ptie_view middle = add_tensor(graph, out.channels, level);
    add_conv(graph, stage, 1, in, middle);
    add_conv(graph, stage, 2, middle, out);
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
    ptie_view joined[PTIE_MAX_LEVELS] = {{0}}; /* per level: channels from below, then the skip */
    char stage[16];

    ptie_view now = graph->input = add_tensor(graph, params->in_channels, 0);
    for (int32_t level = 0; level < bottom; level++) {
        snprintf(stage, sizeof stage, "enc%d", level + 1);
        joined[level] = add_tensor(graph, width[level + 1] + width[level], level);
        ptie_view skip = part(joined[level], width[level + 1], width[level]);
        add_stage(graph, stage, level, now, skip);
        now = add_tensor(graph, width[level], level + 1);
        add_op(graph, PTIE_OP_POOL, skip, now);
    }
    ptie_view deepest = add_tensor(graph, width[bottom], bottom);
    add_stage(graph, "bottleneck", bottom, now, deepest);
    add_op(graph, PTIE_OP_DROPOUT, deepest, deepest);
    now = deepest;
    for (int32_t level = bottom - 1; level >= 0; level--) {
        snprintf(stage, sizeof stage, "dec%d", level + 1);
        add_op(graph, PTIE_OP_UPSAMPLE, now, part(joined[level], 0, width[level + 1]));
        now = add_tensor(graph, width[level], level);
        add_stage(graph, stage, level, joined[level], now);
    }
    graph->output = add_tensor(graph, 1, 0);
    add_op(graph, PTIE_OP_HEAD, now, graph->output);
    add_param(graph, "out", "weight", true, 4, (int64_t[4]){1, now.channels, 1, 1});
    add_param(graph, "out", "bias", true, 1, (int64_t[4]){1, 1, 1, 1});
    place_params(graph);
}

const ptie_param *ptie_graph_find(const ptie_graph *graph, const char *name) {
    for (int32_t i = 0; i < graph->param_count; i++)
        if (strcmp(graph->params[i].name, name) == 0) return &graph->params[i];
    return NULL;
}

static void place_map(ptie_layout *layout, int32_t which, ptie_map map) {
    const size_t line = 16; /* floats in 64 bytes */
    layout->maps[which] = map;
    layout->offsets[which] = layout->floats;
    layout->floats += (ptie_map_floats(&map) + line - 1) / line * line;
}

void ptie_layout_tensors(ptie_layout *layout, const ptie_graph *graph, int32_t height,
                         int32_t width) {
    *layout = (ptie_layout){0};
    for (int32_t t = 0; t < graph->tensor_count; t++) {
        ptie_tensor tensor = graph->tensors[t];
        place_map(layout, t,
                  ptie_map_make(tensor.channels, height >> tensor.level, width >> tensor.level));
    }
}

void ptie_layout_convs(ptie_layout *layout, const ptie_graph *graph, int32_t height,
                       int32_t width) {
    *layout = (ptie_layout){0};
    for (int32_t i = 0; i < graph->op_count; i++) {
        const ptie_op *op = &graph->ops[i];
        if (op->kind != PTIE_OP_CONV) continue;
        int32_t level = graph->tensors[op->out.tensor].level;
        place_map(layout, op->conv,
                  ptie_map_make(op->out.channels, height >> level, width >> level));
    }
}

ptie_map ptie_layout_map(const ptie_layout *layout, float *block, int32_t which) {
    return ptie_map_in(layout->maps[which], block + layout->offsets[which]);
}

ptie_map ptie_layout_view(const ptie_layout *layout, float *block, ptie_view view) {
    return ptie_map_channels(ptie_layout_map(layout, block, view.tensor), view.first,
                             view.channels);
}
