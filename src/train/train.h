/* SPDX-License-Identifier: BSD-3-Clause */
/* Training and evaluation; contracts as in <ptie/train.h>, arguments already checked.
 *
 * Where a run stands is three things: the number of finished optimiser steps, the rows of the
 * finished epochs, and the sums of the epoch under way.  Everything else (epoch, learning rate,
 * order of samples, dropout, best epoch) is a function of them, which is what makes resuming exact.
 */
#ifndef PTIE_TRAIN_TRAIN_H
#define PTIE_TRAIN_TRAIN_H

#include <ptie/train.h>

#include "nn/nn.h"
#include "train/dataset.h"

ptie_status ptie_train_run(const ptie_engine *engine, ptie_model *model,
                           const ptie_dataset *dataset, const char *path,
                           const ptie_train_params *params, ptie_progress progress);

/* ptie_evaluate.  noisy, denoised: NULL when not wanted; model NULL: `denoised` is left alone. */
ptie_status ptie_score_split(const ptie_engine *engine, const ptie_model *model,
                             const ptie_dataset *dataset, ptie_split split,
                             ptie_loss_weights weights, ptie_scores *noisy, ptie_scores *denoised,
                             ptie_progress progress);

#define PTIE_SSIM_WINDOW 11 /* smallest side of a map that has an SSIM */

/* Sums of per-sample scores, in index order; ptie_mean_scores divides. */
void ptie_add_scores(ptie_scores *sums, const ptie_loss_parts *parts);
ptie_scores ptie_mean_scores(const ptie_scores *sums);

/* Learning rate of the step that follows `step` finished ones (L6): a cosine over the epochs,
   stepped per epoch, times a linear warm-up per step.  Keras reports 1.85e-6 for the last of 20
   epochs at 3e-4. */
double ptie_learning_rate(const ptie_train_params *params, uint64_t steps_per_epoch, uint64_t step);

/* order (out): the samples 0..count-1 as epoch `epoch` (from 0) takes them; a pure function of
   (seed, epoch). */
void ptie_epoch_order(uint32_t *order, uint32_t count, uint64_t seed, uint64_t epoch);

#endif
