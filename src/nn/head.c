/* SPDX-License-Identifier: BSD-3-Clause */
/* The end of the network in training: head, loss, and the way back to the last layer, docs/math.md
 * (N6), (L1)-(L4). */
#include <string.h>

#include "nn/loss.h"
#include "nn/stepper.h"

/* Some rows of a contiguous image as a map. */
static ptie_map image_rows(const ptie_stepper *stepper, float *image, int32_t first, int32_t rows) {
    return (ptie_map){
        image + (size_t)first * (size_t)stepper->width, 1, rows, stepper->width, stepper->width, 0};
}

/* Output of the last layer, the band's (N2).  Its input's memory is free by now, and as large: it
   is the second convolution of its stage. */
static ptie_map activate(const ptie_stepper *stepper, const ptie_band *band) {
    const ptie_map z = ptie_z_rows(stepper, band->sample, band->layer, band->first, band->rows);
    const ptie_map out = ptie_map_rows(
        ptie_nn_layout_map(&stepper->input, band->workspace->input, band->layer), 0, band->rows);
    stepper->engine->kernels->normalise(&out, &z, stepper->norms[band->layer]);
    return out;
}

static void run_head(const ptie_stepper *stepper, ptie_band band) {
    const ptie_kernels *kernels = stepper->engine->kernels;
    const ptie_model *model = stepper->model;
    for (; band.rows > 0; ptie_band_next(stepper, &band)) {
        const ptie_map in = activate(stepper, &band);
        const ptie_map out = image_rows(stepper, band.workspace->estimate, band.first, band.rows);
        kernels->conv1x1(&out, &in, ptie_model_values(model, model->graph.head, PTIE_WEIGHT),
                         ptie_model_values(model, model->graph.head, PTIE_BIAS));
        if (model->params.output == PTIE_SIGMOID) kernels->sigmoid(&out, &out);
    }
}

/* slope *= y (1 - y) */
static void sigmoid_backward(float *slope, const float *y, size_t count) {
    for (size_t i = 0; i < count; i++) slope[i] *= y[i] * (1 - y[i]);
}

void ptie_head_gradient(const ptie_stepper *stepper, const ptie_sample_state *sample,
                        const ptie_map *grad, int32_t first) {
    const float *weights =
        ptie_model_values(stepper->model, stepper->model->graph.head, PTIE_WEIGHT);
    const ptie_map slope = image_rows(stepper, sample->slope, first, grad->height);
    /* With one output the adjoint has the same weights in the same order. */
    stepper->engine->kernels->conv1x1(grad, &slope, weights, NULL);
}

static void run_back(const ptie_stepper *stepper, ptie_band band) {
    const ptie_kernels *kernels = stepper->engine->kernels;
    const ptie_graph *graph = &stepper->model->graph;
    const int32_t last = band.layer, channels = graph->layers[last].out_channels;
    double *const grads = band.sample->weights, *const sums = band.sample->sums;
    memset(grads, 0, ((size_t)channels + 1) * sizeof *grads);
    memset(sums, 0, 2 * (size_t)channels * sizeof *sums);
    for (; band.rows > 0; ptie_band_next(stepper, &band)) {
        const ptie_map in = activate(stepper, &band);
        const ptie_map slope = image_rows(stepper, band.sample->slope, band.first, band.rows);
        const ptie_map z = ptie_z_rows(stepper, band.sample, last, band.first, band.rows);
        const ptie_map grad = ptie_map_rows(
            ptie_nn_layout_map(&stepper->z_grad, band.workspace->z_grad, last), 0, band.rows);
        kernels->conv1x1_weights(grads, grads + channels, &slope, &in);
        ptie_head_gradient(stepper, band.sample, &grad, band.first);
        kernels->normalise_sums(sums, &grad, &z, stepper->norms[last]);
    }
}

ptie_status ptie_head(void *context, size_t index, int32_t worker) {
    const ptie_stepper *stepper = context;
    const int32_t last = stepper->model->graph.layer_count - 1;
    const ptie_workspace *workspace = &stepper->workspaces[worker];
    const ptie_band band = ptie_band_first(stepper, last, index, worker);
    run_head(stepper, band);
    ptie_loss_evaluate(stepper->engine->kernels, &stepper->parts[index], band.sample->slope,
                       workspace->estimate, band.sample->clean[0], stepper->width, stepper->height,
                       stepper->loss, 1.0 / stepper->count, workspace->loss);
    if (stepper->model->params.output == PTIE_SIGMOID)
        sigmoid_backward(band.sample->slope, workspace->estimate,
                         (size_t)stepper->width * (size_t)stepper->height);
    run_back(stepper, band);
    return PTIE_OK;
}
