/* SPDX-License-Identifier: BSD-3-Clause */
/* The network as data.  One list of operations, made from the parameters of the family, is what
 * forward, backward, inference, parameter names and files all walk along.
 *
 *     enc1 ──────────────────────────────── skip ─┐
 *       └ pool ─ enc2 ───────────── skip ─┐       │
 *                  └ pool ─ bottleneck    │       │
 *                              └ up ─ dec2 └ up ─ dec1 ─ out
 *
 * A concatenation is not an operation: up and skip write to neighbouring channels of one tensor.
 */
#ifndef PTIE_NN_GRAPH_H
#define PTIE_NN_GRAPH_H

#include <ptie/model.h>

#include "kernel/kernel.h"

enum {
    PTIE_MAX_CONVS = 2 * (2 * PTIE_MAX_LEVELS - 1),
    PTIE_MAX_OPS = PTIE_MAX_CONVS + 2 * (PTIE_MAX_LEVELS - 1) + 2, /* pools, ups; dropout, head */
    PTIE_MAX_TENSORS = PTIE_MAX_OPS,
    PTIE_MAX_PARAMS = 5 * PTIE_MAX_CONVS + 2
};

typedef enum ptie_op_kind {
    PTIE_OP_CONV,     /* 3x3, BatchNorm, ReLU */
    PTIE_OP_POOL,     /* 2x2 maximum */
    PTIE_OP_UPSAMPLE, /* bilinear x2 */
    PTIE_OP_DROPOUT,  /* in place; nothing at inference */
    PTIE_OP_HEAD      /* 1x1, then the output function */
} ptie_op_kind;

/* Channels first .. first + channels - 1 of a tensor. */
typedef struct ptie_view {
    int32_t tensor, first, channels;
} ptie_view;

/* Parameters of an operation, counted from ptie_op.params. */
enum {
    PTIE_WEIGHT = 0,
    PTIE_GAMMA = 1,
    PTIE_BETA = 2,
    PTIE_MEAN = 3,
    PTIE_VARIANCE = 4, /* CONV */
    PTIE_BIAS = 1      /* HEAD */
};

typedef struct ptie_op {
    ptie_op_kind kind;
    ptie_view in, out;
    int32_t params; /* CONV, HEAD: index of the first parameter */
    int32_t conv;   /* CONV: which one, from 0 */
} ptie_op;

typedef struct ptie_tensor {
    int32_t channels, level; /* level l has 1/2^l of the image's size */
} ptie_tensor;

typedef struct ptie_param {
    char name[40]; /* as in PyTorch */
    int32_t rank;
    int64_t shape[4];
    size_t offset, count; /* in the model's values */
    bool trainable;       /* false: running statistics */
} ptie_param;

typedef struct ptie_graph {
    ptie_op ops[PTIE_MAX_OPS];
    ptie_tensor tensors[PTIE_MAX_TENSORS];
    ptie_param params[PTIE_MAX_PARAMS];
    int32_t op_count, tensor_count, param_count, conv_count;
    ptie_view input, output;
    size_t trainable, values; /* floats; trainable ones come first */
} ptie_graph;

void ptie_graph_build(ptie_graph *graph, const ptie_model_params *params);

/* NULL if there is no parameter of that name. */
const ptie_param *ptie_graph_find(const ptie_graph *graph, const char *name);

/* Where the tensors of one image lie in a block of floats. */
typedef struct ptie_layout {
    ptie_map maps[PTIE_MAX_TENSORS]; /* without data */
    size_t offsets[PTIE_MAX_TENSORS];
    size_t floats;
} ptie_layout;

/* One place for every tensor of the graph. */
void ptie_layout_tensors(ptie_layout *layout, const ptie_graph *graph, int32_t height,
                         int32_t width);
/* One place for the result of every convolution before its normalisation. */
void ptie_layout_convs(ptie_layout *layout, const ptie_graph *graph, int32_t height, int32_t width);

/* A tensor (or convolution) of a layout, and a view of a tensor, in a block. */
ptie_map ptie_layout_map(const ptie_layout *layout, float *block, int32_t which);
ptie_map ptie_layout_view(const ptie_layout *layout, float *block, ptie_view view);

#endif
