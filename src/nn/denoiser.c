/* SPDX-License-Identifier: BSD-3-Clause */
/* Inference: BatchNorm folded into the convolutions, memory planned, frames run in the caller's. */
#include "nn/denoiser.h"

#include <math.h>
#include <string.h>

#include "base/image.h"
#include "base/memory.h"

/* Folds the running statistics into weights and bias (N2). */
static void fold(ptie_denoiser *denoiser, const ptie_model *model, int32_t k) {
    const ptie_layer *layer = &model->graph.layers[k];
    const float *gamma = ptie_model_values(model, layer->params, PTIE_GAMMA);
    const float *beta = ptie_model_values(model, layer->params, PTIE_BETA);
    const float *mean = ptie_model_values(model, layer->params, PTIE_MEAN);
    const float *variance = ptie_model_values(model, layer->params, PTIE_VARIANCE);
    float scale[512];
    for (int32_t c = 0; c < layer->out_channels; c++) {
        double s = (double)gamma[c] / sqrt((double)variance[c] + model->params.bn_epsilon);
        scale[c] = (float)s;
        denoiser->bias[k][c] = (float)((double)beta[c] - s * (double)mean[c]);
    }
    const float *weights = ptie_model_values(model, layer->params, PTIE_WEIGHT);
    (denoiser->filtered[k] ? ptie_winograd_pack : ptie_conv3x3_pack)(
        denoiser->packed[k], weights, layer->out_channels, layer->in_channels, scale);
    if (denoiser->half)
        ptie_half_pairs(denoiser->packed[k],
                        ptie_conv3x3_packed(layer->out_channels, layer->in_channels));
}

static size_t slice_block(ptie_denoiser *denoiser, void *block) {
    const ptie_graph *graph = &denoiser->graph;
    ptie_slicer slicer = {.base = block};
    for (int32_t k = 0; k < graph->layer_count; k++) {
        const int32_t in = graph->layers[k].in_channels, out = graph->layers[k].out_channels;
        denoiser->packed[k] = ptie_slice(
            &slicer, (denoiser->filtered[k] ? ptie_winograd_packed : ptie_conv3x3_packed)(out, in),
            sizeof(float));
        denoiser->bias[k] = ptie_slice(&slicer, (size_t)out, sizeof(float));
    }
    denoiser->head = ptie_slice(&slicer, graph->params[graph->head].count + 1, sizeof(float));
    return slicer.used;
}

static void copy_weights(ptie_denoiser *denoiser, const ptie_model *model) {
    const ptie_graph *graph = &model->graph;
    const size_t inputs = graph->params[graph->head].count;
    for (int32_t k = 0; k < graph->layer_count; k++) fold(denoiser, model, k);
    memcpy(denoiser->head, ptie_model_values(model, graph->head, PTIE_WEIGHT),
           inputs * sizeof *denoiser->head);
    denoiser->head[inputs] = *ptie_model_values(model, graph->head, PTIE_BIAS);
}

/* Minimal filtering, for every layer that has channels enough to pay for its transforms. */
static void choose_filtering(ptie_denoiser *denoiser) {
    enum { LEAST_CHANNELS = 4 };
    for (int32_t k = 0; k < denoiser->graph.layer_count; k++) {
        const ptie_layer *layer = &denoiser->graph.layers[k];
        denoiser->filtered[k] = layer->in_channels >= LEAST_CHANNELS;
        const size_t floats = ptie_winograd_scratch(layer->out_channels, layer->in_channels);
        if (denoiser->filtered[k] && denoiser->filter_floats < floats)
            denoiser->filter_floats = floats;
    }
}

ptie_map ptie_denoiser_map(const ptie_denoiser *denoiser, int32_t channels, int32_t height,
                           int32_t width) {
    return (denoiser->half ? ptie_half_map_make : ptie_map_make)(channels, height, width);
}

/* Rows of a layer at a time: as many as keep what it reads and writes near. */
static int32_t band_rows(const ptie_map *in, const ptie_map *out) {
    enum { NEAR_BYTES = 256 << 10, MOST = 32 };
    const ptrdiff_t row_bytes = (in->channels + out->channels) * in->row * (ptrdiff_t)sizeof(float);
    const int32_t rows =
        (int32_t)(NEAR_BYTES / row_bytes) / PTIE_WINOGRAD_ROWS * PTIE_WINOGRAD_ROWS;
    return rows < PTIE_WINOGRAD_ROWS ? PTIE_WINOGRAD_ROWS : rows > MOST ? MOST : rows;
}

/* Who writes where: a skip straight into the input of the layer that joins it. */
static void connect(ptie_denoiser *denoiser) {
    const ptie_graph *graph = &denoiser->graph;
    for (int32_t k = 0; k < graph->layer_count; k++) {
        const bool same =
            k + 1 < graph->layer_count && graph->layers[k + 1].input == PTIE_INPUT_SAME;
        denoiser->outlet[k] = same ? k + 1 : PTIE_MAX_LAYERS + k;
    }
    for (int32_t k = 0; k < graph->layer_count; k++)
        if (graph->layers[k].input == PTIE_INPUT_JOIN) denoiser->outlet[graph->layers[k].skip] = k;
}

static void lay_out(ptie_denoiser *denoiser) {
    const ptie_graph *graph = &denoiser->graph;
    const int32_t strip = PTIE_WINOGRAD_ROWS;
    connect(denoiser);
    for (int32_t k = 0; k < graph->layer_count; k++) {
        const ptie_layer *layer = &graph->layers[k];
        const int32_t width = denoiser->full_width >> layer->level, outlet = denoiser->outlet[k];
        denoiser->windows[k] = ptie_denoiser_map(denoiser, layer->in_channels, 0, width);
        if (outlet >= PTIE_MAX_LAYERS)
            denoiser->windows[outlet] = ptie_denoiser_map(denoiser, layer->out_channels, 0, width);
        const ptie_map out = ptie_denoiser_map(denoiser, layer->out_channels, 0, width);
        denoiser->band[k] = band_rows(&denoiser->windows[k], &out);
    }
    const int32_t strips = (denoiser->height + strip - 1) / strip;
    denoiser->part_rows = (strips + denoiser->parts - 1) / denoiser->parts * strip;
    denoiser->parts = (denoiser->height + denoiser->part_rows - 1) / denoiser->part_rows;
    ptie_stream_plan(denoiser);
}

ptie_status ptie_nn_denoiser(ptie_denoiser **out, const ptie_engine *engine,
                             const ptie_model *model, int32_t width, int32_t height,
                             const ptie_denoiser_params *params) {
    const bool fast = params && params->fast, all_threads = params && params->all_threads;
    const int32_t unit = 1 << (model->params.levels - 1);
    ptie_denoiser *denoiser;
    *out = NULL;
    if (model->params.in_channels != 1)
        return PTIE_FAIL(PTIE_ESIZE, "model '%s' wants other inputs (expected 1 channel, found %d)",
                         model->name, model->params.in_channels);
    PTIE_TRY(ptie_alloc_status(&denoiser, 1, sizeof *denoiser, "denoiser"));
    denoiser->kernels = engine->kernels;
    denoiser->pool = all_threads ? engine->pool : NULL;
    denoiser->parts = all_threads ? ptie_pool_threads(engine->pool) : 1;
    denoiser->graph = model->graph;
    denoiser->output = model->params.output;
    denoiser->width = width;
    denoiser->height = height;
    denoiser->full_width = (width + unit - 1) / unit * unit;
    denoiser->full_height = (height + unit - 1) / unit * unit;
    if (fast) denoiser->half = ptie_half_kernels_of(engine->level);
    if (!denoiser->half) choose_filtering(denoiser);
    lay_out(denoiser);
    ptie_status status =
        ptie_alloc_status(&denoiser->block, slice_block(denoiser, NULL), 1, "denoiser");
    if (status != PTIE_OK) {
        ptie_nn_denoiser_free(denoiser);
        return status;
    }
    slice_block(denoiser, denoiser->block);
    copy_weights(denoiser, model);
    *out = denoiser;
    return PTIE_OK;
}

void ptie_nn_denoiser_free(ptie_denoiser *denoiser) {
    if (!denoiser) return;
    ptie_free(denoiser->block);
    ptie_free(denoiser);
}

ptie_denoise_scratch ptie_denoise_slice(const ptie_denoiser *denoiser, void *scratch) {
    ptie_slicer slicer = {.base = scratch};
    const size_t pixels = (size_t)denoiser->width * (size_t)denoiser->height;
    ptie_denoise_scratch slices = {.part_bytes = ptie_stream_scratch(denoiser)};
    slices.image = ptie_slice(&slicer, pixels, sizeof(float));
    slices.rows = ptie_slice(&slicer, 4 * (size_t)denoiser->width, sizeof(double));
    slices.parts = ptie_slice(&slicer, (size_t)denoiser->parts, slices.part_bytes);
    slices.bytes = slicer.used;
    return slices;
}

size_t ptie_nn_denoiser_scratch(const ptie_denoiser *denoiser) {
    return ptie_denoise_slice(denoiser, NULL).bytes;
}

typedef struct frame {
    const ptie_denoiser *denoiser;
    float *clean;
    const float *noisy;
    ptie_denoise_scratch scratch;
} frame;

static ptie_status denoise_part(void *context, size_t part, int32_t worker) {
    const frame *f = context;
    (void)worker;
    ptie_stream_run(f->denoiser, f->clean, f->noisy, (int32_t)part,
                    f->scratch.parts + part * f->scratch.part_bytes);
    return PTIE_OK;
}

ptie_status ptie_denoise_finite(const ptie_denoiser *denoiser, float *clean, const float *noisy,
                                void *scratch) {
    frame f = {denoiser, clean, noisy, ptie_denoise_slice(denoiser, scratch)};
    if (!denoiser->pool) return denoise_part(&f, 0, 0);
    return ptie_pool_run(denoiser->pool, (size_t)denoiser->parts, denoise_part, &f);
}

ptie_status ptie_nn_denoise(const ptie_denoiser *denoiser, float *clean, const float *noisy,
                            void *scratch) {
    PTIE_TRY(ptie_image_finite(noisy, denoiser->width, denoiser->height, "noisy"));
    if (clean == noisy && denoiser->parts > 1) { /* a part reads rows that its neighbours write */
        const size_t pixels = (size_t)denoiser->width * (size_t)denoiser->height;
        noisy = memcpy(ptie_denoise_slice(denoiser, scratch).image, noisy, pixels * sizeof *noisy);
    }
    return ptie_denoise_finite(denoiser, clean, noisy, scratch);
}
