/* SPDX-License-Identifier: BSD-3-Clause */
/* Forward through the network in training mode, docs/math.md (N1)-(N7). */
#include <math.h>
#include <string.h>

#include "base/random.h"
#include "nn/stepper.h"

static void drop_row(float *row, int32_t width, uint32_t threshold, float kept,
                     ptie_random *random) {
    uint32_t words[64];
    for (int32_t x = 0; x < width; x += 64) {
        const int32_t count = width - x < 64 ? width - x : 64;
        ptie_random_words(random, words, (size_t)count);
        for (int32_t i = 0; i < count; i++) row[x + i] *= words[i] < threshold ? 0 : kept;
    }
}

void ptie_dropout(const ptie_stepper *stepper, const ptie_map *map, size_t sample) {
    const double rate = stepper->model->params.dropout;
    if (rate == 0) return;
    const uint32_t threshold = (uint32_t)(rate * 4294967296.0);
    const float kept = (float)(1 / (1 - rate));
    const uint64_t largest_batch = 1024;
    ptie_random random;
    ptie_random_init(&random, stepper->seed, PTIE_STREAM_DROPOUT,
                     stepper->step * largest_batch + sample);
    for (int32_t c = 0; c < map->channels; c++)
        for (int32_t y = 0; y < map->height; y++)
            drop_row(map->data + c * map->plane + y * map->row, map->width, threshold, kept,
                     &random);
}

/* What a join upsamples. */
static void prepare_join(const ptie_stepper *stepper, int32_t k, size_t index) {
    const ptie_sample_state *sample = &stepper->samples[index];
    const ptie_map coarse = ptie_nn_layout_map(&stepper->coarse, sample->coarse, k);
    const ptie_map z = ptie_z_rows(stepper, sample, k - 1, 0, coarse.height);
    stepper->engine->kernels->normalise(&coarse, &z, stepper->norms[k - 1]);
    if (stepper->model->graph.layers[k].dropout) ptie_dropout(stepper, &coarse, index);
}

/* A layer's convolution and the sums of its result. */
ptie_status ptie_forward_layer(void *context, size_t index, int32_t worker) {
    const ptie_stepper *stepper = context;
    const ptie_kernels *kernels = stepper->engine->kernels;
    const int32_t k = stepper->section;
    const ptie_layer *layer = &stepper->model->graph.layers[k];
    ptie_band band = ptie_band_first(stepper, k, index, worker);
    double *sums = band.sample->sums;
    memset(sums, 0, 2 * (size_t)layer->out_channels * sizeof *sums);
    if (layer->input == PTIE_INPUT_JOIN) prepare_join(stepper, k, index);
    for (; band.rows > 0; ptie_band_next(stepper, &band)) {
        const ptie_map in = ptie_band_input(stepper, &band);
        const ptie_map z = ptie_z_rows(stepper, band.sample, k, band.first, band.rows);
        ptie_next next;
        kernels->winograd3x3(&z, &in, stepper->packed[k], NULL, false, sums,
                             band.workspace->scratch, ptie_next_input(stepper, band, &next));
    }
    return PTIE_OK;
}

/* Batch statistics of the section's layer, and the running ones (N2). */
void ptie_forward_join(ptie_stepper *stepper) {
    const int32_t k = stepper->section;
    ptie_model *model = stepper->model;
    const ptie_layer *layer = &model->graph.layers[k];
    const ptie_map *z = &stepper->z.maps[k];
    const double pixels = (double)stepper->count * z->height * z->width;
    const float *gamma = ptie_model_values(model, layer->params, PTIE_GAMMA);
    const float *beta = ptie_model_values(model, layer->params, PTIE_BETA);
    float *running_mean = ptie_model_values(model, layer->params, PTIE_MEAN);
    float *running_variance = ptie_model_values(model, layer->params, PTIE_VARIANCE);
    const double momentum = model->params.bn_momentum;
    for (int32_t c = 0; c < layer->out_channels; c++) {
        double sum = 0, squares = 0;
        for (int32_t n = 0; n < stepper->count; n++) {
            sum += stepper->samples[n].sums[2 * c];
            squares += stepper->samples[n].sums[2 * c + 1];
        }
        double mean = sum / pixels, variance = fmax(squares / pixels - mean * mean, 0);
        double inverse_std = 1 / sqrt(variance + model->params.bn_epsilon);
        double scale = (double)gamma[c] * inverse_std;
        stepper->norms[k][c] = (ptie_norm){.scale = (float)scale,
                                           .shift = (float)((double)beta[c] - mean * scale),
                                           .mean = (float)mean,
                                           .inverse_std = (float)inverse_std};
        running_mean[c] = (float)(momentum * (double)running_mean[c] + (1 - momentum) * mean);
        running_variance[c] =
            (float)(momentum * (double)running_variance[c] + (1 - momentum) * variance);
    }
}
