/* SPDX-License-Identifier: BSD-3-Clause */
/* Forward through the network in training mode, docs/math.md (N1)-(N7). */
#include <math.h>
#include <string.h>

#include "base/random.h"
#include "nn/stepper.h"

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
        for (int32_t y = 0; y < map->height; y++) {
            float *row = map->data + c * map->plane + y * map->row;
            for (int32_t x = 0; x < map->width; x++)
                row[x] *= ptie_random_u32(&random) < threshold ? 0 : kept;
        }
}

/* Convolution and the sums of its result, band by band. */
static void convolve(const ptie_stepper *stepper, const ptie_op *op, ptie_sample_state *sample) {
    const ptie_kernels *kernels = stepper->engine->kernels;
    const ptie_map in = ptie_layout_view(&stepper->tensors, sample->tensors, op->in);
    const ptie_map z = ptie_layout_map(&stepper->convs, sample->convs, op->conv);
    memset(sample->sums, 0, 2 * (size_t)z.channels * sizeof *sample->sums);
    for (int32_t y = 0; y < z.height; y += PTIE_BAND_ROWS) {
        int32_t rows = z.height - y < PTIE_BAND_ROWS ? z.height - y : PTIE_BAND_ROWS;
        const ptie_map from = ptie_map_rows(in, y, rows), to = ptie_map_rows(z, y, rows);
        kernels->conv3x3(&to, &from, stepper->packed[op->conv], NULL, false);
        kernels->moments(sample->sums, &to);
    }
}

static void activate(const ptie_stepper *stepper, const ptie_op *op, ptie_sample_state *sample) {
    const ptie_map z = ptie_layout_map(&stepper->convs, sample->convs, op->conv);
    const ptie_map out = ptie_layout_view(&stepper->tensors, sample->tensors, op->out);
    stepper->engine->kernels->normalise(&out, &z, stepper->norms[op->conv]);
}

static void forward_op(const ptie_stepper *stepper, const ptie_op *op, size_t index) {
    const ptie_kernels *kernels = stepper->engine->kernels;
    const ptie_model *model = stepper->model;
    float *block = stepper->samples[index].tensors;
    const ptie_map in = ptie_layout_view(&stepper->tensors, block, op->in);
    const ptie_map out = ptie_layout_view(&stepper->tensors, block, op->out);
    switch (op->kind) {
    case PTIE_OP_CONV: break; /* convolve, activate */
    case PTIE_OP_POOL: kernels->maxpool(&out, &in); break;
    case PTIE_OP_UPSAMPLE: kernels->upsample(&out, &in); break;
    case PTIE_OP_DROPOUT: ptie_dropout(stepper, &out, index); break;
    case PTIE_OP_HEAD:
        kernels->conv1x1(&out, &in, ptie_model_values(model, op, PTIE_WEIGHT),
                         ptie_model_values(model, op, PTIE_BIAS));
        if (model->params.output == PTIE_SIGMOID) kernels->sigmoid(&out, &out);
        break;
    }
}

ptie_status ptie_forward_section(void *context, size_t index, int32_t worker) {
    (void)worker;
    const ptie_stepper *stepper = context;
    const ptie_graph *graph = &stepper->model->graph;
    ptie_sample_state *sample = &stepper->samples[index];
    const int32_t section = stepper->section;
    if (section == 0) {
        const ptie_map input = ptie_layout_view(&stepper->tensors, sample->tensors, graph->input);
        ptie_map_load(&input, sample->noisy);
    } else {
        activate(stepper, ptie_stepper_conv(stepper, section - 1), sample);
    }
    for (int32_t i = ptie_section_first(stepper, section); i < ptie_section_last(stepper, section);
         i++)
        forward_op(stepper, &graph->ops[i], index);
    if (section < graph->conv_count) convolve(stepper, ptie_stepper_conv(stepper, section), sample);
    return PTIE_OK;
}

/* Batch statistics of the section's convolution, and the running ones (N2). */
void ptie_forward_join(ptie_stepper *stepper) {
    ptie_model *model = stepper->model;
    if (stepper->section == model->graph.conv_count) return;
    const ptie_op *op = ptie_stepper_conv(stepper, stepper->section);
    const ptie_map *z = &stepper->convs.maps[op->conv];
    const double pixels = (double)stepper->count * z->height * z->width;
    const float *gamma = ptie_model_values(model, op, PTIE_GAMMA);
    const float *beta = ptie_model_values(model, op, PTIE_BETA);
    float *running_mean = ptie_model_values(model, op, PTIE_MEAN);
    float *running_variance = ptie_model_values(model, op, PTIE_VARIANCE);
    const double momentum = model->params.bn_momentum;
    for (int32_t c = 0; c < op->out.channels; c++) {
        double sum = 0, squares = 0;
        for (int32_t n = 0; n < stepper->count; n++) {
            sum += stepper->samples[n].sums[2 * c];
            squares += stepper->samples[n].sums[2 * c + 1];
        }
        double mean = sum / pixels, variance = fmax(squares / pixels - mean * mean, 0);
        double inverse_std = 1 / sqrt(variance + model->params.bn_epsilon);
        double scale = (double)gamma[c] * inverse_std;
        stepper->norms[op->conv][c] = (ptie_norm){.scale = (float)scale,
                                                  .shift = (float)((double)beta[c] - mean * scale),
                                                  .mean = (float)mean,
                                                  .inverse_std = (float)inverse_std};
        running_mean[c] = (float)(momentum * (double)running_mean[c] + (1 - momentum) * mean);
        running_variance[c] =
            (float)(momentum * (double)running_variance[c] + (1 - momentum) * variance);
    }
}
