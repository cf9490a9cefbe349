/* SPDX-License-Identifier: BSD-3-Clause */
/* What a stepper is inside, and the two directions through the network.
 *
 * BatchNorm needs the whole batch, everything else one sample.  So the walk is cut into sections,
 * one per layer and one for the head and the loss: within a section the samples run in parallel,
 * between two sections their sums are combined in the order of the samples.
 *
 * Per sample only two maps of each layer are kept: z, the convolution before its BatchNorm, and the
 * gradient behind its ReLU.  What a layer reads is made again from z, band by band of rows, in
 * memory that stays in the cache: reading a map costs more than normalising it again.
 */
#ifndef PTIE_NN_STEPPER_H
#define PTIE_NN_STEPPER_H

#include "nn/model.h"

typedef struct ptie_sample_state {
    float *noisy[2], *clean[2]; /* contiguous (I, H, W) and (H, W): this batch's, the next one's */
    float *z, *gradients;       /* blocks of the layouts of these names */
    float *coarse;              /* block of the layout `coarse` */
    float *slope;               /* (H, W): gradient of the head's sum */
    double *sums;               /* (C, 2) of the layer that ends the section */
    double *weights;            /* gradient of the weights of the section's layer or head */
} ptie_sample_state;

/* Memory of one worker. */
typedef struct ptie_workspace {
    float *input, *z_grad, *in_grad, *finer; /* blocks of the layouts of bands */
    float *scratch;                          /* of the convolutions */
    float *estimate;                         /* (H, W): the output */
    void *loss;
} ptie_workspace;

struct ptie_stepper {
    const ptie_engine *engine;
    ptie_model *model;
    ptie_loss_weights loss;
    int32_t batch, height, width;
    ptie_nn_layout z;         /* output channels */
    ptie_nn_layout gradients; /* the same, but the last layer's are made when needed */
    ptie_nn_layout coarse;    /* what a join reads of the layer before it, before it is upsampled */
    /* Bands: what a layer reads and the gradient of its z, with a row more above and below; the
       gradient of what it reads; what a pool reads. */
    ptie_nn_layout input, z_grad, in_grad, finer;
    int32_t rows[PTIE_MAX_LAYERS];          /* of a band, without those two */
    float *packed[PTIE_MAX_LAYERS];         /* weights in the kernels' order, forward ... */
    float *packed_adjoint[PTIE_MAX_LAYERS]; /* ... and backward */
    ptie_norm *norms[PTIE_MAX_LAYERS];
    ptie_sample_state *samples; /* batch */
    ptie_workspace *workspaces; /* threads */
    float *state[3];            /* gradient, first and second moment, as the model's values */
    double *total;              /* where samples' sums are combined */
    size_t total_count, most_channels;
    void *block;

    /* The step under way: samples, dropout's stream, where the losses go, the section. */
    int32_t count;
    uint64_t seed, step;
    ptie_loss_parts *parts;
    int32_t section;
    ptie_task task; /* of the section */
    ptie_aside aside;
};

/* A band of a layer: the rows first .. first + rows - 1 of its level. */
typedef struct ptie_band {
    int32_t layer, first, rows;
    ptie_sample_state *sample;
    const ptie_workspace *workspace;
} ptie_band;

/* The first band, and the one after; `rows` is 0 behind the last. */
ptie_band ptie_band_first(const ptie_stepper *stepper, int32_t layer, size_t sample,
                          int32_t worker);
void ptie_band_next(const ptie_stepper *stepper, ptie_band *band);

/* Views of a layer's whole z or gradient, and of some rows. */
ptie_map ptie_z_rows(const ptie_stepper *stepper, const ptie_sample_state *sample, int32_t layer,
                     int32_t first, int32_t rows);
ptie_map ptie_gradient_rows(const ptie_stepper *stepper, const ptie_sample_state *sample,
                            int32_t layer, int32_t first, int32_t rows);

/* What the band's layer reads; the rows above and below it are there too (0 beyond the image). */
ptie_map ptie_band_input(const ptie_stepper *stepper, const ptie_band *band);
/* What the band after this one is made of: z of what it reads, or its own z and gradient.  Nothing
   behind the last one. */
typedef struct ptie_next {
    ptie_map maps[2];
    ptie_ahead ahead;
} ptie_next;
const ptie_ahead *ptie_next_input(const ptie_stepper *stepper, ptie_band band, ptie_next *next);
const ptie_ahead *ptie_next_gradient(const ptie_stepper *stepper, ptie_band band, ptie_next *next);
/* What a pool read of the layer before, rows 2 first .. of it; after ptie_band_input. */
ptie_map ptie_band_finer(const ptie_stepper *stepper, const ptie_band *band);

/* Rows of a band as `padded` holds them, one above and one below, clipped to the image. */
typedef struct ptie_clip {
    ptie_map map;  /* the rows inside the image */
    int32_t first; /* of them */
} ptie_clip;
/* Zeroes the rows outside. */
ptie_clip ptie_clip_band(const ptie_map *padded, int32_t first, int32_t height);

/* Multiplies a map by the step's mask of this sample (N7). */
void ptie_dropout(const ptie_stepper *stepper, const ptie_map *map, size_t sample);

/* Sections of one sample (pool tasks; context is the stepper), and what joins the samples. */
ptie_status ptie_forward_layer(void *context, size_t sample, int32_t worker);
void ptie_forward_join(ptie_stepper *stepper);
ptie_status ptie_head(void *context, size_t sample, int32_t worker); /* forward, loss, backward */
/* Gradient behind the last layer's ReLU, rows first .., from the sample's slope: cheaper to make
   again than to keep. */
void ptie_head_gradient(const ptie_stepper *stepper, const ptie_sample_state *sample,
                        const ptie_map *grad, int32_t first);
void ptie_head_join(ptie_stepper *stepper);
ptie_status ptie_backward_layer(void *context, size_t sample, int32_t worker);
void ptie_backward_join(ptie_stepper *stepper);

#endif
