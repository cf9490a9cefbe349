/* SPDX-License-Identifier: BSD-3-Clause */
/* The network as data: a chain of 3x3 convolutions, each with its BatchNorm and ReLU, and what each
 * of them reads.  Forward, backward, inference, parameter names and files all walk along it.
 *
 *     enc1 ──────────────────────────────── skip ─┐
 *       └ pool ─ enc2 ───────────── skip ─┐       │
 *                  └ pool ─ bottleneck    │       │
 *                              └ up ─ dec2 └ up ─ dec1 ─ head
 */
#ifndef PTIE_NN_GRAPH_H
#define PTIE_NN_GRAPH_H

#include <ptie/model.h>

#include "kernel/kernel.h"

enum { PTIE_MAX_LAYERS = 2 * (2 * PTIE_MAX_LEVELS - 1), PTIE_MAX_PARAMS = 5 * PTIE_MAX_LAYERS + 2 };

/* What a layer reads: something of the layer before it, and at a join a skip too. */
typedef enum ptie_input {
    PTIE_INPUT_IMAGE, /* the network's input; the first layer only */
    PTIE_INPUT_SAME,  /* the layer before, as it is */
    PTIE_INPUT_POOL,  /* its 2x2 maximum (N4) */
    PTIE_INPUT_JOIN   /* its channels upsampled (N5), then those of the skip */
} ptie_input;

/* Parameters of a layer or of the head, counted from `params`. */
enum {
    PTIE_WEIGHT = 0,
    PTIE_GAMMA = 1,
    PTIE_BETA = 2,
    PTIE_MEAN = 3,
    PTIE_VARIANCE = 4,
    PTIE_BIAS = 1 /* the head */
};

typedef struct ptie_layer {
    int32_t level; /* 1/2^level of the image's size */
    int32_t in_channels, out_channels;
    ptie_input input;
    int32_t skip;   /* JOIN: the layer of the same level that is joined */
    bool dropout;   /* while training, on what the layer before hands over (N7) */
    int32_t params; /* index of the first parameter */
} ptie_layer;

typedef struct ptie_param {
    char name[40]; /* as in PyTorch */
    int32_t rank;
    int64_t shape[4];
    size_t offset, count; /* in the model's values */
    bool trainable;       /* false: running statistics */
} ptie_param;

typedef struct ptie_graph {
    ptie_layer layers[PTIE_MAX_LAYERS];
    ptie_param params[PTIE_MAX_PARAMS];
    int32_t layer_count, param_count;
    int32_t head;             /* index of the head's first parameter: 1x1, reads the last layer */
    size_t trainable, values; /* floats; trainable ones come first */
} ptie_graph;

void ptie_graph_build(ptie_graph *graph, const ptie_model_params *params);

/* NULL if there is no parameter of that name. */
const ptie_param *ptie_graph_find(const ptie_graph *graph, const char *name);

/* Places of maps, one per layer, in a block of floats. */
typedef struct ptie_nn_layout {
    ptie_map maps[PTIE_MAX_LAYERS]; /* without data */
    size_t offsets[PTIE_MAX_LAYERS];
    size_t floats;
} ptie_nn_layout;

/* Gives layer `which` a map; without channels it takes no room. */
void ptie_nn_layout_add(ptie_nn_layout *layout, int32_t which, int32_t channels, int32_t height,
                     int32_t width);
ptie_map ptie_nn_layout_map(const ptie_nn_layout *layout, float *block, int32_t which);

#endif
