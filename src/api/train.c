/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/train.h>: arguments checked, then inward. */
#include <ptie/train.h>

#include "api/context.h"
#include "api/params.h"
#include "train/history.h"
#include "train/train.h"

#define MOST 1e9 /* no rate, weight or time comes near */

static ptie_status check_weights(const ptie_train_params *p, const char *where) {
    PTIE_TRY(ptie_check_number(p->w_l1, 0, MOST, where, "w_l1"));
    PTIE_TRY(ptie_check_number(p->w_ssim, 0, MOST, where, "w_ssim"));
    PTIE_TRY(ptie_check_number(p->w_mse, 0, MOST, where, "w_mse"));
    return ptie_check_positive(p->w_l1 + p->w_ssim + p->w_mse, where, "sum of the loss weights");
}

static ptie_status check_params(const ptie_train_params *p, const char *where) {
    PTIE_TRY(ptie_check_integer(p->epochs, 1, 1000000, where, "epochs"));
    PTIE_TRY(ptie_check_integer(p->batch, 1, 1024, where, "batch"));
    PTIE_TRY(ptie_check_positive(p->learning_rate, where, "learning_rate"));
    PTIE_TRY(ptie_check_number(p->warmup_epochs, 0, MOST, where, "warmup_epochs"));
    PTIE_TRY(ptie_check_number(p->weight_decay, 0, MOST, where, "weight_decay"));
    PTIE_TRY(ptie_check_number(p->beta1, 0, 1 - 1e-12, where, "beta1"));
    PTIE_TRY(ptie_check_number(p->beta2, 0, 1 - 1e-12, where, "beta2"));
    PTIE_TRY(ptie_check_positive(p->epsilon, where, "epsilon"));
    PTIE_TRY(ptie_check_integer(p->patience, 0, INT32_MAX, where, "patience"));
    PTIE_TRY(ptie_check_number(p->time_limit_s, 0, MOST, where, "time_limit_s"));
    PTIE_TRY(ptie_check_integer(p->checkpoint_steps, 0, INT32_MAX, where, "checkpoint_steps"));
    return check_weights(p, where);
}

ptie_status ptie_train(ptie_ctx *ctx, ptie_model *model, const ptie_dataset *dataset,
                       const char *path, const ptie_train_params *params, ptie_progress progress) {
    static const char where[] = "ptie_train";
    PTIE_TRY(ptie_check_pointer(ctx, where, "ctx"));
    PTIE_TRY(ptie_check_pointer(model, where, "model"));
    PTIE_TRY(ptie_check_pointer(dataset, where, "dataset"));
    PTIE_TRY(ptie_check_pointer(path, where, "path"));
    ptie_train_params known;
    ptie_train_params_init(&known);
    PTIE_TRY(ptie_params_read(&known, sizeof known, params, where));
    PTIE_TRY(check_params(&known, where));
    return ptie_train_run(&ctx->engine, model, dataset, path, &known, progress);
}

ptie_status ptie_evaluate(ptie_ctx *ctx, const ptie_model *model, const ptie_dataset *dataset,
                          ptie_split split, const ptie_train_params *params, ptie_scores *noisy,
                          ptie_scores *denoised, ptie_progress progress) {
    static const char where[] = "ptie_evaluate";
    PTIE_TRY(ptie_check_pointer(ctx, where, "ctx"));
    PTIE_TRY(ptie_check_pointer(dataset, where, "dataset"));
    PTIE_TRY(ptie_check_integer(split, PTIE_TRAIN, PTIE_ALL, where, "split"));
    ptie_train_params known;
    ptie_train_params_init(&known);
    if (params) PTIE_TRY(ptie_params_read(&known, sizeof known, params, where));
    PTIE_TRY(check_weights(&known, where));
    const ptie_loss_weights weights = {.l1 = known.w_l1, .ssim = known.w_ssim, .mse = known.w_mse};
    return ptie_score_split(&ctx->engine, model, dataset, split, weights, noisy, denoised,
                            progress);
}

ptie_status ptie_history_read(ptie_epoch **epochs, size_t *count, const char *path) {
    static const char where[] = "ptie_history_read";
    PTIE_TRY(ptie_check_pointer(epochs, where, "epochs"));
    *epochs = NULL;
    PTIE_TRY(ptie_check_pointer(count, where, "count"));
    *count = 0;
    PTIE_TRY(ptie_check_pointer(path, where, "path"));
    return ptie_history_load(epochs, count, path);
}
