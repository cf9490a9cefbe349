/* SPDX-License-Identifier: BSD-3-Clause */
/* What a layer reads, made band by band from what the layers before it have left. */
#include <string.h>

#include "nn/stepper.h"

static int32_t smaller(int32_t a, int32_t b) {
    return a < b ? a : b;
}

ptie_band ptie_band_first(const ptie_stepper *stepper, int32_t layer, size_t sample,
                          int32_t worker) {
    const int32_t height = stepper->z.maps[layer].height;
    return (ptie_band){.layer = layer,
                       .rows = smaller(stepper->rows[layer], height),
                       .sample = &stepper->samples[sample],
                       .workspace = &stepper->workspaces[worker]};
}

void ptie_band_next(const ptie_stepper *stepper, ptie_band *band) {
    const int32_t height = stepper->z.maps[band->layer].height;
    band->first += band->rows;
    band->rows = smaller(stepper->rows[band->layer], height - band->first);
}

ptie_map ptie_z_rows(const ptie_stepper *stepper, const ptie_sample_state *sample, int32_t layer,
                     int32_t first, int32_t rows) {
    return ptie_map_rows(ptie_nn_layout_map(&stepper->z, sample->z, layer), first, rows);
}

ptie_map ptie_gradient_rows(const ptie_stepper *stepper, const ptie_sample_state *sample,
                            int32_t layer, int32_t first, int32_t rows) {
    return ptie_map_rows(ptie_nn_layout_map(&stepper->gradients, sample->gradients, layer), first,
                         rows);
}

static void clear_row(const ptie_map *map, int32_t row) {
    for (int32_t c = 0; c < map->channels; c++)
        memset(map->data + c * map->plane + row * map->row, 0,
               (size_t)map->width * sizeof *map->data);
}

ptie_clip ptie_clip_band(const ptie_map *padded, int32_t first, int32_t height) {
    const int32_t above = first == 0, below = first + padded->height - 2 == height;
    if (above) clear_row(padded, 0);
    if (below) clear_row(padded, padded->height - 1);
    return (ptie_clip){ptie_map_rows(*padded, above, padded->height - above - below),
                       first - 1 + above};
}

/* Rows first .. of a layer's output (N2). */
static void activate(const ptie_stepper *stepper, const ptie_band *band, int32_t layer,
                     const ptie_map *out, int32_t first) {
    const ptie_map z = ptie_z_rows(stepper, band->sample, layer, first, out->height);
    stepper->engine->kernels->normalise(out, &z, stepper->norms[layer]);
}

static void load_image(const ptie_stepper *stepper, const ptie_band *band, const ptie_clip *to) {
    const size_t width = (size_t)stepper->width, pixels = width * (size_t)stepper->height;
    for (int32_t c = 0; c < to->map.channels; c++)
        for (int32_t y = 0; y < to->map.height; y++)
            memcpy(to->map.data + c * to->map.plane + y * to->map.row,
                   band->sample->noisy[0] + (size_t)c * pixels + (size_t)(to->first + y) * width,
                   width * sizeof *to->map.data);
}

static ptie_map finer_rows(const ptie_stepper *stepper, const ptie_band *band, int32_t first,
                           int32_t rows) {
    const ptie_map whole = ptie_nn_layout_map(&stepper->finer, band->workspace->finer, band->layer);
    return ptie_map_rows(whole, 2 * (first - band->first + 1), 2 * rows);
}

ptie_map ptie_band_finer(const ptie_stepper *stepper, const ptie_band *band) {
    return finer_rows(stepper, band, band->first, band->rows);
}

static void pool(const ptie_stepper *stepper, const ptie_band *band, const ptie_clip *to) {
    const ptie_map finer = finer_rows(stepper, band, to->first, to->map.height);
    activate(stepper, band, band->layer - 1, &finer, 2 * to->first);
    stepper->engine->kernels->maxpool(&to->map, &finer);
}

static void join(const ptie_stepper *stepper, const ptie_band *band, const ptie_clip *to) {
    const int32_t skip = stepper->model->graph.layers[band->layer].skip;
    const ptie_map coarse = ptie_nn_layout_map(&stepper->coarse, band->sample->coarse, band->layer);
    const ptie_map up = ptie_map_channels(to->map, 0, coarse.channels);
    const ptie_map rest =
        ptie_map_channels(to->map, coarse.channels, to->map.channels - coarse.channels);
    stepper->engine->kernels->upsample(&up, &coarse, to->first);
    activate(stepper, band, skip, &rest, to->first);
}

ptie_map ptie_band_input(const ptie_stepper *stepper, const ptie_band *band) {
    ptie_map padded = ptie_nn_layout_map(&stepper->input, band->workspace->input, band->layer);
    padded.height = band->rows + 2;
    const ptie_clip inside =
        ptie_clip_band(&padded, band->first, stepper->z.maps[band->layer].height);
    switch (stepper->model->graph.layers[band->layer].input) {
    case PTIE_INPUT_IMAGE: load_image(stepper, band, &inside); break;
    case PTIE_INPUT_SAME:
        activate(stepper, band, band->layer - 1, &inside.map, inside.first);
        break;
    case PTIE_INPUT_POOL: pool(stepper, band, &inside); break;
    case PTIE_INPUT_JOIN: join(stepper, band, &inside); break;
    }
    return ptie_map_rows(padded, 1, band->rows);
}

/* z of what a band reads. */
static ptie_map source(const ptie_stepper *stepper, const ptie_band *band) {
    const ptie_layer *layer = &stepper->model->graph.layers[band->layer];
    switch (layer->input) {
    case PTIE_INPUT_POOL:
        return ptie_z_rows(stepper, band->sample, band->layer - 1, 2 * band->first, 2 * band->rows);
    case PTIE_INPUT_JOIN:
        return ptie_z_rows(stepper, band->sample, layer->skip, band->first, band->rows);
    default: return ptie_z_rows(stepper, band->sample, band->layer - 1, band->first, band->rows);
    }
}

const ptie_ahead *ptie_next_input(const ptie_stepper *stepper, ptie_band band, ptie_next *next) {
    next->ahead = (ptie_ahead){next->maps, 0};
    ptie_band_next(stepper, &band);
    if (band.rows > 0 && band.layer > 0) next->maps[next->ahead.count++] = source(stepper, &band);
    return &next->ahead;
}

const ptie_ahead *ptie_next_gradient(const ptie_stepper *stepper, ptie_band band, ptie_next *next) {
    const int32_t k = band.layer;
    next->ahead = (ptie_ahead){next->maps, 0};
    ptie_band_next(stepper, &band);
    if (band.rows == 0) return &next->ahead;
    next->maps[next->ahead.count++] = ptie_z_rows(stepper, band.sample, k, band.first, band.rows);
    if (k < stepper->model->graph.layer_count - 1)
        next->maps[next->ahead.count++] =
            ptie_gradient_rows(stepper, band.sample, k, band.first, band.rows);
    return &next->ahead;
}
