/* SPDX-License-Identifier: BSD-3-Clause */
/* What a stepper is inside, and the two directions through the network.
 *
 * BatchNorm needs the whole batch, everything else one sample.  So the walk is cut into sections:
 * section k is what lies between the normalisation of convolution k-1 and that of convolution k.
 * Within a section the samples run in parallel; between two sections their sums are combined in the
 * order of the samples.
 */
#ifndef PTIE_NN_STEPPER_H
#define PTIE_NN_STEPPER_H

#include "nn/model.h"

/* Rows handled together, so that what one kernel writes is still in the cache when the next one
   reads it; also the block of sums in the gradient of the weights. */
#define PTIE_BAND_ROWS 16

typedef struct ptie_sample_state {
    float *noisy, *clean; /* contiguous (I, H, W) and (H, W): the caller's */
    float *tensors,
        *convs;       /* blocks of the layouts: outputs, and convolutions before their BatchNorm */
    float *gradients; /* block of the tensors' layout */
    double *sums;     /* (C, 2) of the convolution that ends the section */
    double *weights;  /* gradient of the weights of the section's convolution or head */
} ptie_sample_state;

struct ptie_stepper {
    const ptie_engine *engine;
    ptie_model *model;
    ptie_loss_weights loss;
    int32_t batch, height, width;
    ptie_layout tensors, convs;
    int32_t conv_ops[PTIE_MAX_CONVS];      /* index of each convolution's operation */
    float *packed[PTIE_MAX_CONVS];         /* weights in the kernels' order, forward ... */
    float *packed_adjoint[PTIE_MAX_CONVS]; /* ... and backward */
    ptie_norm *norms[PTIE_MAX_CONVS];
    ptie_sample_state *samples; /* batch */
    float *state[3];            /* gradient, first and second moment, as the model's values */
    double *total;              /* where samples' sums are combined */
    size_t total_count;
    float **images;      /* per worker: estimate, gradient of the loss */
    void **loss_scratch; /* per worker */
    void *block;

    int32_t
        count; /* the step under way: samples, dropout's stream, where the losses go, the section */
    uint64_t seed, step;
    ptie_loss_parts *parts;
    int32_t section;
};

static inline const ptie_op *ptie_stepper_conv(const ptie_stepper *stepper, int32_t conv) {
    return &stepper->model->graph.ops[stepper->conv_ops[conv]];
}

/* Operations first .. last - 1 are those of a section that belong to no convolution. */
static inline int32_t ptie_section_first(const ptie_stepper *stepper, int32_t section) {
    return section == 0 ? 0 : stepper->conv_ops[section - 1] + 1;
}
static inline int32_t ptie_section_last(const ptie_stepper *stepper, int32_t section) {
    const ptie_graph *graph = &stepper->model->graph;
    return section == graph->conv_count ? graph->op_count : stepper->conv_ops[section];
}

/* One section of one sample (pool tasks; context is the stepper), and what joins the samples after
 * it. */
ptie_status ptie_forward_section(void *context, size_t sample, int32_t worker);
void ptie_forward_join(ptie_stepper *stepper);
ptie_status ptie_backward_section(void *context, size_t sample, int32_t worker);
void ptie_backward_join(ptie_stepper *stepper);

/* Multiplies a map by the step's dropout mask of this sample (N7); the same forward and backward.
 */
void ptie_dropout(const ptie_stepper *stepper, const ptie_map *map, size_t sample);

#endif
