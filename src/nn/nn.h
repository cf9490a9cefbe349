/* SPDX-License-Identifier: BSD-3-Clause */
/* The network inside the library: models, the training step, and inference.  Contracts of the
 * public functions as in <ptie/model.h>; arguments already checked.  docs/math.md (N*) and (L*).
 */
#ifndef PTIE_NN_NN_H
#define PTIE_NN_NN_H

#include <ptie/model.h>

#include "io/safetensors.h"
#include "kernel/engine.h"

/* Fails with `status` if a parameter is outside its documented range. */
ptie_status ptie_nn_check(const ptie_model_params *params, ptie_status status, const char *where);
ptie_status ptie_nn_create(ptie_model **out, const ptie_model_params *params);
void ptie_nn_free(ptie_model *model);
ptie_status ptie_nn_load(ptie_model **out, const char *path);
/* The same from an open file (a checkpoint holds a model and more). */
ptie_status ptie_nn_from_safetensors(ptie_model **out, const ptie_safetensors *file,
                                     const char *where);
ptie_status ptie_nn_save(const ptie_model *model, const char *path, bool overwrite);
/* Tensors and notes a model file holds; both arrays are freed with ptie_free, contents belong to
 * the model. */
ptie_status ptie_nn_tensors(const ptie_model *model, ptie_tensor_view **tensors,
                            size_t *tensor_count, ptie_note **notes, size_t *note_count);
/* Copies all tensors (trainable and running statistics) from one model to another of the same
 * shape. */
void ptie_nn_copy(ptie_model *to, const ptie_model *from);
const char *ptie_nn_note(const ptie_model *model, const char *key); /* NULL if it is not there */
/* PTIE_EINVAL for a key that describes the network itself. */
ptie_status ptie_nn_set_note(ptie_model *model, const char *key, const char *value);

/* Weights of the loss (paper Eq. 6). */
typedef struct ptie_loss_weights {
    double l1, ssim, mse;
} ptie_loss_weights;

typedef struct ptie_loss_parts {
    double loss, l1, ssim, wmse,
        mse; /* one sample's: total, mean |d|, SSIM itself, Eq. 9, mean d^2 */
} ptie_loss_parts;

typedef struct ptie_adamw {
    double learning_rate, beta1, beta2, epsilon, weight_decay;
} ptie_adamw;

/* Everything one training run needs: gradients, optimiser state, activations of one batch. */
typedef struct ptie_stepper ptie_stepper;

/* Width and height must be multiples of 2^(levels-1) and at least 11.  Keeps pointers to engine and
   model. The step allocates nothing. */
ptie_status ptie_stepper_create(ptie_stepper **out, const ptie_engine *engine, ptie_model *model,
                                int32_t batch, int32_t width, int32_t height,
                                ptie_loss_weights weights);
void ptie_stepper_free(ptie_stepper *stepper);

/* Where the caller puts sample `i`: of the batch that the next step takes or, `ahead`, of the one
   after it.  noisy: in_channels x height x width, clean: height x width. */
float *ptie_stepper_noisy(ptie_stepper *stepper, int32_t i, bool ahead);
float *ptie_stepper_clean(ptie_stepper *stepper, int32_t i, bool ahead);
/* What was put ahead becomes the batch of the next step. */
void ptie_stepper_advance(ptie_stepper *stepper);

/* Work of the caller's that shares the pool with a step, such as loading the next batch. */
typedef struct ptie_aside {
    ptie_task task;
    void *context;
    size_t count; /* of tasks */
} ptie_aside;

/* Forward in training mode, loss, backward over the first `count` samples.  Gradients are those of
   the mean loss over the batch.  Dropout draws from (seed, PTIE_STREAM_DROPOUT, step).  parts: one
   per sample.  aside: NULL for none; its failure is the step's. */
ptie_status ptie_stepper_gradients(ptie_stepper *stepper, int32_t count, uint64_t seed,
                                   uint64_t step, ptie_loss_parts *parts, const ptie_aside *aside);
/* AdamW with decoupled decay on every trainable tensor; `step` counts from 1. */
void ptie_stepper_update(ptie_stepper *stepper, const ptie_adamw *adamw, uint64_t step);
/* Gradient, first or second moment of a trainable tensor by PyTorch name (which: 0, 1, 2); NULL if
 * none. */
float *ptie_stepper_state(ptie_stepper *stepper, int which, const char *name, size_t *count);

/* Inference plan; contract as ptie_denoiser_create and ptie_denoiser_run. */
ptie_status ptie_nn_denoiser(ptie_denoiser **out, const ptie_engine *engine,
                             const ptie_model *model, int32_t width, int32_t height,
                             const ptie_denoiser_params *params); /* NULL: the defaults */
void ptie_nn_denoiser_free(ptie_denoiser *denoiser);
size_t ptie_nn_denoiser_scratch(const ptie_denoiser *denoiser);
ptie_status ptie_nn_denoise(const ptie_denoiser *denoiser, float *clean, const float *noisy,
                            void *scratch);
ptie_status ptie_nn_denoise_rad(const ptie_denoiser *denoiser, float *clean_rad,
                                const float *noisy_rad, int32_t polarity, void *scratch);

/* Loss of one pair outside training (evaluation).  scratch: ptie_loss_scratch bytes. */
size_t ptie_loss_scratch(int32_t width, int32_t height);
void ptie_loss_measure(const ptie_engine *engine, ptie_loss_parts *parts, const float *estimate,
                       const float *clean, int32_t width, int32_t height, ptie_loss_weights weights,
                       void *scratch);

#endif
