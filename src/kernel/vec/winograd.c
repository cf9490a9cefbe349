/* SPDX-License-Identifier: BSD-3-Clause */
/* 3x3 convolution and the gradient of its weights by minimal filtering F(4,3) down the columns,
 * docs/math.md (N9): half the multiplications of the direct way.
 *
 * A strip of 4 output rows and the 6 input rows under it become 6 transformed rows each; between
 * them what is left of the window is 1x3, and the sums run over channels and its 3 taps.  Lanes are
 * neighbouring pixels, so the transforms are plain additions of rows.  Register blocks are those of
 * the direct kernels; a tile of TILE columns keeps the transformed rows close.
 */
#include <string.h>

#include "kernel/vec/vec.h"

#if PTIE_VEC_WIDTH == 16
enum { OUT = 8 };
#else
enum { OUT = 4 };
#endif
enum {
    ROWS = PTIE_WINOGRAD_ROWS,
    PARTS = PTIE_WINOGRAD_PARTS,
    PIXELS = 2,
    BLOCK = PIXELS * VEC_WIDTH
};
enum { TILE = 128 };

/* Where a kernel is in what it asks memory for, in lines of 64 bytes. */
typedef struct cursor {
    const ptie_map *map, *end;
    int32_t channel;
    const char *at, *stop; /* of the channel */
    int32_t lines;         /* per call of fetch_some */
} cursor;

static void next_channel(cursor *c) {
    if (c->at && ++c->channel == c->map->channels) c->map++, c->channel = 0;
    if (c->map == c->end) {
        c->lines = 0;
        return;
    }
    c->at = (const char *)row_of(c->map, c->channel, 0);
    c->stop = (const char *)row_of(c->map, c->channel, c->map->height);
}

/* In `calls` calls of fetch_some everything is asked for. */
static cursor cursor_start(const ptie_ahead *ahead, int64_t calls) {
    cursor c = {0};
    if (!ahead || ahead->count == 0) return c;
    int64_t lines = 0;
    for (int32_t i = 0; i < ahead->count; i++) {
        const ptie_map *map = &ahead->maps[i];
        lines += map->channels * (map->height * map->row / 16 + 1);
    }
    c = (cursor){.map = ahead->maps,
                 .end = ahead->maps + ahead->count,
                 .lines = (int32_t)((lines + calls - 1) / calls)};
    next_channel(&c);
    return c;
}

INLINE void fetch_some(cursor *c) {
    for (int32_t i = 0; i < c->lines; i++) {
        __builtin_prefetch(c->at, 0, 2);
        c->at += 64;
        if (c->at >= c->stop) next_channel(c);
    }
}

/* Six input rows -> six transformed rows, (N9) B'. */
INLINE void transform_pixels(float *to, ptrdiff_t step, const float *const row[PARTS], int32_t x) {
    vf d[PARTS];
    UNROLL (r, PARTS) d[r] = vf_load(row[r] + x);
    const vf two = vf_splat(2), four = vf_splat(4), five = vf_splat(5);
    const vf even4 = d[4] - four * d[2], odd4 = d[3] - four * d[1];
    const vf even1 = d[4] - d[2], odd2 = two * (d[3] - d[1]);
    vf_store(to + x, four * d[0] - five * d[2] + d[4]);
    vf_store(to + step + x, even4 + odd4);
    vf_store(to + 2 * step + x, even4 - odd4);
    vf_store(to + 3 * step + x, even1 + odd2);
    vf_store(to + 4 * step + x, even1 - odd2);
    vf_store(to + 5 * step + x, four * d[1] - five * d[3] + d[5]);
}

/* The rows under output rows y .. y + 3 of columns from `x` on, beginning one to the left.  Below
   the map's lower neighbour row nothing is read: that row stands in, for outputs that are not
   stored. */
static void transform_input(float *to, ptrdiff_t step, const ptie_map *in, int32_t channel,
                            int32_t y, int32_t x, int32_t width) {
    const float *row[PARTS];
    for (int r = 0; r < PARTS; r++)
        row[r] = row_of(in, channel, smaller(y - 1 + r, in->height)) + x - 1;
    for (int32_t i = 0; i < width + 2; i += VEC_WIDTH) transform_pixels(to, step, row, i);
}

/* Where the transformed rows of a tile lie in the scratch: (channels, PARTS, step). */
typedef struct tile {
    const float *rows;
    ptrdiff_t step;
    int32_t channels;
} tile;

/* Part `part` of OUT output channels: sums over the input channels and the 3 taps of a row. */
INLINE void multiply_part(float *sums, const tile *input, int part, int32_t x, const float *weights,
                          const int vectors) {
    vf sum[OUT][PIXELS];
    UNROLL (o, OUT)
        UNROLL (v, vectors) sum[o][v] = (vf){0};
    const float *row = input->rows + part * input->step + x;
    for (int32_t i = 0; i < input->channels; i++) {
        UNROLL (kx, 3) {
            vf pixel[PIXELS];
            UNROLL (v, vectors) pixel[v] = vf_load(row + kx + v * VEC_WIDTH);
            UNROLL (o, OUT) {
                const vf weight = vf_splat(weights[kx * PTIE_CONV_BLOCK + o]);
                UNROLL (v, vectors) sum[o][v] += weight * pixel[v];
            }
        }
        row += PARTS * input->step;
        weights += 3 * PTIE_CONV_BLOCK;
    }
    UNROLL (o, OUT)
        UNROLL (v, vectors) vf_store(sums + o * BLOCK + v * VEC_WIDTH, sum[o][v]);
}

/* Six parts -> four output rows, (N9) A'. */
INLINE void join_parts(vf row[ROWS], const float *sums) {
    vf m[PARTS];
    UNROLL (j, PARTS) m[j] = vf_load(sums + j * OUT * BLOCK);
    const vf sum1 = m[1] + m[2], difference1 = m[1] - m[2];
    const vf sum2 = m[3] + m[4], difference2 = m[3] - m[4];
    row[0] = m[0] + sum1 + sum2;
    row[1] = difference1 + vf_splat(2) * difference2;
    row[2] = sum1 + vf_splat(4) * sum2;
    row[3] = difference1 + vf_splat(8) * difference2 + m[5];
}

/* What a strip stores: OUT channels from `first` on, at row y and column x. */
typedef struct target {
    const ptie_map *map;
    int32_t first, y, x;
    const float *bias;
    bool relu;
    double *moments;
    cursor *ahead;
} target;

/* sums: of the OUT channels, then of their squares; only if `summed`.  `whole`: all rows and lanes
   lie on the map. */
INLINE void store_strip_as(const target *out, const float *parts, const int vectors,
                           vf sums[2 * OUT], const bool whole, const bool summed) {
    const ptie_map *map = out->map;
    const int32_t channels = smaller(map->channels - out->first, OUT);
    const int32_t rows = whole ? ROWS : smaller(map->height - out->y, ROWS);
    for (int32_t o = 0; o < channels; o++)
        UNROLL (v, vectors) {
            const int32_t x = out->x + v * VEC_WIDTH;
            const int32_t left = whole ? VEC_WIDTH : map->width - x;
            const vf bias = vf_splat(out->bias ? out->bias[out->first + o] : 0);
            float *to = row_of(map, out->first + o, out->y) + x;
            vf row[ROWS], sum = {0}, squares = {0};
            join_parts(row, parts + o * BLOCK + v * VEC_WIDTH);
            UNROLL (r, ROWS) {
                vf value = out->relu ? vf_positive(row[r] + bias) : row[r] + bias;
                if (!whole && (r >= rows || left <= 0)) continue;
                if (!whole) value = vf_first(value, left);
                sum += value;
                squares += value * value;
                if (!whole)
                    vf_store_first(to + r * map->row, value, left);
                else if (summed)
                    vf_stream(to + r * map->row, value);
                else
                    vf_store(to + r * map->row, value);
            }
            if (summed) {
                sums[o] += sum;
                sums[OUT + o] += squares;
            }
        }
}

INLINE void store_strip(const target *out, const float *parts, const int vectors,
                        vf sums[2 * OUT]) {
    const bool whole =
        out->map->height - out->y >= ROWS && out->map->width - out->x >= vectors * VEC_WIDTH;
    if (out->moments) {
        if (whole)
            store_strip_as(out, parts, vectors, sums, true, true);
        else
            store_strip_as(out, parts, vectors, sums, false, true);
    } else {
        if (whole)
            store_strip_as(out, parts, vectors, sums, true, false);
        else
            store_strip_as(out, parts, vectors, sums, false, false);
    }
}

INLINE void convolve_block(const target *out, const tile *input, int32_t x, const float *weights,
                           const int vectors, vf sums[2 * OUT]) {
    float parts[PARTS * OUT * BLOCK] __attribute__((aligned(64)));
    for (int part = 0; part < PARTS; part++) {
        multiply_part(parts + part * OUT * BLOCK, input, part, x,
                      weights + part * input->channels * 3 * PTIE_CONV_BLOCK, vectors);
        fetch_some(out->ahead);
    }
    store_strip(out, parts, vectors, sums);
}

static void add_moments(const target *out, vf sums[2 * OUT]) {
    const vf totals = vf_fold(sums); /* OUT is half a vector */
    for (int32_t o = 0; o < smaller(out->map->channels - out->first, OUT); o++) {
        out->moments[2 * (out->first + o)] += (double)totals[o];
        out->moments[2 * (out->first + o) + 1] += (double)totals[OUT + o];
    }
}

static void convolve_tile(target out, const tile *input, int32_t width, const float *weights) {
    const ptrdiff_t block_floats = (ptrdiff_t)PARTS * input->channels * 3 * PTIE_CONV_BLOCK;
    const int32_t left = out.x;
    for (out.first = 0; out.first < out.map->channels; out.first += OUT) {
        const float *block =
            weights + out.first / PTIE_CONV_BLOCK * block_floats + out.first % PTIE_CONV_BLOCK;
        vf sums[2 * OUT] = {{0}};
        int32_t x = 0;
        for (; x + VEC_WIDTH < width; x += BLOCK) {
            out.x = left + x;
            convolve_block(&out, input, x, block, PIXELS, sums);
        }
        out.x = left + x;
        if (x < width) convolve_block(&out, input, x, block, 1, sums);
        if (out.moments) add_moments(&out, sums);
    }
}

static int32_t parts_of(int32_t count, int32_t size) {
    return (count + size - 1) / size;
}

void VEC(winograd3x3)(const ptie_map *out, const ptie_map *in, const float *weights,
                      const float *bias, bool relu, double *moments, float *scratch,
                      const ptie_ahead *ahead) {
    const tile input = {scratch, TILE + 2 * VEC_WIDTH, in->channels};
    cursor next =
        cursor_start(ahead, (int64_t)PARTS * parts_of(out->height, ROWS) *
                                parts_of(out->channels, OUT) * parts_of(out->width, BLOCK));
    for (int32_t y = 0; y < out->height; y += ROWS)
        for (int32_t x = 0; x < out->width; x += TILE) {
            const int32_t width = smaller(out->width - x, TILE);
            for (int32_t i = 0; i < in->channels; i++)
                transform_input(scratch + i * PARTS * input.step, input.step, in, i, y, x,
                                parts_of(width, BLOCK) * BLOCK);
            convolve_tile((target){out, 0, y, x, bias, relu, moments, &next}, &input, width,
                          weights);
        }
    if (moments) vf_stream_end();
}

/* Gradient of the weights: the same filtering turned round, 3 taps from 4 rows. */

/* A slab is STRIPS strips by up to COLUMNS pixels of one channel and one part: small enough that
   those of OUT channels stay in the first-level cache. */
enum { COLUMNS = 256, SLAB_PIXELS = 1024, STRIPS = 16 };

typedef struct slab {
    int32_t y, x;           /* of its first pixel */
    int32_t strips, width;  /* what of it lies on the map */
    ptrdiff_t step, floats; /* from strip to strip; of the whole slab */
} slab;

static slab slab_shape(int32_t height, int32_t width) {
    const int32_t columns = smaller((width + VEC_WIDTH - 1) / VEC_WIDTH * VEC_WIDTH, COLUMNS);
    const int32_t strips =
        smaller(smaller((height + ROWS - 1) / ROWS, STRIPS), SLAB_PIXELS / columns);
    const ptrdiff_t step = columns + VEC_WIDTH; /* the taps reach two pixels further */
    return (slab){0, 0, strips, columns, step, strips * step};
}

/* Four rows of the gradient -> six transformed rows, (N9) A; `count` pixels of them exist. */
INLINE void transform_gradient(float *to, ptrdiff_t part, const float *const row[ROWS], int32_t x,
                               int32_t count) {
    vf g[ROWS];
    UNROLL (r, ROWS) {
        g[r] = vf_load(row[r] + x);
        if (count < VEC_WIDTH) g[r] = vf_first(g[r], count);
    }
    const vf even1 = g[0] + g[2], odd1 = g[1] + g[3];
    const vf even2 = g[0] + vf_splat(4) * g[2], odd2 = vf_splat(2) * g[1] + vf_splat(8) * g[3];
    vf_store(to + x, g[0]);
    vf_store(to + part + x, even1 + odd1);
    vf_store(to + 2 * part + x, even1 - odd1);
    vf_store(to + 3 * part + x, even2 + odd2);
    vf_store(to + 4 * part + x, even2 - odd2);
    vf_store(to + 5 * part + x, g[3]);
}

/* to: (PARTS, channels, slab).  Rows below the map are 0. */
static void transform_gradients(float *to, const ptie_map *out_grad, const slab *at) {
    static const float nothing[COLUMNS + VEC_WIDTH] = {0};
    const ptrdiff_t part = out_grad->channels * at->floats;
    for (int32_t c = 0; c < out_grad->channels; c++)
        for (int32_t s = 0; s < at->strips; s++) {
            const float *row[ROWS];
            for (int32_t r = 0; r < ROWS; r++) {
                const int32_t y = at->y + s * ROWS + r;
                row[r] = y < out_grad->height ? row_of(out_grad, c, y) + at->x : nothing;
            }
            float *strip = to + c * at->floats + s * at->step;
            for (int32_t x = 0; x < at->width; x += VEC_WIDTH)
                transform_gradient(strip, part, row, x, at->width - x);
        }
}

/* to: (PARTS, channels, slab), beginning one pixel to the left. */
static void transform_inputs(float *to, const ptie_map *in, const slab *at) {
    for (int32_t c = 0; c < in->channels; c++)
        for (int32_t s = 0; s < at->strips; s++)
            transform_input(to + c * at->floats + s * at->step, in->channels * at->floats, in, c,
                            at->y + s * ROWS, at->x, at->width);
}

/* Sums over a slab, for OUT output channels, one input channel and one part, of the products
   under the 3 taps.  Channels that do not exist repeat the last one. */
static void weigh_slab(float sums[OUT * 3], const float *gradient, int32_t channels,
                       const float *input, const slab *at, cursor *ahead) {
    const float *row[OUT];
    for (int32_t o = 0; o < OUT; o++) row[o] = gradient + smaller(o, channels - 1) * at->floats;
    vf sum[OUT * 3];
    UNROLL (i, OUT * 3) sum[i] = (vf){0};
    for (int32_t s = 0; s < at->strips; s++) {
        const ptrdiff_t strip = s * at->step;
        for (ptrdiff_t i = strip; i < strip + at->width; i += VEC_WIDTH) {
            vf pixel[3];
            UNROLL (k, 3) pixel[k] = vf_load(input + i + k);
            UNROLL (o, OUT) {
                const vf g = vf_hold(vf_load(row[o] + i));
                UNROLL (k, 3) sum[o * 3 + k] += g * pixel[k];
            }
        }
        fetch_some(ahead);
    }
    vf_sums(sums, sum, OUT * 3);
}

/* Adds G' times the parts' sums to the 3x3 gradients of one pair of channels, (N9). */
static void join_weights(double *grad, const float *sums, ptrdiff_t part) {
    for (int k = 0; k < 3; k++) {
        double m[PARTS];
        for (int j = 0; j < PARTS; j++) m[j] = (double)sums[j * part + k];
        const double sum1 = (m[1] + m[2]) / 6, difference1 = (m[2] - m[1]) / 6;
        const double sum2 = (m[3] + m[4]) / 24, difference2 = (m[3] - m[4]) / 12;
        grad[k] += m[0] / 4 - sum1 + sum2;
        grad[3 + k] += difference1 + difference2;
        grad[6 + k] += 4 * sum2 - sum1 + m[5];
    }
}

/* One block of output channels: sums (PARTS, in, OUT, 3), then their joining. */
static void weigh_block(double *grad, int32_t channels, int32_t in_channels, const float *gradient,
                        ptrdiff_t gradient_part, const float *input, float *sums, const slab *at,
                        cursor *ahead) {
    const ptrdiff_t part = (ptrdiff_t)in_channels * OUT * 3;
    for (int j = 0; j < PARTS; j++)
        for (int32_t i = 0; i < in_channels; i++)
            weigh_slab(sums + j * part + i * OUT * 3, gradient + j * gradient_part, channels,
                       input + (j * in_channels + i) * at->floats, at, ahead);
    for (int32_t o = 0; o < channels; o++)
        for (int32_t i = 0; i < in_channels; i++)
            join_weights(grad + (o * in_channels + i) * 9, sums + (i * OUT + o) * 3, part);
}

void VEC(conv3x3_weights)(double *grad, const ptie_map *out_grad, const ptie_map *in,
                          float *scratch, const ptie_ahead *ahead) {
    const int32_t inputs = in->channels, outputs = out_grad->channels;
    slab at = slab_shape(out_grad->height, out_grad->width);
    const int32_t most_strips = at.strips, most_columns = at.width;
    float *gradient = scratch, *input = gradient + PARTS * outputs * at.floats;
    float *sums = input + PARTS * inputs * at.floats;
    cursor next = cursor_start(ahead, (int64_t)PARTS * inputs * parts_of(outputs, OUT) *
                                          parts_of(out_grad->height, ROWS) *
                                          parts_of(out_grad->width, most_columns));
    for (at.y = 0; at.y < out_grad->height; at.y += most_strips * ROWS)
        for (at.x = 0; at.x < out_grad->width; at.x += most_columns) {
            at.strips = smaller((out_grad->height - at.y + ROWS - 1) / ROWS, most_strips);
            at.width = smaller(out_grad->width - at.x, most_columns);
            transform_gradients(gradient, out_grad, &at);
            transform_inputs(input, in, &at);
            for (int32_t o = 0; o < outputs; o += OUT)
                weigh_block(grad + (ptrdiff_t)o * inputs * 9, smaller(outputs - o, OUT), inputs,
                            gradient + o * at.floats, outputs * at.floats, input, sums, &at, &next);
        }
}
