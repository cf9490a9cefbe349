/* SPDX-License-Identifier: BSD-3-Clause */
/* Backward through the network, docs/math.md (N1)-(N7).  A tensor's gradient is overwritten by the
 * first operation that brings it; the maximum, which reads a skip that the decoder has read too,
 * adds.
 */
#include <string.h>

#include "nn/loss.h"
#include "nn/stepper.h"

/* Loss of a sample, and its gradient with respect to the network's output. */
static void start(const ptie_stepper *stepper, size_t index, int32_t worker) {
    const ptie_sample_state *sample = &stepper->samples[index];
    const ptie_view output = stepper->model->graph.output;
    const ptie_map y = ptie_layout_view(&stepper->tensors, sample->tensors, output);
    const ptie_map grad = ptie_layout_view(&stepper->tensors, sample->gradients, output);
    float *estimate = stepper->images[worker];
    float *gradient = estimate + (size_t)stepper->height * (size_t)stepper->width;
    ptie_map_store(estimate, &y);
    ptie_loss_evaluate(stepper->engine->kernels, &stepper->parts[index], gradient, estimate,
                       sample->clean, stepper->width, stepper->height, stepper->loss,
                       1.0 / stepper->count, stepper->loss_scratch[worker]);
    ptie_map_load(&grad, gradient);
}

/* grad *= y (1 - y) */
static void sigmoid_backward(const ptie_map *grad, const ptie_map *y) {
    for (int32_t row = 0; row < y->height; row++) {
        const float *value = y->data + row * y->row;
        float *g = grad->data + row * grad->row;
        for (int32_t x = 0; x < y->width; x++) g[x] *= value[x] * (1 - value[x]);
    }
}

static void backward_op(const ptie_stepper *stepper, const ptie_op *op, size_t index) {
    const ptie_kernels *kernels = stepper->engine->kernels;
    const ptie_sample_state *sample = &stepper->samples[index];
    const ptie_map in = ptie_layout_view(&stepper->tensors, sample->tensors, op->in);
    const ptie_map out = ptie_layout_view(&stepper->tensors, sample->tensors, op->out);
    const ptie_map in_grad = ptie_layout_view(&stepper->tensors, sample->gradients, op->in);
    const ptie_map out_grad = ptie_layout_view(&stepper->tensors, sample->gradients, op->out);
    switch (op->kind) {
    case PTIE_OP_CONV: break; /* unconvolve */
    case PTIE_OP_POOL: kernels->maxpool_backward(&in_grad, &out_grad, &in, &out); break;
    case PTIE_OP_UPSAMPLE: kernels->upsample_backward(&in_grad, &out_grad); break;
    case PTIE_OP_DROPOUT: ptie_dropout(stepper, &out_grad, index); break;
    case PTIE_OP_HEAD:
        if (stepper->model->params.output == PTIE_SIGMOID) sigmoid_backward(&out_grad, &out);
        kernels->conv1x1_weights(sample->weights, sample->weights + in.channels, &out_grad, &in);
        /* With one output the adjoint has the same weights in the same order. */
        kernels->conv1x1(&in_grad, &out_grad, ptie_model_values(stepper->model, op, PTIE_WEIGHT),
                         NULL);
        break;
    }
}

/* From the gradient behind a convolution's ReLU to those of its weights and its input. */
static void unconvolve(const ptie_stepper *stepper, const ptie_op *op, ptie_sample_state *sample) {
    const ptie_kernels *kernels = stepper->engine->kernels;
    const ptie_map in = ptie_layout_view(&stepper->tensors, sample->tensors, op->in);
    const ptie_map z = ptie_layout_map(&stepper->convs, sample->convs, op->conv);
    const ptie_map grad = ptie_layout_view(&stepper->tensors, sample->gradients, op->out);
    const ptie_map in_grad = ptie_layout_view(&stepper->tensors, sample->gradients, op->in);
    for (int32_t y = 0; y < z.height; y += PTIE_BAND_ROWS) {
        int32_t rows = z.height - y < PTIE_BAND_ROWS ? z.height - y : PTIE_BAND_ROWS;
        const ptie_map band = ptie_map_rows(grad, y, rows), z_band = ptie_map_rows(z, y, rows);
        const ptie_map in_band = ptie_map_rows(in, y, rows);
        kernels->normalise_backward(&band, &z_band, stepper->norms[op->conv]);
        kernels->conv3x3_weights(sample->weights, &band, &in_band, NULL);
    }
    if (op->in.tensor != stepper->model->graph.input.tensor)
        kernels->conv3x3(&in_grad, &grad, stepper->packed_adjoint[op->conv], NULL, false);
}

/* Sums that BatchNorm's gradient needs from the whole batch. */
static void sum_gradients(const ptie_stepper *stepper, const ptie_op *op,
                          ptie_sample_state *sample) {
    const ptie_map z = ptie_layout_map(&stepper->convs, sample->convs, op->conv);
    const ptie_map grad = ptie_layout_view(&stepper->tensors, sample->gradients, op->out);
    memset(sample->sums, 0, 2 * (size_t)z.channels * sizeof *sample->sums);
    stepper->engine->kernels->normalise_sums(sample->sums, &grad, &z, stepper->norms[op->conv]);
}

ptie_status ptie_backward_section(void *context, size_t index, int32_t worker) {
    const ptie_stepper *stepper = context;
    const ptie_graph *graph = &stepper->model->graph;
    ptie_sample_state *sample = &stepper->samples[index];
    const int32_t section = stepper->section;
    memset(sample->weights, 0, stepper->total_count * sizeof *sample->weights);
    if (section == graph->conv_count)
        start(stepper, index, worker);
    else
        unconvolve(stepper, ptie_stepper_conv(stepper, section), sample);
    for (int32_t i = ptie_section_last(stepper, section);
         i-- > ptie_section_first(stepper, section);)
        backward_op(stepper, &graph->ops[i], index);
    if (section > 0) sum_gradients(stepper, ptie_stepper_conv(stepper, section - 1), sample);
    return PTIE_OK;
}

/* Gradient of a weight tensor: the samples' parts, in their order. */
static void join_weights(ptie_stepper *stepper, const ptie_param *param, size_t from) {
    memset(stepper->total, 0, param->count * sizeof *stepper->total);
    for (int32_t n = 0; n < stepper->count; n++)
        for (size_t i = 0; i < param->count; i++)
            stepper->total[i] += stepper->samples[n].weights[from + i];
    for (size_t i = 0; i < param->count; i++)
        stepper->state[0][param->offset + i] = (float)stepper->total[i];
}

/* Gradients of gamma and beta, and the batch means that the gradient of z needs (N3). */
static void join_norms(ptie_stepper *stepper, const ptie_op *op) {
    const ptie_param *params = &stepper->model->graph.params[op->params];
    const ptie_map *z = &stepper->convs.maps[op->conv];
    const double pixels = (double)stepper->count * z->height * z->width;
    for (int32_t c = 0; c < op->out.channels; c++) {
        double g = 0, gx = 0;
        for (int32_t n = 0; n < stepper->count; n++) {
            g += stepper->samples[n].sums[2 * c];
            gx += stepper->samples[n].sums[2 * c + 1];
        }
        stepper->state[0][params[PTIE_BETA].offset + (size_t)c] = (float)g;
        stepper->state[0][params[PTIE_GAMMA].offset + (size_t)c] = (float)gx;
        stepper->norms[op->conv][c].mean_g = (float)(g / pixels);
        stepper->norms[op->conv][c].mean_gx = (float)(gx / pixels);
    }
}

void ptie_backward_join(ptie_stepper *stepper) {
    const ptie_graph *graph = &stepper->model->graph;
    const int32_t section = stepper->section;
    if (section == graph->conv_count) {
        const ptie_op *head = &graph->ops[graph->op_count - 1];
        const ptie_param *params = &graph->params[head->params];
        join_weights(stepper, &params[PTIE_WEIGHT], 0);
        join_weights(stepper, &params[PTIE_BIAS], params[PTIE_WEIGHT].count);
    } else {
        join_weights(stepper, &graph->params[ptie_stepper_conv(stepper, section)->params], 0);
    }
    if (section > 0) join_norms(stepper, ptie_stepper_conv(stepper, section - 1));
}
