/* SPDX-License-Identifier: BSD-3-Clause */
/* The training loop.  An epoch takes every sample once; the last batch takes what is left, and
 * counts as a step (as Keras does).  Training scores are means over the samples as they were seen,
 * with dropout. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <ptie/version.h>

#include "base/clock.h"
#include "base/file.h"
#include "base/memory.h"
#include "nn/model.h"
#include "train/history.h"
#include "train/trainer.h"

void ptie_train_params_init(ptie_train_params *params) {
    *params = (ptie_train_params){
        .struct_size = sizeof *params,
        .epochs = 20,
        .batch = 32,
        .learning_rate = 3e-4,
        .warmup_epochs = 1,
        .weight_decay = 0.004,
        .beta1 = 0.9,
        .beta2 = 0.999,
        .epsilon = 1e-7,
        .w_l1 = 0.5,
        .w_ssim = 0.4,
        .w_mse = 0.1,
        .patience = 5,
    };
}

static uint64_t samples_done(const ptie_trainer *t) {
    return t->epoch_count * (uint64_t)t->train_count + t->sums.samples;
}

static ptie_status report(const ptie_trainer *t, const char *note) {
    return ptie_progress_report(t->progress, samples_done(t),
                                (uint64_t)t->params->epochs * t->train_count, note);
}

/* One step. */

/* Loads sample i of the batch at t->loading. */
static ptie_status load_sample(void *context, size_t i, int32_t worker) {
    ptie_trainer *t = context;
    const uint64_t index = t->order[t->loading + i];
    return ptie_dataset_fetch(t->dataset, PTIE_TRAIN, index,
                              ptie_stepper_clean(t->stepper, (int32_t)i, true),
                              ptie_stepper_noisy(t->stepper, (int32_t)i, true), NULL,
                              t->scratch + (size_t)worker * t->scratch_bytes);
}

/* Samples of the batch that begins at a place of the epoch; 0 behind its end. */
static int32_t batch_at(const ptie_trainer *t, uint64_t first) {
    const uint64_t left = t->train_count - first, batch = (uint64_t)t->params->batch;
    return (int32_t)(left < batch ? left : batch);
}

/* Only the first batch of an epoch is waited for: a step loads the one after it. */
static ptie_status load_first(ptie_trainer *t, int32_t count) {
    ptie_epoch_order(t->order, t->train_count, t->params->seed, t->epoch_count);
    t->ordered_epoch = t->epoch_count;
    t->loading = t->sums.samples;
    return ptie_pool_run(t->engine->pool, (size_t)count, load_sample, t);
}

static ptie_status expect_finite(double value, const ptie_trainer *t, const char *what) {
    if (isfinite(value)) return PTIE_OK;
    return PTIE_FAIL(PTIE_ENUMERIC,
                     "training: %s is not finite at step %llu (expected a number, found %g; try a "
                     "smaller learning rate)",
                     what, (unsigned long long)t->step + 1, value);
}

/* ReLU turns NaN into 0, so a broken network can still have a loss. */
static ptie_status expect_finite_weights(const ptie_trainer *t) {
    const float *values = t->model->values;
    for (size_t i = 0; i < t->model->graph.values; i++)
        PTIE_TRY(expect_finite((double)values[i], t, "a weight"));
    return PTIE_OK;
}

static ptie_status optimise(ptie_trainer *t, int32_t count, const ptie_aside *aside) {
    const ptie_train_params *p = t->params;
    const ptie_adamw adamw = {.learning_rate = ptie_learning_rate(p, t->steps_per_epoch, t->step),
                              .beta1 = p->beta1,
                              .beta2 = p->beta2,
                              .epsilon = p->epsilon,
                              .weight_decay = p->weight_decay};
    PTIE_TRY(ptie_stepper_gradients(t->stepper, count, p->seed, t->step + 1, t->parts, aside));
    for (int32_t i = 0; i < count; i++) PTIE_TRY(expect_finite(t->parts[i].loss, t, "the loss"));
    ptie_stepper_update(t->stepper, &adamw, t->step + 1);
    PTIE_TRY(expect_finite_weights(t));
    for (int32_t i = 0; i < count; i++) ptie_add_scores(&t->sums, &t->parts[i]);
    t->step++;
    return PTIE_OK;
}

static ptie_status take_step(ptie_trainer *t) {
    const double start_s = ptie_now_s();
    const int32_t count = batch_at(t, t->sums.samples);
    if (t->ordered_epoch != t->epoch_count) PTIE_TRY(load_first(t, count));
    ptie_stepper_advance(t->stepper);
    t->loading = t->sums.samples + (uint64_t)count;
    const ptie_aside next = {load_sample, t, (size_t)batch_at(t, t->loading)};
    PTIE_TRY(optimise(t, count, &next));
    t->seconds += ptie_now_s() - start_s;
    const int32_t interval = t->params->checkpoint_steps;
    if (interval > 0 && t->step % (uint64_t)interval == 0) PTIE_TRY(ptie_checkpoint_save(t));

    char note[128];
    const ptie_scores mean = ptie_mean_scores(&t->sums);
    ptie_print(note, sizeof note, "epoch %zu/%d loss %.4f PSNR %.2f dB", t->epoch_count + 1,
             t->params->epochs, mean.loss, mean.psnr_db);
    return report(t, note);
}

/* The end of an epoch. */

static int report_validation(void *user, uint64_t done, uint64_t total, const char *note) {
    const ptie_trainer *t = user;
    char line[128];
    (void)note;
    ptie_print(line, sizeof line, "epoch %zu/%d validation %llu/%llu", t->epoch_count + 1,
             t->params->epochs, (unsigned long long)done, (unsigned long long)total);
    return report(t, line) != PTIE_OK;
}

static ptie_loss_weights loss_weights(const ptie_train_params *params) {
    return (ptie_loss_weights){.l1 = params->w_l1, .ssim = params->w_ssim, .mse = params->w_mse};
}

static ptie_status validate(ptie_trainer *t, ptie_scores *scores) {
    const ptie_progress progress = {t->progress.report ? report_validation : NULL, t};
    PTIE_TRY(ptie_score_split(t->engine, t->model, t->dataset, PTIE_VALIDATION,
                              loss_weights(t->params), NULL, scores, progress));
    return expect_finite(scores->loss, t, "the validation loss");
}

static void close_epoch(ptie_trainer *t, const ptie_scores *validation, double seconds) {
    t->epochs[t->epoch_count] = (ptie_epoch){
        .epoch = (int32_t)t->epoch_count + 1,
        .learning_rate = ptie_learning_rate(t->params, t->steps_per_epoch, t->step - 1),
        .seconds = t->seconds + seconds,
        .train = ptie_mean_scores(&t->sums),
        .validation = *validation,
    };
    t->epoch_count++;
    t->sums = (ptie_scores){0};
    t->seconds = 0;
}

static ptie_status save_best(ptie_trainer *t) {
    char text[32];
    snprintf(text, sizeof text, "%zu", t->epoch_count);
    PTIE_TRY(ptie_nn_set_note(t->model, "ptie.epochs", text));
    if (ptie_history_best(t->epochs, t->epoch_count) + 1 != t->epoch_count) return PTIE_OK;
    return ptie_nn_save(t->model, t->path, true);
}

/* The checkpoint comes last: killed before it, the run repeats the epoch's end to the same files. */
static ptie_status save_state(ptie_trainer *t) {
    PTIE_TRY(ptie_history_write(t->path, t->epochs, t->epoch_count));
    return ptie_checkpoint_save(t);
}

static ptie_status finish_epoch(ptie_trainer *t) {
    const double start_s = ptie_now_s();
    ptie_scores validation;
    PTIE_TRY(validate(t, &validation));
    close_epoch(t, &validation, ptie_now_s() - start_s);
    PTIE_TRY(save_best(t));
    PTIE_TRY(save_state(t));

    char note[160];
    const ptie_epoch *row = &t->epochs[t->epoch_count - 1];
    ptie_print(note, sizeof note,
             "epoch %d/%d loss %.4f PSNR %.2f dB, validation loss %.4f PSNR %.2f dB", row->epoch,
             t->params->epochs, row->train.loss, row->train.psnr_db, row->validation.loss,
             row->validation.psnr_db);
    return report(t, note);
}

/* The run. */

static bool epoch_is_complete(const ptie_trainer *t) {
    return t->sums.samples == t->train_count;
}

static bool is_finished(const ptie_trainer *t) {
    const ptie_train_params *p = t->params;
    const size_t since_best = t->epoch_count - ptie_history_best(t->epochs, t->epoch_count);
    if (t->epoch_count == (size_t)p->epochs) return true;
    if (p->patience > 0 && since_best > (size_t)p->patience) return true;
    if (p->steps_limit > 0 && t->step >= p->steps_limit) return true;
    return p->time_limit_s > 0 && ptie_now_s() - t->started_s >= p->time_limit_s;
}

/* A complete epoch is always judged, also when a limit is reached with it. */
static ptie_status run_epochs(ptie_trainer *t) {
    for (;;) {
        if (epoch_is_complete(t))
            PTIE_TRY(finish_epoch(t));
        else if (is_finished(t))
            return PTIE_OK;
        else
            PTIE_TRY(take_step(t));
    }
}

/* Also finds out, before any work, whether the files can be written. */
static ptie_status claim_outputs(const ptie_trainer *t) {
    const bool replace = t->params->overwrite || t->params->resume;
    const char *paths[2] = {t->path, t->last_path.data};
    for (int i = 0; i < 2; i++) {
        ptie_output_file file;
        PTIE_TRY(ptie_output_open(&file, paths[i], replace));
        ptie_output_discard(&file);
    }
    return PTIE_OK;
}

static ptie_status describe_model(ptie_trainer *t) {
    char text[160], preset[64] = "unknown";
    const char *name = strstr(t->dataset->preset_text, "name = ");
    if (name) sscanf(name, "name = %63[^\n]", preset);
    snprintf(text, sizeof text, "preset %s, seed %llu, %u of %llu samples", preset,
             (unsigned long long)t->dataset->seed, t->train_count,
             (unsigned long long)t->dataset->count);
    PTIE_TRY(ptie_nn_set_note(t->model, "ptie.trained_on", text));
    snprintf(text, sizeof text, "%llu", (unsigned long long)t->params->seed);
    PTIE_TRY(ptie_nn_set_note(t->model, "ptie.seed", text));
    return ptie_nn_set_note(t->model, "ptie.version", ptie_version());
}

static ptie_status check_fit(const ptie_model *model, const ptie_dataset *dataset) {
    const ptie_model_params *params = &model->params;
    const int32_t multiple = 1 << (params->levels - 1);
    const int32_t width = dataset->width_px, height = dataset->height_px;
    if (params->in_channels != 1)
        return PTIE_FAIL(PTIE_ESIZE,
                         "model: does not fit the data set (expected 1 input channel, found %d)",
                         params->in_channels);
    if (width % multiple || height % multiple || width < PTIE_SSIM_WINDOW ||
        height < PTIE_SSIM_WINDOW)
        return PTIE_FAIL(
            PTIE_ESIZE,
            "data set: does not fit the model (expected sides that are multiples of %d and at "
            "least %d, found %d x %d)",
            multiple, PTIE_SSIM_WINDOW, width, height);
    if (ptie_dataset_count(dataset, PTIE_VALIDATION) == 0 || dataset->count > INT32_MAX)
        return PTIE_FAIL(PTIE_EINVAL,
                         "data set: cannot train on its size (expected 3..%d samples, found %llu)",
                         INT32_MAX, (unsigned long long)dataset->count);
    return PTIE_OK;
}

static ptie_status prepare(ptie_trainer *t) {
    const ptie_dataset *dataset = t->dataset;
    const uint32_t batch = (uint32_t)t->params->batch;
    PTIE_TRY(check_fit(t->model, dataset));
    t->train_count = (uint32_t)ptie_dataset_count(dataset, PTIE_TRAIN);
    t->steps_per_epoch = (t->train_count + batch - 1) / batch;
    t->ordered_epoch = SIZE_MAX;
    t->scratch_bytes = ptie_dataset_scratch(dataset);

    PTIE_TRY(ptie_checkpoint_describe(t));
    PTIE_TRY(claim_outputs(t));
    PTIE_TRY(
        ptie_alloc_status(&t->epochs, (size_t)t->params->epochs, sizeof *t->epochs, "training"));
    PTIE_TRY(ptie_alloc_status(&t->order, t->train_count, sizeof *t->order, "training"));
    PTIE_TRY(ptie_alloc_status(&t->parts, batch, sizeof *t->parts, "training"));
    PTIE_TRY(ptie_alloc_status(&t->scratch, (size_t)ptie_pool_threads(t->engine->pool),
                               t->scratch_bytes, "scratch of the data set"));
    PTIE_TRY(ptie_stepper_create(&t->stepper, t->engine, t->model, t->params->batch,
                                 dataset->width_px, dataset->height_px, loss_weights(t->params)));
    PTIE_TRY(describe_model(t));
    return t->params->resume ? ptie_checkpoint_restore(t) : PTIE_OK;
}

static void free_trainer(ptie_trainer *t) {
    ptie_stepper_free(t->stepper);
    ptie_text_free(&t->last_path);
    ptie_text_free(&t->settings);
    ptie_free(t->epochs);
    ptie_free(t->order);
    ptie_free(t->parts);
    ptie_free(t->scratch);
}

ptie_status ptie_train_run(const ptie_engine *engine, ptie_model *model,
                           const ptie_dataset *dataset, const char *path,
                           const ptie_train_params *params, ptie_progress progress) {
    ptie_trainer t = {.engine = engine,
                      .model = model,
                      .dataset = dataset,
                      .path = path,
                      .params = params,
                      .progress = progress,
                      .started_s = ptie_now_s()};
    ptie_status status = prepare(&t);
    if (status == PTIE_OK) {
        status = run_epochs(&t);
        const bool stopped = status == PTIE_OK || status == PTIE_ECANCELLED;
        const ptie_status saved = stopped ? save_state(&t) : PTIE_OK;
        if (saved != PTIE_OK) status = saved;
    }
    free_trainer(&t);
    return status;
}
