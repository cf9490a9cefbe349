/* SPDX-License-Identifier: BSD-3-Clause */
/* Presets, models and runs that a test can afford. */
#ifndef PTIE_TESTS_TRAIN_TINY_H
#define PTIE_TESTS_TRAIN_TINY_H

#include "support/support.h"

#include <ptie/train.h>

static inline ptie_ctx *tiny_context(int32_t threads) {
    ptie_ctx *ctx;
    ptie_ctx_params params;
    ptie_ctx_params_init(&params);
    params.threads = threads;
    assert_ok(ptie_ctx_create(&ctx, &params));
    return ctx;
}

/* A preset of `side` x `side` maps whose [camera] noise is `noise`; the rest is preset `paper`. */
static inline ptie_preset *tiny_preset(int side, const char *noise) {
    char text[256];
    static char path[128]; /* once: support_temporary's results do not last */
    if (!path[0]) snprintf(path, sizeof path, "%s", support_temporary("tiny.ini"));
    int length = snprintf(text, sizeof text,
                          "[preset]\nname = tiny\n[image]\nwidth = %d\nheight = %d\n"
                          "[camera]\nnoise = %s\n",
                          side, side, noise);
    support_write(path, text, (size_t)length);
    ptie_preset *preset;
    assert_ok(ptie_preset_load(&preset, path));
    return preset;
}

/* unet-4-8 with dropout. */
static inline ptie_model *tiny_model(void) {
    ptie_model *model;
    ptie_model_params params;
    ptie_model_params_init(&params);
    params.levels = 2;
    params.width[0] = 4;
    params.width[1] = 8;
    params.seed = 3;
    assert_ok(ptie_model_create(&model, &params));
    return model;
}

/* 30 samples make 24 to train on: 6 batches of 4 an epoch. */
enum { TINY_SIDE = 16, TINY_SAMPLES = 30, TINY_STEPS_PER_EPOCH = 6 };

static inline ptie_train_params tiny_params(void) {
    ptie_train_params params;
    ptie_train_params_init(&params);
    params.epochs = 4;
    params.batch = 4;
    params.learning_rate = 3e-3;
    params.seed = 9;
    return params;
}

/* Trains a fresh tiny model on a tiny preset; frees ctx. */
static inline ptie_status tiny_train_with(ptie_ctx *ctx, const char *path,
                                          const ptie_train_params *params,
                                          ptie_progress progress) {
    ptie_preset *preset = tiny_preset(TINY_SIDE, "3 % .. 10 %");
    ptie_model *model = tiny_model();
    ptie_dataset *dataset;
    assert_ok(ptie_dataset_from_preset(&dataset, preset, 1, TINY_SAMPLES));
    ptie_status status = ptie_train(ctx, model, dataset, path, params, progress);
    ptie_dataset_free(dataset);
    ptie_model_free(model);
    ptie_preset_free(preset);
    ptie_ctx_free(ctx);
    return status;
}

static inline ptie_status tiny_train(const char *path, int32_t threads,
                                     const ptie_train_params *params, ptie_progress progress) {
    return tiny_train_with(tiny_context(threads), path, params, progress);
}

#endif
