/* SPDX-License-Identifier: BSD-3-Clause */
/* Training and evaluation: that it learns, when it stops, what it writes and what it refuses. */
#include "support/files.h"
#include "train/tiny.h"

#include <math.h>
#include <stdlib.h>

#include <ptie/metrics.h>
#include <ptie/version.h>

static const ptie_progress silent = {0};

static void training_beats_the_noisy_input(void **state) {
    (void)state;
    ptie_ctx *ctx = tiny_context(2);
    ptie_preset *preset = tiny_preset(32, "10 % .. 20 %");
    ptie_model *model = tiny_model(), *best;
    ptie_dataset *dataset;
    ptie_train_params params = tiny_params();
    params.epochs = 30;
    params.patience = 0;
    params.learning_rate = 1e-2;
    const char *path = support_temporary("learnt");
    assert_ok(ptie_dataset_from_preset(&dataset, preset, 1, 200));
    assert_ok(ptie_train(ctx, model, dataset, path, &params, silent));
    assert_ok(ptie_model_load(&best, path));

    ptie_scores noisy, denoised;
    assert_ok(ptie_evaluate(ctx, best, dataset, PTIE_TEST, &params, &noisy, &denoised, silent));
    print_message("# loss %.4f -> %.4f, PSNR %.2f -> %.2f dB\n", noisy.loss, denoised.loss,
                  noisy.psnr_db, denoised.psnr_db);
    assert_int_equal(noisy.samples, 20);
    assert_int_equal(denoised.samples, 20);
    assert_true(denoised.loss < 0.8 * noisy.loss);
    assert_true(denoised.psnr_db > noisy.psnr_db + 1);
    ptie_model_free(best);
    ptie_model_free(model);
    ptie_dataset_free(dataset);
    ptie_preset_free(preset);
    ptie_ctx_free(ctx);
}

/* Means over samples by the metrics of the library, one sample after the other. */
static void scores_are_means_over_samples(void **state) {
    (void)state;
    enum { PIXELS = TINY_SIDE * TINY_SIDE };
    static float clean[PIXELS], noisy[PIXELS], denoised[PIXELS];
    ptie_ctx *ctx = tiny_context(3);
    ptie_preset *preset = tiny_preset(TINY_SIDE, "3 % .. 10 %");
    ptie_model *model = tiny_model();
    ptie_denoiser *denoiser;
    ptie_dataset *dataset;
    enum { SAMPLES = 140 }; /* more than two blocks */
    assert_ok(ptie_dataset_from_preset(&dataset, preset, 1, SAMPLES));
    assert_ok(ptie_denoiser_create(&denoiser, ctx, model, TINY_SIDE, TINY_SIDE, NULL));
    void *scratch = ptie_scratch_alloc(ptie_denoiser_scratch_bytes(denoiser));

    ptie_scores expected[2] = {{0}}, found[2];
    for (uint64_t i = 0; i < SAMPLES; i++) {
        ptie_comparison compared[2];
        assert_ok(ptie_dataset_read(dataset, PTIE_ALL, i, clean, noisy, NULL));
        assert_ok(ptie_denoiser_run(denoiser, denoised, noisy, scratch));
        assert_ok(ptie_compare(&compared[0], noisy, clean, TINY_SIDE, TINY_SIDE, 1));
        assert_ok(ptie_compare(&compared[1], denoised, clean, TINY_SIDE, TINY_SIDE, 1));
        for (int j = 0; j < 2; j++) {
            expected[j].psnr_db += compared[j].psnr_db / SAMPLES;
            expected[j].mae += compared[j].mae / SAMPLES;
            expected[j].ssim += compared[j].ssim / SAMPLES;
        }
    }
    assert_ok(ptie_evaluate(ctx, model, dataset, PTIE_ALL, NULL, &found[0], &found[1], silent));
    /* Roundings of f32 windows and of f64 sums: measured 9e-10 dB, 7e-12 and 5e-8; ten times that.
     */
    for (int j = 0; j < 2; j++) {
        assert_int_equal(found[j].samples, SAMPLES);
        assert_near(found[j].psnr_db, expected[j].psnr_db, 1e-8);
        assert_near(found[j].mae, expected[j].mae, 1e-10);
        assert_near(found[j].ssim, expected[j].ssim, 5e-7);
    }
    ptie_scratch_free(scratch);
    ptie_denoiser_free(denoiser);
    ptie_model_free(model);
    ptie_dataset_free(dataset);
    ptie_preset_free(preset);
    ptie_ctx_free(ctx);
}

static int count_samples(void *user, uint64_t done, uint64_t total, const char *note) {
    (void)note;
    uint64_t *counted = user;
    assert_int_equal(total, 3);
    assert_true(done > counted[0]);
    counted[0] = done;
    return counted[1] != 0;
}

static void evaluation_without_a_model_scores_the_input(void **state) {
    (void)state;
    ptie_ctx *ctx = tiny_context(1);
    ptie_preset *preset = tiny_preset(TINY_SIDE, "5 %");
    ptie_dataset *dataset, *two;
    ptie_scores noisy = {0}, untouched = {.loss = 7};
    uint64_t counted[2] = {0, 0};
    assert_ok(ptie_dataset_from_preset(&dataset, preset, 1, TINY_SAMPLES));
    assert_ok(ptie_dataset_from_preset(&two, preset, 1, 2));
    assert_ok(ptie_evaluate(ctx, NULL, dataset, PTIE_TEST, NULL, &noisy, &untouched,
                            (ptie_progress){count_samples, counted}));
    assert_int_equal(counted[0], 3);
    assert_int_equal(noisy.samples, 3);
    assert_true(noisy.loss > 0 && noisy.psnr_db > 0);
    assert_near(untouched.loss, 7, 0);

    uint64_t cancelling[2] = {0, 1};
    assert_fails(ptie_evaluate(ctx, NULL, dataset, PTIE_TEST, NULL, &noisy, NULL,
                               (ptie_progress){count_samples, cancelling}),
                 PTIE_ECANCELLED, "cancelled");
    assert_fails(ptie_evaluate(ctx, NULL, two, PTIE_TEST, NULL, &noisy, NULL, silent), PTIE_EINVAL,
                 "empty");
    ptie_dataset_free(two);
    ptie_dataset_free(dataset);
    ptie_preset_free(preset);
    ptie_ctx_free(ctx);
}

/* What a run leaves: rows, the best model with its notes, curves that the model file confirms. */
static void a_run_writes_history_and_the_best_model(void **state) {
    (void)state;
    ptie_train_params params = tiny_params();
    params.batch = 5; /* the last of five batches has four samples */
    const char *path = support_temporary("run");
    assert_ok(tiny_train(path, 2, &params, silent));

    ptie_epoch *rows;
    size_t count, best = 0;
    assert_ok(ptie_history_read(&rows, &count, path));
    assert_int_equal(count, 4);
    for (size_t i = 0; i < count; i++) {
        assert_int_equal(rows[i].train.samples, 24);
        assert_int_equal(rows[i].validation.samples, 3);
        if (rows[i].validation.loss < rows[best].validation.loss) best = i;
    }
    assert_near(rows[0].learning_rate, 3e-3, 0); /* the warm-up's last step */
    assert_near(rows[3].learning_rate, 3e-3 * 0.5 * (1 + cos(3.14159265358979323846 * 3 / 4)),
                1e-18);

    ptie_ctx *ctx = tiny_context(1);
    ptie_preset *preset = tiny_preset(TINY_SIDE, "3 % .. 10 %");
    ptie_dataset *dataset;
    ptie_model *model;
    ptie_scores scores;
    char epoch[16];
    assert_ok(ptie_dataset_from_preset(&dataset, preset, 1, TINY_SAMPLES));
    assert_ok(ptie_model_load(&model, path));
    assert_ok(ptie_evaluate(ctx, model, dataset, PTIE_VALIDATION, &params, NULL, &scores, silent));
    assert_memory_equal(&scores, &rows[best].validation, sizeof scores);
    snprintf(epoch, sizeof epoch, "%zu", best + 1);
    assert_string_equal(ptie_model_note(model, "ptie.epochs"), epoch);
    assert_string_equal(ptie_model_note(model, "ptie.seed"), "9");
    assert_string_equal(ptie_model_note(model, "ptie.version"), PTIE_VERSION_STRING);
    assert_string_equal(ptie_model_note(model, "ptie.trained_on"),
                        "preset tiny, seed 1, 24 of 30 samples");
    ptie_model_free(model);
    ptie_dataset_free(dataset);
    ptie_preset_free(preset);
    ptie_ctx_free(ctx);
    ptie_history_free(rows);
}

static void early_stopping_waits_for_its_patience(void **state) {
    (void)state;
    ptie_ctx *ctx = tiny_context(1);
    ptie_preset *preset = tiny_preset(TINY_SIDE, "5 %");
    ptie_model_params shape;
    ptie_model *model, *best;
    ptie_dataset *dataset;
    ptie_train_params params = tiny_params();
    ptie_epoch *rows;
    size_t count;
    /* A rate too small to change a weight, and statistics that stand still: every epoch scores the
     * same. */
    ptie_model_params_init(&shape);
    shape.bn_momentum = 1;
    params.learning_rate = 1e-30;
    params.epochs = 20;
    params.patience = 2;
    assert_ok(ptie_model_create(&model, &shape));
    assert_ok(ptie_dataset_from_preset(&dataset, preset, 1, TINY_SAMPLES));
    const char *path = support_temporary("still");
    assert_ok(ptie_train(ctx, model, dataset, path, &params, silent));
    assert_ok(ptie_history_read(&rows, &count, path));
    assert_int_equal(count, 3);
    assert_near(rows[2].validation.loss, rows[0].validation.loss, 0);
    assert_ok(ptie_model_load(&best, path));
    assert_string_equal(ptie_model_note(best, "ptie.epochs"), "1");
    ptie_history_free(rows);
    ptie_model_free(best);
    ptie_model_free(model);
    ptie_dataset_free(dataset);
    ptie_preset_free(preset);
    ptie_ctx_free(ctx);
}

static void a_loss_that_is_not_finite_stops_and_overwrites_nothing(void **state) {
    (void)state;
    ptie_train_params params = tiny_params();
    params.learning_rate = 1e38;
    params.overwrite = true;
    char path[256], last[300];
    snprintf(path, sizeof path, "%s", support_temporary("kept"));
    snprintf(last, sizeof last, "%s.last", path);
    support_write(path, "a model", 7);
    support_write(last, "a state", 7);
    assert_fails(tiny_train(path, 1, &params, silent), PTIE_ENUMERIC, "not finite at step");
    const char *paths[2] = {path, last}, *contents[2] = {"a model", "a state"};
    for (int i = 0; i < 2; i++) {
        size_t bytes;
        unsigned char *data = support_read(paths[i], &bytes);
        assert_string_equal((char *)data, contents[i]);
        free(data);
    }
}

static void existing_outputs_are_refused(void **state) {
    (void)state;
    const ptie_train_params params = tiny_params();
    const char *path = support_temporary("there");
    char last[1100];
    support_write(path, "mine", 4);
    assert_fails(tiny_train(path, 1, &params, silent), PTIE_EEXIST, "there");
    remove(path);
    snprintf(last, sizeof last, "%s.last", path);
    support_write(last, "mine", 4);
    assert_fails(tiny_train(path, 1, &params, silent), PTIE_EEXIST, "there.last");
    support_assert_nothing_left(path);
    assert_fails(tiny_train("/tmp", 1, &params, silent), PTIE_EIO, "/tmp");
    assert_fails(tiny_train("/absent/model", 1, &params, silent), PTIE_EIO, "/absent/model");
}

static ptie_status train_shape(int side, uint64_t samples, int32_t in_channels) {
    ptie_ctx *ctx = tiny_context(1);
    ptie_preset *preset = tiny_preset(side, "5 %");
    ptie_model_params shape;
    ptie_model_params_init(&shape);
    shape.in_channels = in_channels;
    ptie_model *model;
    ptie_dataset *dataset;
    const ptie_train_params params = tiny_params();
    const char *path = support_temporary("shape");
    assert_ok(ptie_model_create(&model, &shape));
    assert_ok(ptie_dataset_from_preset(&dataset, preset, 1, samples));
    ptie_status status = ptie_train(ctx, model, dataset, path, &params, silent);
    support_assert_nothing_left(path);
    ptie_dataset_free(dataset);
    ptie_model_free(model);
    ptie_preset_free(preset);
    ptie_ctx_free(ctx);
    return status;
}

static void data_that_do_not_fit_are_refused(void **state) {
    (void)state;
    assert_fails(train_shape(18, 10, 1), PTIE_ESIZE,
                 "multiples of 4 and at least 11, found 18 x 18");
    assert_fails(train_shape(16, 2, 1), PTIE_EINVAL, "found 2");
    assert_fails(train_shape(16, 10, 2), PTIE_ESIZE, "expected 1 input channel, found 2");
}

static void parameters_are_checked(void **state) {
    (void)state;
    const char *path = support_temporary("checked");
    const ptie_train_params good = tiny_params();
    ptie_train_params params = good;
    assert_fails((params.epochs = 0, tiny_train(path, 1, &params, silent)), PTIE_EINVAL, "epochs");
    params = good;
    assert_fails((params.batch = 1025, tiny_train(path, 1, &params, silent)), PTIE_EINVAL, "batch");
    params = good;
    assert_fails((params.learning_rate = (double)NAN, tiny_train(path, 1, &params, silent)),
                 PTIE_EINVAL, "learning_rate");
    params = good;
    assert_fails((params.beta2 = 1, tiny_train(path, 1, &params, silent)), PTIE_EINVAL, "beta2");
    params = good;
    params.w_l1 = params.w_ssim = params.w_mse = 0;
    assert_fails(tiny_train(path, 1, &params, silent), PTIE_EINVAL, "weights");
    params = good;
    assert_fails((params.patience = -1, tiny_train(path, 1, &params, silent)), PTIE_EINVAL,
                 "patience");
    support_assert_nothing_left(path);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(training_beats_the_noisy_input),
        cmocka_unit_test(scores_are_means_over_samples),
        cmocka_unit_test(evaluation_without_a_model_scores_the_input),
        cmocka_unit_test(a_run_writes_history_and_the_best_model),
        cmocka_unit_test(early_stopping_waits_for_its_patience),
        cmocka_unit_test(a_loss_that_is_not_finite_stops_and_overwrites_nothing),
        cmocka_unit_test(existing_outputs_are_refused),
        cmocka_unit_test(data_that_do_not_fit_are_refused),
        cmocka_unit_test(parameters_are_checked),
    };
    return cmocka_run_group_tests_name("train/train", tests, NULL, NULL);
}
