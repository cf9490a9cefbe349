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

static size_t most_channels(const ptie_graph *graph) {
    int32_t most = 0;
    for (int32_t k = 0; k < graph->layer_count; k++)
        if (graph->layers[k].out_channels > most) most = graph->layers[k].out_channels;
    return (size_t)most;
}

/* Rows of a band: as many as keep what it touches in the second-level cache, a multiple of the
   convolution's strips. */
static int32_t band_rows(const ptie_layer *layer, int32_t height, int32_t width) {
    const int64_t cache_floats = 96 * 1024, strip = PTIE_WINOGRAD_ROWS;
    const int64_t row = (int64_t)(2 * layer->in_channels + layer->out_channels) * width;
    const int64_t fits = cache_floats / row / strip * strip;
    return (int32_t)(fits < strip ? strip : fits < height ? fits : height);
}

static void lay_out_layer(ptie_stepper *stepper, int32_t k) {
    const ptie_graph *graph = &stepper->model->graph;
    const ptie_layer *layer = &graph->layers[k];
    const int32_t height = stepper->height >> layer->level, width = stepper->width >> layer->level;
    const int32_t rows = stepper->rows[k] = band_rows(layer, height, width);
    const int32_t last = graph->layer_count - 1;
    const bool join = layer->input == PTIE_INPUT_JOIN, pool = layer->input == PTIE_INPUT_POOL;
    ptie_nn_layout_add(&stepper->z, k, layer->out_channels, height, width);
    ptie_nn_layout_add(&stepper->gradients, k, k == last ? 0 : layer->out_channels, height, width);
    ptie_nn_layout_add(&stepper->coarse, k, join ? graph->layers[k - 1].out_channels : 0, height / 2,
                    width / 2);
    ptie_nn_layout_add(&stepper->input, k, layer->in_channels, rows + 2, width);
    ptie_nn_layout_add(&stepper->z_grad, k, layer->out_channels, rows + 2, width);
    ptie_nn_layout_add(&stepper->in_grad, k, join || pool ? layer->in_channels : 0, rows, width);
    ptie_nn_layout_add(&stepper->finer, k, pool ? layer->in_channels : 0, 2 * (rows + 2), 2 * width);
}

static void slice_layers(ptie_stepper *stepper, ptie_slicer *slicer) {
    const ptie_graph *graph = &stepper->model->graph;
    for (int32_t k = 0; k < graph->layer_count; k++) {
        const int32_t in = graph->layers[k].in_channels, out = graph->layers[k].out_channels;
        stepper->packed[k] = ptie_slice(slicer, ptie_winograd_packed(out, in), sizeof(float));
        stepper->packed_adjoint[k] =
            ptie_slice(slicer, ptie_winograd_packed(in, out), sizeof(float));
        stepper->norms[k] = ptie_slice(slicer, (size_t)out, sizeof(ptie_norm));
    }
}

static void slice_sample(const ptie_stepper *stepper, ptie_slicer *slicer,
                         ptie_sample_state *sample) {
    const size_t pixels = (size_t)stepper->height * (size_t)stepper->width;
    const size_t inputs = (size_t)stepper->model->params.in_channels;
    *sample = (ptie_sample_state){
        .noisy = {ptie_slice(slicer, pixels * inputs, sizeof(float)),
                  ptie_slice(slicer, pixels * inputs, sizeof(float))},
        .clean = {ptie_slice(slicer, pixels, sizeof(float)),
                  ptie_slice(slicer, pixels, sizeof(float))},
        .z = ptie_slice(slicer, stepper->z.floats, sizeof(float)),
        .gradients = ptie_slice(slicer, stepper->gradients.floats, sizeof(float)),
        .coarse = ptie_slice(slicer, stepper->coarse.floats, sizeof(float)),
        .slope = ptie_slice(slicer, pixels, sizeof(float)),
        .sums = ptie_slice(slicer, 2 * stepper->most_channels, sizeof(double)),
        .weights = ptie_slice(slicer, stepper->total_count, sizeof(double)),
    };
}

static size_t scratch_floats(const ptie_graph *graph) {
    size_t most = 0;
    for (int32_t k = 0; k < graph->layer_count; k++) {
        const int32_t in = graph->layers[k].in_channels, out = graph->layers[k].out_channels;
        const size_t forward = ptie_winograd_scratch(out, in),
                     backward = ptie_winograd_scratch(in, out);
        if (forward > most) most = forward;
        if (backward > most) most = backward;
    }
    return most;
}

static void slice_workspace(const ptie_stepper *stepper, ptie_slicer *slicer,
                            ptie_workspace *workspace) {
    const size_t pixels = (size_t)stepper->height * (size_t)stepper->width;
    *workspace = (ptie_workspace){
        .input = ptie_slice(slicer, stepper->input.floats, sizeof(float)),
        .z_grad = ptie_slice(slicer, stepper->z_grad.floats, sizeof(float)),
        .in_grad = ptie_slice(slicer, stepper->in_grad.floats, sizeof(float)),
        .finer = ptie_slice(slicer, stepper->finer.floats, sizeof(float)),
        .scratch = ptie_slice(slicer, scratch_floats(&stepper->model->graph), sizeof(float)),
        .estimate = ptie_slice(slicer, pixels, sizeof(float)),
        .loss = ptie_slice(slicer, ptie_loss_scratch(stepper->width, stepper->height), 1),
    };
}

/* Hands out the block; with no block it only counts. */
static size_t slice_block(ptie_stepper *stepper, void *block) {
    const ptie_graph *graph = &stepper->model->graph;
    ptie_slicer slicer = {.base = block};
    slice_layers(stepper, &slicer);
    for (int i = 0; i < 3; i++)
        stepper->state[i] = ptie_slice(&slicer, graph->trainable, sizeof(float));
    stepper->total = ptie_slice(&slicer, stepper->total_count, sizeof(double));
    for (int32_t i = 0; i < ptie_pool_threads(stepper->engine->pool); i++)
        slice_workspace(stepper, &slicer, &stepper->workspaces[i]);
    for (int32_t n = 0; n < stepper->batch; n++)
        slice_sample(stepper, &slicer, &stepper->samples[n]);
    return slicer.used;
}

static ptie_status allocate(ptie_stepper *stepper) {
    static const char where[] = "training step";
    const size_t threads = (size_t)ptie_pool_threads(stepper->engine->pool);
    const size_t batch = (size_t)stepper->batch;
    PTIE_TRY(ptie_alloc_status(&stepper->samples, batch, sizeof *stepper->samples, where));
    PTIE_TRY(ptie_alloc_status(&stepper->workspaces, threads, sizeof *stepper->workspaces, where));
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
    stepper->most_channels = most_channels(graph);
    for (int32_t k = 0; k < graph->layer_count; k++) lay_out_layer(stepper, k);
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
    ptie_free(stepper->workspaces);
    ptie_free(stepper->samples);
    ptie_free(stepper);
}

float *ptie_stepper_noisy(ptie_stepper *stepper, int32_t i, bool ahead) {
    return stepper->samples[i].noisy[ahead];
}

float *ptie_stepper_clean(ptie_stepper *stepper, int32_t i, bool ahead) {
    return stepper->samples[i].clean[ahead];
}

static void swap(float *pair[2]) {
    float *const first = pair[0];
    pair[0] = pair[1];
    pair[1] = first;
}

void ptie_stepper_advance(ptie_stepper *stepper) {
    for (int32_t n = 0; n < stepper->batch; n++) {
        swap(stepper->samples[n].noisy);
        swap(stepper->samples[n].clean);
    }
}

float *ptie_stepper_state(ptie_stepper *stepper, int which, const char *name, size_t *count) {
    const ptie_param *param = ptie_graph_find(&stepper->model->graph, name);
    if (!param || !param->trainable) return NULL;
    *count = param->count;
    return stepper->state[which] + param->offset;
}

static void pack_weights(ptie_stepper *stepper) {
    const ptie_graph *graph = &stepper->model->graph;
    for (int32_t k = 0; k < graph->layer_count; k++) {
        const ptie_layer *layer = &graph->layers[k];
        const float *weights = ptie_model_values(stepper->model, layer->params, PTIE_WEIGHT);
        ptie_winograd_pack(stepper->packed[k], weights, layer->out_channels, layer->in_channels,
                           NULL);
        ptie_winograd_pack_adjoint(stepper->packed_adjoint[k], weights, layer->out_channels,
                                   layer->in_channels);
    }
}

/* The samples of the section first, then what the caller has put beside. */
static ptie_status run_task(void *context, size_t index, int32_t worker) {
    ptie_stepper *stepper = context;
    const size_t samples = (size_t)stepper->count;
    if (index < samples) return stepper->task(stepper, index, worker);
    return stepper->aside.task(stepper->aside.context, index - samples, worker);
}

static ptie_status run_section(ptie_stepper *stepper, ptie_task task) {
    stepper->task = task;
    const size_t count = (size_t)stepper->count + stepper->aside.count;
    PTIE_TRY(ptie_pool_run(stepper->engine->pool, count, run_task, stepper));
    stepper->aside.count = 0; /* done with the first section */
    return PTIE_OK;
}

ptie_status ptie_stepper_gradients(ptie_stepper *stepper, int32_t count, uint64_t seed,
                                   uint64_t step, ptie_loss_parts *parts, const ptie_aside *aside) {
    assert(count >= 1 && count <= stepper->batch);
    const int32_t layers = stepper->model->graph.layer_count;
    stepper->count = count;
    stepper->seed = seed;
    stepper->step = step;
    stepper->parts = parts;
    stepper->aside = aside ? *aside : (ptie_aside){0};
    pack_weights(stepper);
    for (stepper->section = 0; stepper->section < layers; stepper->section++) {
        PTIE_TRY(run_section(stepper, ptie_forward_layer));
        ptie_forward_join(stepper);
    }
    PTIE_TRY(run_section(stepper, ptie_head));
    ptie_head_join(stepper);
    for (stepper->section = layers; stepper->section-- > 0;) {
        PTIE_TRY(run_section(stepper, ptie_backward_layer));
        ptie_backward_join(stepper);
    }
    return PTIE_OK;
}

void ptie_stepper_update(ptie_stepper *stepper, const ptie_adamw *adamw, uint64_t step) {
    ptie_adamw_apply(stepper->model->values, stepper->state[1], stepper->state[2],
                     stepper->state[0], stepper->model->graph.trainable, adamw, step);
}
