/* SPDX-License-Identifier: BSD-3-Clause */
/* Training and evaluation of a model.  Paper sections 3.2-3.5 and 4.1-4.2, docs/math.md (L1)-(L6). */
#ifndef PTIE_TRAIN_H
#define PTIE_TRAIN_H

#include <ptie/dataset.h>
#include <ptie/model.h>

typedef struct ptie_train_params {
    uint32_t struct_size;     /* set by ptie_train_params_init */
    int32_t epochs;           /* >= 1, default 20 */
    int32_t batch;            /* 1..1024, default 32 */
    double learning_rate;     /* > 0, default 3e-4 */
    double warmup_epochs;     /* linear warm-up multiplied into the cosine, >= 0, default 1 */
    double weight_decay;      /* AdamW, >= 0, default 0.004 (Keras) */
    double beta1, beta2;      /* default 0.9, 0.999 */
    double epsilon;           /* default 1e-7 (Keras) */
    double w_l1, w_ssim, w_mse; /* weights of the loss, default 0.5, 0.4, 0.1 */
    int32_t patience;         /* epochs without a better validation loss before stopping; 0 = never; default 5 */
    uint64_t seed;            /* order of samples and dropout */
    double time_limit_s;      /* stop cleanly after the step that passes it; 0 = none */
    uint64_t steps_limit;     /* stop after so many optimiser steps in all; 0 = none */
    int32_t checkpoint_steps; /* also write `last` every so many steps; 0 = per epoch only */
    bool overwrite;           /* replace an existing model */
    bool resume;              /* go on from <path>.last; exact to the bit on the same kernel level (ptie_ctx_cpu) */
} ptie_train_params;

PTIE_API void ptie_train_params_init(ptie_train_params *params);

typedef struct ptie_scores {
    double loss, psnr_db, mae, ssim; /* means over samples of each sample's score; PSNR with MAX = 1 */
    uint64_t samples;
} ptie_scores;

/* Trains `model` (in place) and writes
     <path>               best model by validation loss (safetensors)
     <path>.last          complete state for resume
     <path>.history.csv and .history.json   one row per epoch
   all atomically.  Afterwards `model` holds the last step's weights; load `path` for the best.
   progress: one unit per training sample, reported after each step with a note.
   The same bits for any number of threads, and 20 steps = 10 + resume + 10.
   On PTIE_ECANCELLED and at a limit `<path>.last` holds the last finished step; an epoch whose last step
   is done is validated before a limit stops the run.
   The model's note "ptie.kernels" lists the kernel levels the run used: more than one means that it was
   resumed on another, and is what it would have been but for rounding.
   Resuming takes the parameters of the run that is continued, except patience, limits and
   checkpoint_steps, which may change.
   Errors: PTIE_EINVAL (also resume with other parameters or data), PTIE_ESIZE (data and model),
   PTIE_EEXIST, PTIE_EIO, PTIE_EFORMAT (resume), PTIE_ENUMERIC (loss not finite), PTIE_ENOMEM,
   PTIE_ECANCELLED. */
PTIE_API PTIE_NODISCARD ptie_status ptie_train(ptie_ctx *ctx, ptie_model *model,
                                               const ptie_dataset *dataset, const char *path,
                                               const ptie_train_params *params,
                                               ptie_progress progress);

/* Scores a split: `noisy` for the input itself, `denoised` for the model's output.  model NULL: only
   `noisy` is filled; either may be NULL.  Uses the loss weights of `params` (NULL: defaults).
   progress: one unit per sample.
   Errors: PTIE_EINVAL (also an empty split), PTIE_ESIZE (maps below 11 x 11; a model with other inputs),
   PTIE_EIO, PTIE_ENOMEM, PTIE_ECANCELLED. */
PTIE_API PTIE_NODISCARD ptie_status ptie_evaluate(ptie_ctx *ctx, const ptie_model *model,
                                                  const ptie_dataset *dataset, ptie_split split,
                                                  const ptie_train_params *params, ptie_scores *noisy,
                                                  ptie_scores *denoised, ptie_progress progress);

/* One epoch of a history file.  `train` are means over the epoch as it went: with dropout, and with weights that
   changed meanwhile (as Keras reports them). */
typedef struct ptie_epoch {
    int32_t epoch; /* from 1 */
    double learning_rate, seconds; /* of the epoch's last step; validation included */
    ptie_scores train, validation;
} ptie_epoch;

/* Reads <path>.history.csv, `path` being the model's.  Free *epochs with ptie_history_free.
   Errors: PTIE_EIO, PTIE_EFORMAT (line), PTIE_ENOMEM. */
PTIE_API PTIE_NODISCARD ptie_status ptie_history_read(ptie_epoch **epochs, size_t *count,
                                                      const char *path);
PTIE_API void ptie_history_free(ptie_epoch *epochs);

#endif
