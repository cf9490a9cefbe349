/* SPDX-License-Identifier: BSD-3-Clause */
/* The training step by itself, and training as it is: with its samples drawn on the way. */
#include <stdlib.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/random.h"
#include "bench/folder.h"
#include "bench/groups.h"
#include "bench/memory.h"
#include "bench/network.h"
#include "nn/model.h"
#include "train/train.h"

typedef struct stepping {
    ptie_stepper *stepper;
    ptie_loss_parts parts[PTIE_BENCH_BATCH];
    uint64_t step;
} stepping;

static ptie_status take_step(void *context, int32_t worker) {
    (void)worker;
    static const ptie_adamw adamw = {.learning_rate = 1e-6, /* stays where it is */
                                     .beta1 = 0.9,
                                     .beta2 = 0.999,
                                     .epsilon = 1e-7,
                                     .weight_decay = 0.004};
    stepping *s = context;
    s->step++;
    PTIE_TRY(ptie_stepper_gradients(s->stepper, PTIE_BENCH_BATCH, 0, s->step, s->parts, NULL));
    ptie_stepper_update(s->stepper, &adamw, s->step);
    return PTIE_OK;
}

static void fill_batch(ptie_stepper *stepper) {
    ptie_random random;
    ptie_random_init(&random, 0, PTIE_STREAM_WEIGHTS, 0);
    for (int32_t n = 0; n < PTIE_BENCH_BATCH; n++) {
        float *noisy = ptie_stepper_noisy(stepper, n, false), *clean = ptie_stepper_clean(stepper, n, false);
        for (int i = 0; i < PTIE_BENCH_SIDE * PTIE_BENCH_SIDE; i++) {
            noisy[i] = (float)ptie_random_uniform(&random, 0, 1);
            clean[i] = (float)ptie_random_uniform(&random, 0, 1);
        }
    }
}

static ptie_status measure_step(ptie_bench *bench, ptie_model *model) {
    const ptie_loss_weights weights = {.l1 = 0.5, .ssim = 0.4, .mse = 0.1};
    stepping s = {.step = 0};
    PTIE_TRY(ptie_stepper_create(&s.stepper, bench->engine, model, PTIE_BENCH_BATCH,
                                 PTIE_BENCH_SIDE, PTIE_BENCH_SIDE, weights));
    fill_batch(s.stepper);
    ptie_status status = ptie_bench_measure(
        bench,
        &(ptie_bench_case){.name = "step alone, batch 32",
                           .unit = "samples/s",
                           .mode = PTIE_BENCH_TOGETHER,
                           .amount = PTIE_BENCH_BATCH,
                           .flops = ptie_bench_training_flops(&model->graph, PTIE_BENCH_SIDE),
                           .work = take_step,
                           .context = &s});
    ptie_stepper_free(s.stepper);
    return status;
}

/* Training, watched through its progress: every step is a sample. */
typedef struct training {
    ptie_model *model;
    const ptie_dataset *dataset;
    ptie_bench_samples *samples;
    const ptie_bench *bench;
    double start_s, last_s; /* clock */
    uint64_t done;          /* samples seen at last_s */
} training;

static int watch(void *user, uint64_t done, uint64_t total, const char *note) {
    (void)total, (void)note;
    training *t = user;
    ptie_bench_samples *samples = t->samples;
    const double now_s = ptie_now_s();
    const bool counts = t->done > 0 && done > t->done; /* a step, and not the first */
    if (counts && samples->count < PTIE_BENCH_SAMPLES)
        samples->rate[samples->count++] = (double)(done - t->done) / (now_s - t->last_s);
    t->done = done;
    t->last_s = now_s;
    return ptie_bench_enough(t->bench, samples, now_s - t->start_s);
}

static ptie_status train(ptie_bench *bench, const ptie_bench_case *measured,
                         ptie_bench_samples *samples) {
    training *t = measured->context;
    t->samples = samples;
    t->bench = bench;
    t->start_s = ptie_now_s();
    ptie_train_params params;
    ptie_train_params_init(&params);
    ptie_folder folder = {{0}};
    char path[PTIE_FOLDER_FILE_BYTES];
    PTIE_TRY(ptie_folder_create(&folder));
    ptie_status status = ptie_train_run(bench->engine, t->model, t->dataset,
                                        ptie_folder_file(&folder, path, "bench.safetensors"),
                                        &params, (ptie_progress){watch, t});
    ptie_folder_remove(&folder);
    return status == PTIE_ECANCELLED ? PTIE_OK : status; /* that was us */
}

static ptie_status measure_training(ptie_bench *bench, ptie_model *model) {
    enum { ENOUGH = 1000000 };
    training t = {.model = model};
    ptie_preset *preset = NULL;
    ptie_dataset *dataset = NULL;
    ptie_status status;
    const double before = ptie_bench_memory_start();
    PTIE_TRY_DONE(ptie_preset_read(&preset, "paper"));
    PTIE_TRY_DONE(ptie_dataset_draw(&dataset, preset, 1, ENOUGH));
    t.dataset = dataset;
    PTIE_TRY_DONE(ptie_bench_measure(
        bench,
        &(ptie_bench_case){.name = "with preset paper drawn on the fly",
                           .unit = "samples/s",
                           .mode = PTIE_BENCH_TOGETHER,
                           .flops = ptie_bench_training_flops(&model->graph, PTIE_BENCH_SIDE),
                           .sample = train,
                           .context = &t}));
    status = ptie_bench_note(bench, "memory", "MB", 1e-6 * (ptie_bench_memory_peak() - before));
done:
    ptie_dataset_free(dataset);
    ptie_preset_free(preset);
    return status;
}

ptie_status ptie_bench_training(ptie_bench *bench) {
    ptie_model *model;
    PTIE_TRY(ptie_bench_model(&model));
    ptie_status status = measure_step(bench, model);
    if (status == PTIE_OK) status = measure_training(bench, model);
    ptie_nn_free(model);
    return status;
}
