/* SPDX-License-Identifier: BSD-3-Clause */
/* Inference: BatchNorm folded into the convolutions, one frame on one thread in the caller's
 * memory. */
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
    ptie_conv3x3_pack(denoiser->packed[k], ptie_model_values(model, layer->params, PTIE_WEIGHT),
                      layer->out_channels, layer->in_channels, scale);
}

static size_t slice_block(ptie_denoiser *denoiser, void *block) {
    const ptie_graph *graph = &denoiser->graph;
    ptie_slicer slicer = {.base = block};
    for (int32_t k = 0; k < graph->layer_count; k++) {
        const int32_t in = graph->layers[k].in_channels, out = graph->layers[k].out_channels;
        denoiser->packed[k] = ptie_slice(&slicer, ptie_conv3x3_packed(out, in), sizeof(float));
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

/* A layer that is a skip writes straight into the input of the layer that joins it. */
static void lay_out(ptie_denoiser *denoiser, int32_t height, int32_t width) {
    const ptie_graph *graph = &denoiser->graph;
    for (int32_t k = 0; k < graph->layer_count; k++) denoiser->joined_by[k] = -1;
    for (int32_t k = 0; k < graph->layer_count; k++)
        if (graph->layers[k].input == PTIE_INPUT_JOIN)
            denoiser->joined_by[graph->layers[k].skip] = k;
    for (int32_t k = 0; k < graph->layer_count; k++) {
        const ptie_layer *layer = &graph->layers[k];
        const int32_t h = height >> layer->level, w = width >> layer->level;
        const bool own_input = layer->input != PTIE_INPUT_SAME;
        const bool own_output = denoiser->joined_by[k] < 0;
        ptie_layout_add(&denoiser->inputs, k, own_input ? layer->in_channels : 0, h, w);
        ptie_layout_add(&denoiser->outputs, k, own_output ? layer->out_channels : 0, h, w);
    }
}

ptie_status ptie_nn_denoiser(ptie_denoiser **out, const ptie_engine *engine,
                             const ptie_model *model, int32_t width, int32_t height) {
    const int32_t unit = 1 << (model->params.levels - 1);
    ptie_denoiser *denoiser;
    *out = NULL;
    if (model->params.in_channels != 1)
        return PTIE_FAIL(PTIE_ESIZE, "model '%s' wants other inputs (expected 1 channel, found %d)",
                         model->name, model->params.in_channels);
    PTIE_TRY(ptie_alloc_status(&denoiser, 1, sizeof *denoiser, "denoiser"));
    denoiser->kernels = engine->kernels;
    denoiser->graph = model->graph;
    denoiser->output = model->params.output;
    denoiser->width = width;
    denoiser->height = height;
    lay_out(denoiser, (height + unit - 1) / unit * unit, (width + unit - 1) / unit * unit);
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
    ptie_denoise_scratch slices;
    slices.inputs = ptie_slice(&slicer, denoiser->inputs.floats, sizeof(float));
    slices.outputs = ptie_slice(&slicer, denoiser->outputs.floats, sizeof(float));
    slices.image = ptie_slice(&slicer, pixels, sizeof(float));
    slices.bytes = slicer.used;
    return slices;
}

size_t ptie_nn_denoiser_scratch(const ptie_denoiser *denoiser) {
    return ptie_denoise_slice(denoiser, NULL).bytes;
}

/* Index i of a row of n pixels continued by reflection: ... 2 1 [0 1 2 .. n-1] n-2 n-3 ... */
static int32_t reflect(int32_t i, int32_t n) {
    if (n == 1) return 0;
    int32_t period = 2 * (n - 1), place = i % period;
    return place < n ? place : period - place;
}

/* Fills the input tensor: the frame, padded at the right and at the bottom. */
static void load_frame(const ptie_denoiser *denoiser, const ptie_map *input, const float *noisy) {
    const int32_t width = denoiser->width, height = denoiser->height;
    for (int32_t c = 0; c < input->channels; c++)
        for (int32_t y = 0; y < input->height; y++) {
            const float *from = noisy + ((ptrdiff_t)c * height + reflect(y, height)) * width;
            float *to = input->data + c * input->plane + y * input->row;
            for (int32_t x = 0; x < input->width; x++) to[x] = from[reflect(x, width)];
        }
}

static ptie_map input_of(const ptie_denoiser *denoiser, const ptie_denoise_scratch *scratch,
                         int32_t k);

static ptie_map output_of(const ptie_denoiser *denoiser, const ptie_denoise_scratch *scratch,
                          int32_t k) {
    const int32_t join = denoiser->joined_by[k], channels = denoiser->graph.layers[k].out_channels;
    if (join < 0) return ptie_layout_map(&denoiser->outputs, scratch->outputs, k);
    const ptie_map joint = input_of(denoiser, scratch, join);
    return ptie_map_channels(joint, joint.channels - channels, channels);
}

static ptie_map input_of(const ptie_denoiser *denoiser, const ptie_denoise_scratch *scratch,
                         int32_t k) {
    if (denoiser->graph.layers[k].input == PTIE_INPUT_SAME)
        return output_of(denoiser, scratch, k - 1);
    return ptie_layout_map(&denoiser->inputs, scratch->inputs, k);
}

static void run_layer(const ptie_denoiser *denoiser, const ptie_denoise_scratch *scratch,
                      int32_t k) {
    const ptie_kernels *kernels = denoiser->kernels;
    const ptie_layer *layer = &denoiser->graph.layers[k];
    const ptie_map in = input_of(denoiser, scratch, k), out = output_of(denoiser, scratch, k);
    if (layer->input == PTIE_INPUT_POOL || layer->input == PTIE_INPUT_JOIN) {
        const ptie_map before = output_of(denoiser, scratch, k - 1);
        const ptie_map made = ptie_map_channels(in, 0, before.channels);
        ptie_map_clear_halo(&made); /* the scratch may hold anything */
        if (layer->input == PTIE_INPUT_POOL)
            kernels->maxpool(&made, &before);
        else
            kernels->upsample(&made, &before, 0);
    }
    ptie_map_clear_halo(&out);
    kernels->conv3x3(&out, &in, denoiser->packed[k], denoiser->bias[k], true);
}

ptie_status ptie_nn_denoise(const ptie_denoiser *denoiser, float *clean, const float *noisy,
                            void *scratch) {
    const ptie_graph *graph = &denoiser->graph;
    PTIE_TRY(ptie_image_finite(noisy, denoiser->width, denoiser->height, "noisy"));
    const ptie_denoise_scratch slices = ptie_denoise_slice(denoiser, scratch);
    const ptie_map input = input_of(denoiser, &slices, 0);
    ptie_map_clear_halo(&input);
    load_frame(denoiser, &input, noisy);
    for (int32_t k = 0; k < graph->layer_count; k++) run_layer(denoiser, &slices, k);
    ptie_map last = output_of(denoiser, &slices, graph->layer_count - 1);
    last.width = denoiser->width; /* the crop */
    last.height = denoiser->height;
    const ptie_map image = {clean, 1, last.height, last.width, last.width, 0};
    denoiser->kernels->conv1x1(&image, &last, denoiser->head, denoiser->head + last.channels);
    if (denoiser->output == PTIE_SIGMOID) denoiser->kernels->sigmoid(&image, &image);
    return PTIE_OK;
}
