/* SPDX-License-Identifier: BSD-3-Clause */
/* Backward through the network, docs/math.md (N1)-(N7).  Of the layers that read another one's
 * output the last in the chain comes first and overwrites its gradient; a pool, which reads a skip
 * that a join has read too, adds. */
#include <string.h>

#include "nn/stepper.h"

/* Gradient of z of the band's layer (N3), with a row above and below. */
static ptie_map z_gradient(const ptie_stepper *stepper, const ptie_band *band) {
    const int32_t k = band->layer;
    ptie_map padded = ptie_nn_layout_map(&stepper->z_grad, band->workspace->z_grad, k);
    padded.height = band->rows + 2;
    const ptie_clip inside = ptie_clip_band(&padded, band->first, stepper->z.maps[k].height);
    const int32_t first = inside.first, rows = inside.map.height;
    const ptie_map z = ptie_z_rows(stepper, band->sample, k, first, rows);
    ptie_map grad = inside.map;
    if (k == stepper->model->graph.layer_count - 1)
        ptie_head_gradient(stepper, band->sample, &grad, first);
    else
        grad = ptie_gradient_rows(stepper, band->sample, k, first, rows);
    stepper->engine->kernels->normalise_backward(&inside.map, &grad, &z, stepper->norms[k]);
    return ptie_map_rows(padded, 1, band->rows);
}

/* Adds to the sums that BatchNorm's gradient needs from the whole batch. */
static void add_sums(const ptie_stepper *stepper, const ptie_band *band, int32_t layer,
                     int32_t first, int32_t rows) {
    const ptie_map grad = ptie_gradient_rows(stepper, band->sample, layer, first, rows);
    const ptie_map z = ptie_z_rows(stepper, band->sample, layer, first, rows);
    stepper->engine->kernels->normalise_sums(band->sample->sums, &grad, &z, stepper->norms[layer]);
}

static void copy_map(const ptie_map *to, const ptie_map *from) {
    for (int32_t c = 0; c < from->channels; c++)
        for (int32_t y = 0; y < from->height; y++)
            memcpy(to->data + c * to->plane + y * to->row,
                   from->data + c * from->plane + y * from->row,
                   (size_t)from->width * sizeof *from->data);
}

static void clear_map(const ptie_map *map) {
    for (int32_t c = 0; c < map->channels; c++)
        for (int32_t y = 0; y < map->height; y++)
            memset(map->data + c * map->plane + y * map->row, 0,
                   (size_t)map->width * sizeof *map->data);
}

/* Gradient of what the band's layer reads (N1), into `to`. */
static void unconvolve(const ptie_stepper *stepper, const ptie_band *band, const ptie_map *to,
                       const ptie_map *z_grad) {
    ptie_next next;
    stepper->engine->kernels->winograd3x3(to, z_grad, stepper->packed_adjoint[band->layer], NULL,
                                          false, NULL, band->workspace->scratch,
                                          ptie_next_input(stepper, *band, &next));
}

static ptie_map unconvolve_aside(const ptie_stepper *stepper, const ptie_band *band,
                                 const ptie_map *z_grad) {
    ptie_map in_grad = ptie_nn_layout_map(&stepper->in_grad, band->workspace->in_grad, band->layer);
    in_grad.height = band->rows;
    unconvolve(stepper, band, &in_grad, z_grad);
    return in_grad;
}

static void unpool(const ptie_stepper *stepper, const ptie_band *band, const ptie_map *in,
                   const ptie_map *z_grad) {
    const int32_t first = 2 * band->first, rows = 2 * band->rows, before = band->layer - 1;
    const ptie_map in_grad = unconvolve_aside(stepper, band, z_grad);
    const ptie_map finer = ptie_band_finer(stepper, band);
    const ptie_map grad = ptie_gradient_rows(stepper, band->sample, before, first, rows);
    stepper->engine->kernels->maxpool_backward(&grad, &in_grad, &finer, in);
    add_sums(stepper, band, before, first, rows);
}

static void unjoin(const ptie_stepper *stepper, const ptie_band *band, const ptie_map *z_grad) {
    const int32_t before = band->layer - 1;
    const int32_t skip = stepper->model->graph.layers[band->layer].skip;
    const ptie_map in_grad = unconvolve_aside(stepper, band, z_grad);
    const ptie_map *coarse = &stepper->z.maps[before];
    const ptie_map up = ptie_map_channels(in_grad, 0, coarse->channels);
    const ptie_map rest =
        ptie_map_channels(in_grad, coarse->channels, in_grad.channels - coarse->channels);
    const ptie_map up_grad = ptie_gradient_rows(stepper, band->sample, before, 0, coarse->height);
    const ptie_map skip_grad =
        ptie_gradient_rows(stepper, band->sample, skip, band->first, band->rows);
    stepper->engine->kernels->upsample_backward(&up_grad, &up, band->first);
    copy_map(&skip_grad, &rest);
}

static void unconvolve_band(const ptie_stepper *stepper, const ptie_band *band) {
    const int32_t before = band->layer - 1;
    const ptie_map z_grad = z_gradient(stepper, band);
    const ptie_map in = ptie_band_input(stepper, band);
    ptie_next next;
    stepper->engine->kernels->conv3x3_weights(band->sample->weights, &z_grad, &in,
                                              band->workspace->scratch,
                                              ptie_next_gradient(stepper, *band, &next));
    switch (stepper->model->graph.layers[band->layer].input) {
    case PTIE_INPUT_IMAGE: break; /* nobody asks */
    case PTIE_INPUT_SAME: {
        const ptie_map grad =
            ptie_gradient_rows(stepper, band->sample, before, band->first, band->rows);
        unconvolve(stepper, band, &grad, &z_grad);
        add_sums(stepper, band, before, band->first, band->rows);
        break;
    }
    case PTIE_INPUT_POOL: unpool(stepper, band, &in, &z_grad); break;
    case PTIE_INPUT_JOIN: unjoin(stepper, band, &z_grad); break;
    }
}

/* The way back through dropout: where the mask was 0 the activation is.  Where the ReLU made it 0
   the gradient is of no interest. */
static void drop_gradient(const ptie_map *grad, const ptie_map *dropped, float kept) {
    for (int32_t c = 0; c < grad->channels; c++)
        for (int32_t y = 0; y < grad->height; y++) {
            float *g = grad->data + c * grad->plane + y * grad->row;
            const float *value = dropped->data + c * dropped->plane + y * dropped->row;
            for (int32_t x = 0; x < grad->width; x++) g[x] *= value[x] > 0 ? kept : 0;
        }
}

static void finish_join(const ptie_stepper *stepper, const ptie_band *band) {
    const int32_t before = band->layer - 1, height = stepper->z.maps[before].height;
    const ptie_map grad = ptie_gradient_rows(stepper, band->sample, before, 0, height);
    const ptie_map coarse = ptie_nn_layout_map(&stepper->coarse, band->sample->coarse, band->layer);
    const double rate = stepper->model->params.dropout;
    if (stepper->model->graph.layers[band->layer].dropout && rate > 0)
        drop_gradient(&grad, &coarse, (float)(1 / (1 - rate)));
    add_sums(stepper, band, before, 0, height);
}

ptie_status ptie_backward_layer(void *context, size_t index, int32_t worker) {
    const ptie_stepper *stepper = context;
    const int32_t k = stepper->section;
    const ptie_layer *layer = &stepper->model->graph.layers[k];
    const bool join = layer->input == PTIE_INPUT_JOIN;
    ptie_band band = ptie_band_first(stepper, k, index, worker);
    memset(band.sample->weights, 0, stepper->total_count * sizeof *band.sample->weights);
    memset(band.sample->sums, 0, 2 * stepper->most_channels * sizeof *band.sample->sums);
    if (join) {
        const ptie_map grad =
            ptie_gradient_rows(stepper, band.sample, k - 1, 0, stepper->z.maps[k - 1].height);
        clear_map(&grad); /* the bands add to it */
    }
    for (; band.rows > 0; ptie_band_next(stepper, &band)) unconvolve_band(stepper, &band);
    if (join) finish_join(stepper, &band);
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
static void join_norms(ptie_stepper *stepper, int32_t k) {
    const ptie_layer *layer = &stepper->model->graph.layers[k];
    const ptie_param *params = &stepper->model->graph.params[layer->params];
    const ptie_map *z = &stepper->z.maps[k];
    const double pixels = (double)stepper->count * z->height * z->width;
    for (int32_t c = 0; c < layer->out_channels; c++) {
        double g = 0, gx = 0;
        for (int32_t n = 0; n < stepper->count; n++) {
            g += stepper->samples[n].sums[2 * c];
            gx += stepper->samples[n].sums[2 * c + 1];
        }
        stepper->state[0][params[PTIE_BETA].offset + (size_t)c] = (float)g;
        stepper->state[0][params[PTIE_GAMMA].offset + (size_t)c] = (float)gx;
        stepper->norms[k][c].mean_g = (float)(g / pixels);
        stepper->norms[k][c].mean_gx = (float)(gx / pixels);
    }
}

void ptie_head_join(ptie_stepper *stepper) {
    const ptie_graph *graph = &stepper->model->graph;
    const ptie_param *head = &graph->params[graph->head];
    join_weights(stepper, &head[PTIE_WEIGHT], 0);
    join_weights(stepper, &head[PTIE_BIAS], head[PTIE_WEIGHT].count);
    join_norms(stepper, graph->layer_count - 1);
}

void ptie_backward_join(ptie_stepper *stepper) {
    const ptie_graph *graph = &stepper->model->graph;
    join_weights(stepper, &graph->params[graph->layers[stepper->section].params], 0);
    if (stepper->section > 0) join_norms(stepper, stepper->section - 1);
}
