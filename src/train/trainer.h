/* SPDX-License-Identifier: BSD-3-Clause */
/* A training run under way, shared by the loop and the checkpoint. */
#ifndef PTIE_TRAIN_TRAINER_H
#define PTIE_TRAIN_TRAINER_H

#include "base/text.h"
#include "train/train.h"

typedef struct ptie_trainer {
    /* What the caller gave. */
    const ptie_engine *engine;
    ptie_model *model;
    const ptie_dataset *dataset;
    const char *path;
    const ptie_train_params *params;
    ptie_progress progress;

    /* Where the run stands; a checkpoint holds this, the model and the optimiser's moments. */
    uint64_t step;      /* finished optimiser steps */
    ptie_epoch *epochs; /* rows of finished epochs; params->epochs of them fit */
    size_t epoch_count;
    ptie_scores sums; /* of the epoch under way */
    double seconds;   /* spent on it */

    /* What follows from the above, and buffers. */
    ptie_stepper *stepper;
    ptie_text last_path, settings;
    uint64_t steps_per_epoch;
    uint32_t train_count;
    uint32_t *order;        /* samples of the epoch under way */
    size_t ordered_epoch;   /* epoch that `order` and what is loaded belong to; SIZE_MAX at first */
    uint64_t loading;       /* place in `order` of the batch that is being loaded */
    ptie_loss_parts *parts; /* one per sample of a batch */
    unsigned char *scratch; /* one part per worker */
    size_t scratch_bytes;
    double started_s; /* of this call, on a clock that only goes forward */
} ptie_trainer;

/* Fills last_path, and settings: everything that must agree between a run and its continuation, one
   "key = value" per line.  Notes generator and kernels in the model. */
ptie_status ptie_checkpoint_describe(ptie_trainer *trainer);
/* Writes <path>.last: model, moments (opt.m.*, opt.v.*), position. */
ptie_status ptie_checkpoint_save(const ptie_trainer *trainer);
/* Sets model, moments and position from <path>.last.  PTIE_EFORMAT when it is damaged, PTIE_EINVAL
   when it belongs to a run with other settings; the trainer is then not to be used. */
ptie_status ptie_checkpoint_restore(ptie_trainer *trainer);

#endif
