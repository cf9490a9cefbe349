/* SPDX-License-Identifier: BSD-3-Clause */
/* A frame, or a part of its rows, on its way through the network. */
#include <limits.h>
#include <string.h>

#include "base/memory.h"
#include "nn/denoiser.h"

/* The rows of a level that are in memory now: `first` .. of it, as many as `map` has. */
typedef struct window {
    ptie_map map;
    int32_t first;
    int32_t most; /* rows that were needed at a time so far */
} window;

typedef struct stream {
    const ptie_denoiser *plan;
    window windows[PTIE_MAX_WINDOWS];
    int32_t
        made[PTIE_MAX_LAYERS]; /* rows so far of what is loaded, pooled or upsampled for a layer */
    int32_t done[PTIE_MAX_LAYERS]; /* rows so far of its output */
    int32_t written;               /* rows so far of the result */
    const float *noisy;
    float *clean, *filter;
    bool dry; /* only to see what the windows hold */
} stream;

static int32_t smaller(int32_t a, int32_t b) {
    return a < b ? a : b;
}

static int32_t larger(int32_t a, int32_t b) {
    return a > b ? a : b;
}

static int32_t rows_of(const stream *s, int32_t layer) {
    return s->plan->full_height >> s->plan->graph.layers[layer].level;
}

/* The first row of a window that is still to be read. */
static int32_t unread(const stream *s, int32_t which) {
    const ptie_graph *graph = &s->plan->graph;
    const int32_t layer = which % PTIE_MAX_LAYERS;
    if (which != layer) /* read by the head or upsampled */
        return layer + 1 == graph->layer_count ? s->written : s->made[layer + 1] / 2 - 1;
    const int32_t convolved = s->done[layer] - 1;
    if (graph->layers[layer].input != PTIE_INPUT_JOIN) return convolved;
    return smaller(convolved, 2 * s->made[graph->layers[layer].skip + 1]); /* pooled too */
}

/* Rows first .. of some channels of a window. */
static ptie_map view(const stream *s, int32_t which, int32_t channel, int32_t channels,
                     int32_t first, int32_t rows) {
    const window *w = &s->windows[which];
    return ptie_map_rows(ptie_map_channels(w->map, channel, channels), first - w->first, rows);
}

/* Moves rows `from` .. `end` - 1 of some channels to the top of their window. */
static void move_up(const stream *s, int32_t which, int32_t channel, int32_t channels, int32_t from,
                    int32_t end) {
    if (s->dry || end <= from) return;
    const ptie_map rows = view(s, which, channel, channels, from, end - from);
    const size_t floats = (size_t)((end - from) * rows.row);
    float *to = rows.data - (from - s->windows[which].first) * rows.row;
    for (int32_t c = 0; c < channels; c++)
        memmove(to + c * rows.plane - 1, rows.data + c * rows.plane - 1, floats * sizeof *to);
}

/* Makes room for rows first .. first + rows - 1: if they are below the window, it moves down. */
static void make_room(stream *s, int32_t which, int32_t first, int32_t rows) {
    const ptie_graph *graph = &s->plan->graph;
    window *w = &s->windows[which];
    const int32_t from = smaller(unread(s, which), first), end = first + rows;
    w->most = larger(w->most, end - from);
    if (end - w->first <= w->map.height) return;
    /* Both parts of a join move when its skip, which is ahead, comes to the end. */
    const bool join = which < graph->layer_count && graph->layers[which].input == PTIE_INPUT_JOIN;
    const int32_t split = join ? graph->layers[which - 1].out_channels : 0;
    move_up(s, which, 0, split, from, s->made[which % PTIE_MAX_LAYERS]);
    move_up(s, which, split, w->map.channels - split, from, first);
    w->first = from;
}

static size_t pixel_bytes(const stream *s) {
    return s->plan->half ? sizeof(ptie_half) : sizeof(float);
}

static unsigned char *row_at(const ptie_map *map, int32_t c, int32_t y) {
    return (unsigned char *)(map->data + c * map->plane + y * map->row);
}

/* Zeroes the halo around some rows of a level. */
static void clear_halo(const stream *s, const ptie_map *map, int32_t first, int32_t height) {
    const size_t pixel = pixel_bytes(s), width = (size_t)map->width * pixel;
    for (int32_t c = 0; c < map->channels; c++) {
        for (int32_t y = -1; y < map->height; y++) {
            memset(row_at(map, c, y) + width, 0, pixel);     /* right of its row, */
            memset(row_at(map, c, y + 1) - pixel, 0, pixel); /* left of the next */
        }
        if (first == 0) memset(row_at(map, c, -1) - pixel, 0, width + 2 * pixel);
        if (first + map->height == height)
            memset(row_at(map, c, map->height) - pixel, 0, width + 2 * pixel);
    }
}

/* Index i of a row of n pixels continued by reflection: ... 2 1 [0 1 2 .. n-1] n-2 n-3 ... */
static int32_t reflect(int32_t i, int32_t n) {
    if (n == 1) return 0;
    int32_t period = 2 * (n - 1), place = i % period;
    return place < n ? place : period - place;
}

/* Rows first .. of the frame, padded at the right and at the bottom. */
static void load(const stream *s, const ptie_map *to, int32_t first) {
    const int32_t width = s->plan->width, height = s->plan->height;
    const size_t pixel = pixel_bytes(s);
    for (int32_t y = 0; y < to->height; y++) {
        const float *from = s->noisy + (ptrdiff_t)reflect(first + y, height) * width;
        unsigned char *row = row_at(to, 0, y);
        if (s->plan->half)
            s->plan->half->narrow((ptie_half *)row, from, width);
        else
            memcpy(row, from, (size_t)width * pixel);
        for (int32_t x = width; x < to->width; x++)
            memcpy(row + (size_t)x * pixel, row + (size_t)reflect(x, width) * pixel, pixel);
    }
}

/* What of a layer's input is not the output of a convolution, from the rows before it. */
static void make_input(stream *s, int32_t layer, int32_t first, int32_t rows) {
    const ptie_graph *graph = &s->plan->graph;
    const ptie_layer *l = &graph->layers[layer];
    const int32_t before = layer > 0 ? graph->layers[layer - 1].out_channels : l->in_channels;
    make_room(s, layer, first, rows);
    if (s->dry) return;
    const ptie_map to = view(s, layer, 0, before, first, rows);
    clear_halo(s, &to, first, rows_of(s, layer));
    if (l->input == PTIE_INPUT_IMAGE) {
        load(s, &to, first);
        return;
    }
    const ptie_denoiser *plan = s->plan;
    const int32_t outlet = plan->outlet[layer - 1];
    const int32_t channel = s->windows[outlet].map.channels - before;
    if (l->input == PTIE_INPUT_POOL) {
        const ptie_map from = view(s, outlet, channel, before, 2 * first, 2 * rows);
        (plan->half ? plan->half->maxpool : plan->kernels->maxpool)(&to, &from);
    } else {
        const int32_t top = larger(0, first / 2 - 1);
        const ptie_map from = view(s, outlet, channel, before, top, s->done[layer - 1] - top);
        (plan->half ? plan->half->upsample : plan->kernels->upsample)(&to, &from, first - 2 * top);
    }
}

static void convolve(stream *s, int32_t layer, int32_t first, int32_t rows) {
    const ptie_denoiser *plan = s->plan;
    const ptie_layer *l = &plan->graph.layers[layer];
    const int32_t outlet = plan->outlet[layer];
    make_room(s, outlet, first, rows);
    if (s->dry) return;
    const ptie_map out = view(s, outlet, s->windows[outlet].map.channels - l->out_channels,
                              l->out_channels, first, rows);
    const ptie_map in = view(s, layer, 0, l->in_channels, first, rows);
    clear_halo(s, &out, first, rows_of(s, layer));
    if (plan->half)
        plan->half->conv3x3(&out, &in, plan->packed[layer], plan->bias[layer]);
    else if (plan->filtered[layer])
        plan->kernels->winograd3x3(&out, &in, plan->packed[layer], plan->bias[layer], true, NULL,
                                   s->filter, NULL);
    else
        plan->kernels->conv3x3(&out, &in, plan->packed[layer], plan->bias[layer], true);
}

static void need_output(stream *s, int32_t layer, int32_t end);

/* Sees to it that the rows of a layer's input before `end` exist. */
static void need_input(stream *s, int32_t layer, int32_t end) {
    const ptie_layer *l = &s->plan->graph.layers[layer];
    end = smaller(end, rows_of(s, layer));
    switch (l->input) {
    case PTIE_INPUT_IMAGE: break;
    case PTIE_INPUT_SAME: need_output(s, layer - 1, end); return;
    case PTIE_INPUT_POOL: need_output(s, layer - 1, 2 * end); break;
    case PTIE_INPUT_JOIN:
        need_output(s, layer - 1, end / 2 + 1);
        need_output(s, l->skip, end);
        break;
    }
    if (s->made[layer] >= end) return;
    make_input(s, layer, s->made[layer], end - s->made[layer]);
    s->made[layer] = end;
}

/* Sees to it that the rows of a layer's output before `end` exist. */
static void need_output(stream *s, int32_t layer, int32_t end) {
    const int32_t height = rows_of(s, layer), strip = PTIE_WINOGRAD_ROWS;
    int32_t *done = &s->done[layer];
    end = smaller((end + strip - 1) / strip * strip, height);
    while (*done < end) {
        const int32_t rows = smaller(end - *done, s->plan->band[layer]);
        need_input(s, layer, *done + rows + 1);
        convolve(s, layer, *done, rows);
        *done += rows;
    }
}

static void write_rows(stream *s, int32_t rows) {
    const ptie_denoiser *plan = s->plan;
    const int32_t last = plan->graph.layer_count - 1;
    need_output(s, last, s->written + rows);
    if (s->dry) return;
    ptie_map from =
        view(s, plan->outlet[last], 0, plan->graph.layers[last].out_channels, s->written, rows);
    from.width = plan->width; /* the crop */
    const ptie_map to = {
        s->clean + (ptrdiff_t)s->written * plan->width, 1, rows, plan->width, plan->width, 0};
    (plan->half ? plan->half->conv1x1 : plan->kernels->conv1x1)(&to, &from, plan->head,
                                                                plan->head + from.channels);
    if (plan->output == PTIE_SIGMOID) plan->kernels->sigmoid(&to, &to);
}

/* Where each layer begins if the result begins at row `first`. */
static void start(stream *s, int32_t first) {
    const ptie_graph *graph = &s->plan->graph;
    const int32_t strip = PTIE_WINOGRAD_ROWS;
    for (int32_t k = 0; k < graph->layer_count; k++) s->done[k] = INT_MAX;
    for (int32_t i = 0; i < PTIE_MAX_WINDOWS; i++) s->windows[i].first = INT_MAX;
    s->written = s->done[graph->layer_count - 1] = first;
    for (int32_t k = graph->layer_count - 1; k >= 0; k--) {
        const ptie_layer *layer = &graph->layers[k];
        window *in = &s->windows[k], *out = &s->windows[s->plan->outlet[k]];
        s->done[k] = s->done[k] / strip * strip;
        s->made[k] = larger(0, s->done[k] - 1);
        out->first = smaller(out->first, s->done[k] - 1);
        in->first = smaller(in->first, s->done[k] - 1);
        if (layer->input == PTIE_INPUT_IMAGE) continue;
        int32_t *before = &s->done[k - 1];
        switch (layer->input) {
        case PTIE_INPUT_POOL: *before = smaller(*before, 2 * s->made[k]); break;
        case PTIE_INPUT_JOIN:
            *before = larger(0, s->made[k] / 2 - 1);
            s->done[layer->skip] = s->made[k];
            break;
        default: *before = s->made[k];
        }
    }
}

static void walk(stream *s, int32_t first) {
    const int32_t end = smaller(first + s->plan->part_rows, s->plan->height);
    const int32_t band = s->plan->band[s->plan->graph.layer_count - 1];
    start(s, first);
    for (int32_t rows; s->written < end; s->written += rows) {
        rows = smaller(band, end - s->written);
        write_rows(s, rows);
    }
}

/* Rows beyond those a window must hold: the more, the less often it moves, which costs a copy.
   Measured: 64 KiB more of a frame's rows are worth it. */
static int32_t spare_rows(const ptie_denoiser *denoiser) {
    enum { SPARE_FLOATS = 16384, LEAST = 8, MOST = 64 };
    return larger(LEAST, smaller(MOST, SPARE_FLOATS / denoiser->full_width));
}

void ptie_stream_plan(ptie_denoiser *denoiser) {
    stream s = {.plan = denoiser, .dry = true};
    for (int32_t i = 0; i < PTIE_MAX_WINDOWS; i++) s.windows[i].map = denoiser->windows[i];
    for (int32_t part = 0; part < denoiser->parts; part++) walk(&s, part * denoiser->part_rows);
    for (int32_t i = 0; i < PTIE_MAX_WINDOWS; i++) {
        const ptie_map map = denoiser->windows[i];
        if (map.channels > 0)
            denoiser->windows[i] = ptie_denoiser_map(
                denoiser, map.channels, s.windows[i].most + spare_rows(denoiser), map.width);
    }
}

static size_t slice_windows(stream *s, void *scratch) {
    ptie_slicer slicer = {.base = scratch};
    for (int32_t i = 0; i < PTIE_MAX_WINDOWS; i++) {
        const ptie_map *map = &s->plan->windows[i];
        if (map->channels == 0) continue;
        float *block = ptie_slice(&slicer, ptie_map_floats(map), sizeof *block);
        s->windows[i].map = block ? ptie_map_in(*map, block) : *map;
    }
    s->filter = ptie_slice(&slicer, s->plan->filter_floats, sizeof *s->filter);
    return slicer.used;
}

size_t ptie_stream_scratch(const ptie_denoiser *denoiser) {
    return slice_windows(&(stream){.plan = denoiser}, NULL);
}

void ptie_stream_run(const ptie_denoiser *denoiser, float *clean, const float *noisy, int32_t part,
                     void *scratch) {
    stream s = {.plan = denoiser, .noisy = noisy, .clean = clean};
    slice_windows(&s, scratch);
    walk(&s, part * denoiser->part_rows);
}
