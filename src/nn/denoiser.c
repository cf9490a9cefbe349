/* SPDX-License-Identifier: BSD-3-Clause */
/* Inference: BatchNorm folded into the convolutions, one frame on one thread in the caller's
 * memory. */
#include "nn/denoiser.h"

#include <math.h>

#include "base/image.h"
#include "base/memory.h"

/* Folds the running statistics into weights and bias (N2). */
static void fold(ptie_denoiser *denoiser, const ptie_model *model, const ptie_op *op) {
    const float *gamma = ptie_model_values(model, op, PTIE_GAMMA);
    const float *beta = ptie_model_values(model, op, PTIE_BETA);
    const float *mean = ptie_model_values(model, op, PTIE_MEAN);
    const float *variance = ptie_model_values(model, op, PTIE_VARIANCE);
    float scale[512];
    for (int32_t c = 0; c < op->out.channels; c++) {
        double s = (double)gamma[c] / sqrt((double)variance[c] + model->params.bn_epsilon);
        scale[c] = (float)s;
        denoiser->bias[op->conv][c] = (float)((double)beta[c] - s * (double)mean[c]);
    }
    ptie_conv3x3_pack(denoiser->packed[op->conv], ptie_model_values(model, op, PTIE_WEIGHT),
                      op->out.channels, op->in.channels, scale);
}

static size_t slice_block(ptie_denoiser *denoiser, void *block) {
    ptie_slicer slicer = {.base = block};
    for (int32_t i = 0; i < denoiser->graph.op_count; i++) {
        const ptie_op *op = &denoiser->graph.ops[i];
        const int32_t in = op->in.channels, out = op->out.channels;
        if (op->kind == PTIE_OP_HEAD)
            denoiser->head = ptie_slice(&slicer, (size_t)in + 1, sizeof(float));
        if (op->kind != PTIE_OP_CONV) continue;
        denoiser->packed[op->conv] =
            ptie_slice(&slicer, ptie_conv3x3_packed(out, in), sizeof(float));
        denoiser->bias[op->conv] = ptie_slice(&slicer, (size_t)out, sizeof(float));
    }
    return slicer.used;
}

static void copy_weights(ptie_denoiser *denoiser, const ptie_model *model) {
    for (int32_t i = 0; i < model->graph.op_count; i++) {
        const ptie_op *op = &model->graph.ops[i];
        if (op->kind == PTIE_OP_CONV) fold(denoiser, model, op);
        if (op->kind != PTIE_OP_HEAD) continue;
        for (int32_t c = 0; c < op->in.channels; c++)
            denoiser->head[c] = ptie_model_values(model, op, PTIE_WEIGHT)[c];
        denoiser->head[op->in.channels] = *ptie_model_values(model, op, PTIE_BIAS);
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
    ptie_layout_tensors(&denoiser->tensors, &model->graph, (height + unit - 1) / unit * unit,
                        (width + unit - 1) / unit * unit);
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
    slices.tensors = ptie_slice(&slicer, denoiser->tensors.floats, sizeof(float));
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

static void run_op(const ptie_denoiser *denoiser, const ptie_op *op, float *block) {
    const ptie_kernels *kernels = denoiser->kernels;
    const ptie_map in = ptie_layout_view(&denoiser->tensors, block, op->in);
    const ptie_map out = ptie_layout_view(&denoiser->tensors, block, op->out);
    if (op->kind != PTIE_OP_DROPOUT) ptie_map_clear_halo(&out); /* the scratch may hold anything */
    switch (op->kind) {
    case PTIE_OP_CONV:
        kernels->conv3x3(&out, &in, denoiser->packed[op->conv], denoiser->bias[op->conv], true);
        break;
    case PTIE_OP_POOL: kernels->maxpool(&out, &in); break;
    case PTIE_OP_UPSAMPLE: kernels->upsample(&out, &in); break;
    case PTIE_OP_DROPOUT: break;
    case PTIE_OP_HEAD:
        kernels->conv1x1(&out, &in, denoiser->head, denoiser->head + in.channels);
        if (denoiser->output == PTIE_SIGMOID) kernels->sigmoid(&out, &out);
        break;
    }
}

ptie_status ptie_nn_denoise(const ptie_denoiser *denoiser, float *clean, const float *noisy,
                            void *scratch) {
    const ptie_graph *graph = &denoiser->graph;
    PTIE_TRY(ptie_image_finite(noisy, denoiser->width, denoiser->height * graph->input.channels,
                               "noisy"));
    float *block = ptie_denoise_slice(denoiser, scratch).tensors;
    const ptie_map input = ptie_layout_view(&denoiser->tensors, block, graph->input);
    ptie_map_clear_halo(&input);
    load_frame(denoiser, &input, noisy);
    for (int32_t i = 0; i < graph->op_count; i++) run_op(denoiser, &graph->ops[i], block);
    ptie_map output = ptie_layout_view(&denoiser->tensors, block, graph->output);
    output.width = denoiser->width; /* the crop */
    output.height = denoiser->height;
    ptie_map_store(clean, &output);
    return PTIE_OK;
}
