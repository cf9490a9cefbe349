/* SPDX-License-Identifier: BSD-3-Clause */
/* The training step: memory of a batch, and the walk forward and backward in sections. */
#include "nn/stepper.h"

#include <assert.h>

#include "base/memory.h"
#include "nn/adamw.h"

/* Longest gradient that a sample sums up in one section. */
static size_t longest_weights(const ptie_graph *graph) {
    size_t longest = 0;
    for (int32_t i = 0; i < graph->param_count; i++)
        if (graph->params[i].count > longest) longest = graph->params[i].count;
    return longest + 1; /* the head's bias follows its weights */
}

static int32_t most_channels(const ptie_graph *graph) {
    int32_t most = 0;
    for (int32_t t = 0; t < graph->tensor_count; t++)
        if (graph->tensors[t].channels > most) most = graph->tensors[t].channels;
    return most;
}

static void slice_convs(ptie_stepper *stepper, ptie_slicer *slicer) {
    const ptie_graph *graph = &stepper->model->graph;
    for (int32_t k = 0; k < graph->conv_count; k++) {
        const ptie_op *op = ptie_stepper_conv(stepper, k);
        const int32_t in = op->in.channels, out = op->out.channels;
        stepper->packed[k] = ptie_slice(slicer, ptie_conv3x3_packed(out, in), sizeof(float));
        stepper->packed_adjoint[k] =
            ptie_slice(slicer, ptie_conv3x3_packed(in, out), sizeof(float));
        stepper->norms[k] = ptie_slice(slicer, (size_t)out, sizeof(ptie_norm));
    }
}

static void slice_sample(const ptie_stepper *stepper, ptie_slicer *slicer,
                         ptie_sample_state *sample) {
    const ptie_graph *graph = &stepper->model->graph;
    const size_t pixels = (size_t)stepper->height * (size_t)stepper->width;
    *sample = (ptie_sample_state){
        .noisy = ptie_slice(slicer, pixels * (size_t)graph->input.channels, sizeof(float)),
        .clean = ptie_slice(slicer, pixels, sizeof(float)),
        .tensors = ptie_slice(slicer, stepper->tensors.floats, sizeof(float)),
        .convs = ptie_slice(slicer, stepper->convs.floats, sizeof(float)),
        .gradients = ptie_slice(slicer, stepper->tensors.floats, sizeof(float)),
        .sums = ptie_slice(slicer, 2 * (size_t)most_channels(graph), sizeof(double)),
        .weights = ptie_slice(slicer, stepper->total_count, sizeof(double)),
    };
}

/* Hands out the block; with no block it only counts. */
static size_t slice_block(ptie_stepper *stepper, void *block) {
    const ptie_graph *graph = &stepper->model->graph;
    const size_t pixels = (size_t)stepper->height * (size_t)stepper->width;
    ptie_slicer slicer = {.base = block};
    slice_convs(stepper, &slicer);
    for (int i = 0; i < 3; i++)
        stepper->state[i] = ptie_slice(&slicer, graph->trainable, sizeof(float));
    stepper->total = ptie_slice(&slicer, stepper->total_count, sizeof(double));
    const int32_t threads = ptie_pool_threads(stepper->engine->pool);
    for (int32_t i = 0; i < threads; i++) {
        stepper->images[i] = ptie_slice(&slicer, 2 * pixels, sizeof(float));
        stepper->loss_scratch[i] =
            ptie_slice(&slicer, ptie_loss_scratch(stepper->width, stepper->height), 1);
    }
    for (int32_t n = 0; n < stepper->batch; n++)
        slice_sample(stepper, &slicer, &stepper->samples[n]);
    return slicer.used;
}

static ptie_status allocate(ptie_stepper *stepper) {
    static const char where[] = "training step";
    const size_t threads = (size_t)ptie_pool_threads(stepper->engine->pool);
    const size_t batch = (size_t)stepper->batch;
    PTIE_TRY(ptie_alloc_status(&stepper->samples, batch, sizeof *stepper->samples, where));
    PTIE_TRY(ptie_alloc_status(&stepper->images, threads, sizeof *stepper->images, where));
    PTIE_TRY(
        ptie_alloc_status(&stepper->loss_scratch, threads, sizeof *stepper->loss_scratch, where));
    PTIE_TRY(ptie_alloc_status(&stepper->block, slice_block(stepper, NULL), 1, where));
    slice_block(stepper, stepper->block);
    return PTIE_OK;
}

ptie_status ptie_stepper_create(ptie_stepper **out, const ptie_engine *engine, ptie_model *model,
                                int32_t batch, int32_t width, int32_t height,
                                ptie_loss_weights weights) {
    const ptie_graph *graph = &model->graph;
    const int32_t unit = 1 << (model->params.levels - 1);
    *out = NULL;
    if (width % unit || height % unit || width < PTIE_SSIM_WINDOW || height < PTIE_SSIM_WINDOW)
        return PTIE_FAIL(
            PTIE_ESIZE,
            "training: sample size does not fit %s (expected multiples of %d from %d on, "
            "found %d x %d)",
            model->name, unit, PTIE_SSIM_WINDOW, width, height);
    ptie_stepper *stepper;
    PTIE_TRY(ptie_alloc_status(&stepper, 1, sizeof *stepper, "training step"));
    stepper->engine = engine;
    stepper->model = model;
    stepper->loss = weights;
    stepper->batch = batch;
    stepper->height = height;
    stepper->width = width;
    stepper->total_count = longest_weights(graph);
    ptie_layout_tensors(&stepper->tensors, graph, height, width);
    ptie_layout_convs(&stepper->convs, graph, height, width);
    for (int32_t i = 0; i < graph->op_count; i++)
        if (graph->ops[i].kind == PTIE_OP_CONV) stepper->conv_ops[graph->ops[i].conv] = i;
    ptie_status status = allocate(stepper);
    if (status == PTIE_OK)
        *out = stepper;
    else
        ptie_stepper_free(stepper);
    return status;
}

void ptie_stepper_free(ptie_stepper *stepper) {
    if (!stepper) return;
    ptie_free(stepper->block);
    ptie_free(stepper->loss_scratch);
    ptie_free(stepper->images);
    ptie_free(stepper->samples);
    ptie_free(stepper);
}

float *ptie_stepper_noisy(ptie_stepper *stepper, int32_t i) {
    return stepper->samples[i].noisy;
}

float *ptie_stepper_clean(ptie_stepper *stepper, int32_t i) {
    return stepper->samples[i].clean;
}

float *ptie_stepper_state(ptie_stepper *stepper, int which, const char *name, size_t *count) {
    const ptie_param *param = ptie_graph_find(&stepper->model->graph, name);
    if (!param || !param->trainable) return NULL;
    *count = param->count;
    return stepper->state[which] + param->offset;
}

static void pack_weights(ptie_stepper *stepper) {
    for (int32_t k = 0; k < stepper->model->graph.conv_count; k++) {
        const ptie_op *op = ptie_stepper_conv(stepper, k);
        const float *weights = ptie_model_values(stepper->model, op, PTIE_WEIGHT);
        ptie_conv3x3_pack(stepper->packed[k], weights, op->out.channels, op->in.channels, NULL);
        ptie_conv3x3_pack_adjoint(stepper->packed_adjoint[k], weights, op->out.channels,
                                  op->in.channels);
    }
}

ptie_status ptie_stepper_gradients(ptie_stepper *stepper, int32_t count, uint64_t seed,
                                   uint64_t step, ptie_loss_parts *parts) {
    assert(count >= 1 && count <= stepper->batch);
    ptie_pool *pool = stepper->engine->pool;
    const int32_t sections = stepper->model->graph.conv_count + 1;
    stepper->count = count;
    stepper->seed = seed;
    stepper->step = step;
    stepper->parts = parts;
    pack_weights(stepper);
    for (stepper->section = 0; stepper->section < sections; stepper->section++) {
        PTIE_TRY(ptie_pool_run(pool, (size_t)count, ptie_forward_section, stepper));
        ptie_forward_join(stepper);
    }
    for (stepper->section = sections; stepper->section-- > 0;) {
        PTIE_TRY(ptie_pool_run(pool, (size_t)count, ptie_backward_section, stepper));
        ptie_backward_join(stepper);
    }
    return PTIE_OK;
}

void ptie_stepper_update(ptie_stepper *stepper, const ptie_adamw *adamw, uint64_t step) {
    ptie_adamw_apply(stepper->model->values, stepper->state[1], stepper->state[2],
                     stepper->state[0], stepper->model->graph.trainable, adamw, step);
}
