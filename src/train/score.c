/* SPDX-License-Identifier: BSD-3-Clause */
/* Scores of a model, and of its input, over a split: samples in parallel, sums in index order. */
#include <math.h>

#include "base/memory.h"
#include "train/train.h"

#define BLOCK_SAMPLES 64 /* between two progress reports */

void ptie_add_scores(ptie_scores *sums, const ptie_loss_parts *parts) {
    sums->loss += parts->loss;
    sums->psnr_db += -10 * log10(parts->mse); /* MAX = 1; +inf for equal maps */
    sums->mae += parts->l1;
    sums->ssim += parts->ssim;
    sums->samples++;
}

ptie_scores ptie_mean_scores(const ptie_scores *sums) {
    const double n = (double)sums->samples;
    return (ptie_scores){.loss = sums->loss / n,
                         .psnr_db = sums->psnr_db / n,
                         .mae = sums->mae / n,
                         .ssim = sums->ssim / n,
                         .samples = sums->samples};
}

/* One block of samples; parts are per sample of the block. */
typedef struct scoring {
    const ptie_engine *engine;
    const ptie_dataset *dataset;
    const ptie_denoiser *denoiser; /* NULL: the output is not scored */
    bool input;                    /* the input is scored */
    ptie_split split;
    ptie_loss_weights weights;
    uint64_t first;
    ptie_loss_parts noisy[BLOCK_SAMPLES], denoised[BLOCK_SAMPLES];
    unsigned char *scratch; /* one part per worker */
    size_t scratch_bytes;
} scoring;

typedef struct workspace {
    float *clean, *noisy, *denoised;
    void *plan; /* scratch of the data set, then of the denoiser, then of the loss */
} workspace;

static workspace slice_workspace(const scoring *s, ptie_slicer *slicer) {
    const ptie_dataset *dataset = s->dataset;
    const size_t pixels = (size_t)dataset->width_px * (size_t)dataset->height_px;
    const size_t bytes[3] = {ptie_dataset_scratch(dataset),
                             ptie_loss_scratch(dataset->width_px, dataset->height_px),
                             s->denoiser ? ptie_nn_denoiser_scratch(s->denoiser) : 0};
    size_t most = bytes[0];
    for (int i = 1; i < 3; i++) most = bytes[i] > most ? bytes[i] : most;
    return (workspace){
        .clean = ptie_slice(slicer, pixels, sizeof(float)),
        .noisy = ptie_slice(slicer, pixels, sizeof(float)),
        .denoised = ptie_slice(slicer, pixels, sizeof(float)),
        .plan = ptie_slice(slicer, most, 1),
    };
}

static void measure(const scoring *s, ptie_loss_parts *parts, const float *estimate,
                    const workspace *w) {
    ptie_loss_measure(s->engine, parts, estimate, w->clean, s->dataset->width_px,
                      s->dataset->height_px, s->weights, w->plan);
}

static ptie_status score_one(void *context, size_t i, int32_t worker) {
    scoring *s = context;
    ptie_slicer slicer = {.base = s->scratch + (size_t)worker * s->scratch_bytes};
    const workspace w = slice_workspace(s, &slicer);
    PTIE_TRY(
        ptie_dataset_fetch(s->dataset, s->split, s->first + i, w.clean, w.noisy, NULL, w.plan));
    if (s->input) measure(s, &s->noisy[i], w.noisy, &w);
    if (!s->denoiser) return PTIE_OK;
    PTIE_TRY(ptie_nn_denoise(s->denoiser, w.denoised, w.noisy, w.plan));
    measure(s, &s->denoised[i], w.denoised, &w);
    return PTIE_OK;
}

static ptie_status score_blocks(scoring *s, ptie_scores *noisy, ptie_scores *denoised,
                                ptie_progress progress) {
    const uint64_t count = ptie_dataset_count(s->dataset, s->split);
    while (s->first < count) {
        const uint64_t left = count - s->first, block = left < BLOCK_SAMPLES ? left : BLOCK_SAMPLES;
        PTIE_TRY(ptie_pool_run(s->engine->pool, (size_t)block, score_one, s));
        for (uint64_t i = 0; i < block; i++) {
            if (s->input) ptie_add_scores(noisy, &s->noisy[i]);
            if (s->denoiser) ptie_add_scores(denoised, &s->denoised[i]);
        }
        s->first += block;
        PTIE_TRY(ptie_progress_report(progress, s->first, count, NULL));
    }
    return PTIE_OK;
}

static ptie_status prepare(scoring *s, ptie_denoiser **denoiser, const ptie_model *model) {
    const int32_t width = s->dataset->width_px, height = s->dataset->height_px;
    if (width < PTIE_SSIM_WINDOW || height < PTIE_SSIM_WINDOW)
        return PTIE_FAIL(PTIE_ESIZE,
                         "data set: maps are too small for SSIM (expected at least %d x %d, "
                         "found %d x %d)",
                         PTIE_SSIM_WINDOW, PTIE_SSIM_WINDOW, width, height);
    if (ptie_dataset_count(s->dataset, s->split) == 0)
        return PTIE_FAIL(PTIE_EINVAL,
                         "data set: the split is empty (expected at least 3 samples, found %llu)",
                         (unsigned long long)s->dataset->count);
    if (model) {
        PTIE_TRY(ptie_nn_denoiser(denoiser, s->engine, model, width, height, NULL));
        s->denoiser = *denoiser;
    }
    ptie_slicer slicer = {0};
    slice_workspace(s, &slicer);
    s->scratch_bytes = slicer.used;
    return ptie_alloc_status(&s->scratch, (size_t)ptie_pool_threads(s->engine->pool),
                             s->scratch_bytes, "scratch of the evaluation");
}

ptie_status ptie_score_split(const ptie_engine *engine, const ptie_model *model,
                             const ptie_dataset *dataset, ptie_split split,
                             ptie_loss_weights weights, ptie_scores *noisy, ptie_scores *denoised,
                             ptie_progress progress) {
    scoring s = {.engine = engine,
                 .dataset = dataset,
                 .split = split,
                 .weights = weights,
                 .input = noisy != NULL};
    ptie_denoiser *denoiser = NULL;
    ptie_scores noisy_sums = {0}, denoised_sums = {0};
    ptie_status status = prepare(&s, &denoiser, model);
    if (status == PTIE_OK) status = score_blocks(&s, &noisy_sums, &denoised_sums, progress);
    if (status == PTIE_OK && noisy) *noisy = ptie_mean_scores(&noisy_sums);
    if (status == PTIE_OK && model && denoised) *denoised = ptie_mean_scores(&denoised_sums);
    ptie_free(s.scratch);
    ptie_nn_denoiser_free(denoiser);
    return status;
}
