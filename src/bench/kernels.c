/* SPDX-License-Identifier: BSD-3-Clause */
/* The kernels of kernels.inc and half_kernels.inc, one row of a table each: at which shapes, and
 * what one call does.
 *
 * Every thread has maps of its own and calls the kernel on whole maps, of the sizes they have in
 * the paper's network on frames of 256 x 256.  Traffic counts every map once per read and once per
 * write, as if nothing stayed in a cache.
 */
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/random.h"
#include "bench/groups.h"
#include "kernel/half.h"

typedef struct shape {
    int32_t in, out, side; /* channels; maps of side x side */
} shape;

/* What the kernels work on: `in` (I, S, S), `out` (O, S, S), and at half the size of `out`. */
typedef struct maps {
    ptie_map in, out, half, half_grad;
    ptie_map in16, out16, half16; /* the same in half precision */
    const ptie_half_kernels *kernels16;
    float *pairs;                           /* weights in the order of conv3x3 there */
    float *weights, *bias;                  /* (O, I, 3, 3); (O) */
    float *packed, *adjoint;                /* weights in the order of conv3x3 ... */
    float *parts, *parts_adjoint, *scratch; /* ... and of winograd3x3 */
    ptie_norm *norms;                       /* (O) */
    double *sums;                           /* as many as a gradient of the weights, and biases */
    float *image, *other, *row;             /* contiguous (S, S) */
} maps;

typedef struct kernel_case {
    const char *kernel; /* name in one of the lists */
    const char *label;
    const shape *shapes;
    int32_t count;
    int32_t taps;         /* multiply-adds per pixel, input and output channel; or */
    double in, out, half; /* how often a call reads or writes these maps; as halves: 0.5 */
    void (*call)(const ptie_kernels *kernels, const maps *m);
} kernel_case;

#define COUNT(array) ((int32_t)(sizeof(array) / sizeof *(array)))
#define SHAPES(array) (array), COUNT(array)

/* Every 3x3 convolution of the paper's network, and what surrounds those of the first level. */
static const shape convolutions[] = {{1, 8, 256},  {8, 8, 256},  {8, 16, 128},  {16, 16, 128},
                                     {16, 32, 64}, {32, 32, 64}, {48, 16, 128}, {24, 8, 256}};
static const shape activation[] = {{8, 8, 256}};
static const shape head[] = {{8, 1, 256}};
static const shape image[] = {{1, 1, 256}};
/* The family's other widths. */
static const shape widths[] = {{4, 4, 256},   {8, 8, 256},   {14, 14, 256}, {16, 16, 256},
                               {18, 18, 256}, {24, 24, 256}, {32, 32, 256}};

static const float taps[PTIE_SSIM_WINDOW] = {0.001f, 0.008f, 0.036f, 0.109f, 0.213f, 0.266f,
                                             0.213f, 0.109f, 0.036f, 0.008f, 0.001f};

static void conv3x3(const ptie_kernels *k, const maps *m) {
    k->conv3x3(&m->out, &m->in, m->packed, m->bias, true);
}
static void conv3x3_input(const ptie_kernels *k, const maps *m) {
    k->conv3x3(&m->in, &m->out, m->adjoint, NULL, false);
}
static void winograd3x3(const ptie_kernels *k, const maps *m) {
    k->winograd3x3(&m->out, &m->in, m->parts, m->bias, true, NULL, m->scratch, NULL);
}
static void winograd3x3_input(const ptie_kernels *k, const maps *m) {
    k->winograd3x3(&m->in, &m->out, m->parts_adjoint, NULL, false, NULL, m->scratch, NULL);
}
static void conv3x3_weights(const ptie_kernels *k, const maps *m) {
    k->conv3x3_weights(m->sums, &m->out, &m->in, m->scratch, NULL);
}
static void conv1x1(const ptie_kernels *k, const maps *m) {
    k->conv1x1(&m->out, &m->in, m->weights, m->bias);
}
static void conv1x1_weights(const ptie_kernels *k, const maps *m) {
    k->conv1x1_weights(m->sums, m->sums + m->in.channels * m->out.channels, &m->out, &m->in);
}
static void winograd3x3_moments(const ptie_kernels *k, const maps *m) {
    k->winograd3x3(&m->out, &m->in, m->parts, NULL, false, m->sums, m->scratch, NULL);
}
static void normalise(const ptie_kernels *k, const maps *m) {
    k->normalise(&m->out, &m->in, m->norms);
}
static void normalise_sums(const ptie_kernels *k, const maps *m) {
    k->normalise_sums(m->sums, &m->out, &m->in, m->norms);
}
static void normalise_backward(const ptie_kernels *k, const maps *m) {
    k->normalise_backward(&m->out, &m->out, &m->in, m->norms);
}
static void maxpool(const ptie_kernels *k, const maps *m) {
    k->maxpool(&m->half, &m->in);
}
static void maxpool_backward(const ptie_kernels *k, const maps *m) {
    k->maxpool_backward(&m->out, &m->half_grad, &m->in, &m->half);
}
static void upsample(const ptie_kernels *k, const maps *m) {
    k->upsample(&m->out, &m->half, 0);
}
static void upsample_backward(const ptie_kernels *k, const maps *m) {
    k->upsample_backward(&m->half_grad, &m->out, 0);
}
static void sigmoid(const ptie_kernels *k, const maps *m) {
    k->sigmoid(&m->out, &m->in);
}
static void window(const ptie_kernels *k, const maps *m) {
    k->window(m->other, m->image, m->in.width, m->in.height, taps, m->row);
}
static void window_adjoint(const ptie_kernels *k, const maps *m) {
    k->window_adjoint(m->image, m->other, m->in.width, m->in.height, taps, m->row);
}

static void conv3x3_16(const ptie_kernels *k, const maps *m) {
    (void)k;
    m->kernels16->conv3x3(&m->out16, &m->in16, m->pairs, m->bias);
}
static void conv1x1_16(const ptie_kernels *k, const maps *m) {
    (void)k;
    m->kernels16->conv1x1(&m->out, &m->in16, m->weights, m->bias);
}
static void maxpool_16(const ptie_kernels *k, const maps *m) {
    (void)k;
    m->kernels16->maxpool(&m->half16, &m->in16);
}
static void upsample_16(const ptie_kernels *k, const maps *m) {
    (void)k;
    m->kernels16->upsample(&m->out16, &m->half16, 0);
}
static void narrow_16(const ptie_kernels *k, const maps *m) {
    (void)k;
    for (int32_t y = 0; y < m->in.height; y++)
        m->kernels16->narrow((ptie_half *)(m->in16.data + y * m->in16.row),
                             m->image + (ptrdiff_t)y * m->in.width, m->in.width);
}

static const kernel_case kernel_cases[] = {
    {"conv3x3", "3x3", SHAPES(convolutions), .taps = 9, .call = conv3x3},
    {"conv3x3", "3x3 input gradient", convolutions + 1, COUNT(convolutions) - 1, .taps = 9,
     .call = conv3x3_input}, /* nobody asks for the gradient of the image */
    /* Its operations are counted as those of the direct sums. */
    {"winograd3x3", "3x3 Winograd", SHAPES(convolutions), .taps = 9, .call = winograd3x3},
    {"winograd3x3", "3x3 Winograd with moments", SHAPES(convolutions), .taps = 9,
     .call = winograd3x3_moments},
    {"winograd3x3", "3x3 Winograd input gradient", convolutions + 1, COUNT(convolutions) - 1,
     .taps = 9, .call = winograd3x3_input},
    {"conv3x3_weights", "3x3 weight gradient", SHAPES(convolutions), .taps = 9,
     .call = conv3x3_weights},
    {"conv1x1", "1x1", SHAPES(head), .in = 1, .out = 1, .call = conv1x1},
    {"conv1x1_weights", "1x1 weight gradient", SHAPES(head), .in = 1, .out = 1,
     .call = conv1x1_weights},
    {"normalise", "normalise", SHAPES(activation), .in = 1, .out = 1, .call = normalise},
    {"normalise_sums", "normalise: sums", SHAPES(activation), .in = 1, .out = 1,
     .call = normalise_sums},
    {"normalise_backward", "normalise: backward", SHAPES(activation), .in = 1, .out = 2,
     .call = normalise_backward},
    {"maxpool", "max-pool", SHAPES(activation), .in = 1, .half = 1, .call = maxpool},
    {"maxpool_backward", "max-pool: backward", SHAPES(activation), .in = 1, .out = 2, .half = 2,
     .call = maxpool_backward},
    {"upsample", "upsample", SHAPES(activation), .out = 1, .half = 1, .call = upsample},
    {"upsample_backward", "upsample: backward", SHAPES(activation), .out = 1, .half = 2,
     .call = upsample_backward},
    {"sigmoid", "sigmoid", SHAPES(image), .in = 1, .out = 1, .call = sigmoid},
    {"window", "SSIM window", SHAPES(image), .in = 1, .out = 1, .call = window},
    {"window_adjoint", "SSIM window: adjoint", SHAPES(image), .in = 1, .out = 1,
     .call = window_adjoint},
};

/* Where there is half precision.  Shares are of the peak of single precision. */
static const kernel_case half_cases[] = {
    {"conv3x3", "half precision: 3x3", SHAPES(convolutions), .taps = 9, .call = conv3x3_16},
    {"conv1x1", "half precision: 1x1", SHAPES(head), .in = 0.5, .out = 1, .call = conv1x1_16},
    {"maxpool", "half precision: max-pool", SHAPES(activation), .in = 0.5, .half = 0.5,
     .call = maxpool_16},
    {"upsample", "half precision: upsample", SHAPES(activation), .out = 0.5, .half = 0.5,
     .call = upsample_16},
    {"narrow", "half precision: narrow", SHAPES(image), .in = 1, .out = 0.5, .call = narrow_16},
};

static const kernel_case family_cases[] = {
    {"conv3x3", "3x3", SHAPES(widths), .taps = 9, .call = conv3x3},
    {"winograd3x3", "3x3 Winograd", SHAPES(widths), .taps = 9, .call = winograd3x3},
};

/* A fresh map in the block; its halo is zero. */
static ptie_map slice_map(ptie_slicer *slicer, int32_t channels, int32_t side) {
    const ptie_map map = ptie_map_make(channels, side, side);
    float *block = ptie_slice(slicer, ptie_map_floats(&map), sizeof *block);
    return block ? ptie_map_in(map, block) : map;
}

static ptie_map slice_half_map(ptie_slicer *slicer, int32_t channels, int32_t side) {
    const ptie_map map = ptie_half_map_make(channels, side, side);
    float *block = ptie_slice(slicer, ptie_map_floats(&map), sizeof *block);
    return block ? ptie_map_in(map, block) : map;
}

/* Hands out a zeroed block; with no block it only counts. */
static size_t slice_maps(maps *m, shape s, void *block) {
    ptie_slicer slicer = {.base = block};
    const int32_t most = s.in > s.out ? s.in : s.out;
    const size_t in = (size_t)s.in, out = (size_t)s.out, pixels = (size_t)s.side * (size_t)s.side;
    *m = (maps){
        .in = slice_map(&slicer, s.in, s.side),
        .out = slice_map(&slicer, s.out, s.side),
        .half = slice_map(&slicer, s.out, s.side / 2),
        .half_grad = slice_map(&slicer, s.out, s.side / 2),
        .in16 = slice_half_map(&slicer, s.in, s.side),
        .out16 = slice_half_map(&slicer, s.out, s.side),
        .half16 = slice_half_map(&slicer, s.out, s.side / 2),
        .pairs = ptie_slice(&slicer, ptie_conv3x3_packed(s.out, s.in), sizeof(float)),
        .weights = ptie_slice(&slicer, in * out * 9, sizeof(float)),
        .packed = ptie_slice(&slicer, ptie_conv3x3_packed(s.out, s.in), sizeof(float)),
        .adjoint = ptie_slice(&slicer, ptie_conv3x3_packed(s.in, s.out), sizeof(float)),
        .parts = ptie_slice(&slicer, ptie_winograd_packed(s.out, s.in), sizeof(float)),
        .parts_adjoint = ptie_slice(&slicer, ptie_winograd_packed(s.in, s.out), sizeof(float)),
        .scratch = ptie_slice(&slicer, ptie_winograd_scratch(most, most), sizeof(float)),
        .bias = ptie_slice(&slicer, out, sizeof(float)),
        .norms = ptie_slice(&slicer, out, sizeof(ptie_norm)),
        .sums = ptie_slice(&slicer, in * out * 9 + out, sizeof(double)),
        .image = ptie_slice(&slicer, pixels, sizeof(float)),
        .other = ptie_slice(&slicer, pixels, sizeof(float)),
        .row = ptie_slice(&slicer, (size_t)s.side + 64, sizeof(float)),
    };
    return slicer.used;
}

static void fill(float *values, size_t count, ptie_random *random) {
    for (size_t i = 0; i < count; i++) values[i] = (float)ptie_random_uniform(random, -1, 1);
}

static void fill_map(const ptie_map *map, ptie_random *random) {
    for (int32_t c = 0; c < map->channels; c++)
        for (int32_t y = 0; y < map->height; y++)
            fill(map->data + c * map->plane + y * map->row, (size_t)map->width, random);
}

/* Norms that change nothing, so that what is normalised in place again and again stays as it is. */
static void fill_maps(maps *m, shape s) {
    ptie_random random;
    ptie_random_init(&random, 0, PTIE_STREAM_WEIGHTS, 0);
    fill_map(&m->in, &random);
    fill_map(&m->out, &random);
    fill_map(&m->half, &random);
    fill_map(&m->half_grad, &random);
    fill(m->weights, (size_t)s.in * (size_t)s.out * 9, &random);
    fill(m->bias, (size_t)s.out, &random);
    fill(m->image, (size_t)s.side * (size_t)s.side, &random);
    fill(m->other, (size_t)s.side * (size_t)s.side, &random);
    for (int32_t c = 0; c < s.out; c++) m->norms[c] = (ptie_norm){.scale = 1, .inverse_std = 1};
    ptie_conv3x3_pack(m->packed, m->weights, s.out, s.in, NULL);
    ptie_conv3x3_pack_adjoint(m->adjoint, m->weights, s.out, s.in);
    ptie_conv3x3_pack(m->pairs, m->weights, s.out, s.in, NULL);
    ptie_half_pairs(m->pairs, ptie_conv3x3_packed(s.out, s.in));
    ptie_winograd_pack(m->parts, m->weights, s.out, s.in, NULL);
    ptie_winograd_pack_adjoint(m->parts_adjoint, m->weights, s.out, s.in);
}

typedef struct running {
    const kernel_case *kernel;
    const ptie_kernels *kernels;
    maps *maps; /* one per thread */
} running;

static ptie_status call(void *context, int32_t worker) {
    const running *r = context;
    r->kernel->call(r->kernels, &r->maps[worker]);
    return PTIE_OK;
}

/* "3x3 8 -> 16, 128 x 128" */
static void name_case(ptie_bench_case *c, const kernel_case *k, shape s) {
    char channels[32];
    snprintf(channels, sizeof channels, s.in == s.out ? "%d" : "%d -> %d", s.in, s.out);
    snprintf(c->name, sizeof c->name, "%s, %s, %d x %d", k->label, channels, s.side, s.side);
}

static ptie_bench_case describe(const kernel_case *k, shape s, running *context) {
    const double pixels = (double)s.side * s.side;
    const double flops = 2.0 * k->taps * s.in * s.out * pixels;
    const double floats = (k->in * s.in + k->out * s.out + k->half * s.out / 4.0) * pixels;
    ptie_bench_case c = {.unit = k->taps ? "GFLOP/s" : "GB/s",
                         .mode = PTIE_BENCH_EACH,
                         .amount = 1e-9 * (k->taps ? flops : floats * sizeof(float)),
                         .flops = k->taps ? 1e9 : 0,
                         .work = call,
                         .context = context};
    name_case(&c, k, s);
    return c;
}

static ptie_status measure_shape(ptie_bench *bench, const kernel_case *k, shape s) {
    static const char where[] = "bench";
    const size_t threads = (size_t)ptie_pool_threads(bench->engine->pool);
    maps none;
    const size_t bytes = slice_maps(&none, s, NULL);
    unsigned char *block = NULL;
    running r = {.kernel = k, .kernels = bench->engine->kernels};
    ptie_status status;
    PTIE_TRY_DONE(ptie_alloc_status(&r.maps, threads, sizeof *r.maps, where));
    PTIE_TRY_DONE(ptie_alloc_status(&block, threads, bytes, where));
    for (size_t i = 0; i < threads; i++) {
        slice_maps(&r.maps[i], s, block + i * bytes);
        fill_maps(&r.maps[i], s);
        r.maps[i].kernels16 = ptie_half_kernels_of(bench->engine->level);
    }
    const ptie_bench_case c = describe(k, s, &r);
    status = ptie_bench_measure(bench, &c);
done:
    ptie_free(block);
    ptie_free(r.maps);
    return status;
}

static ptie_status measure_all(ptie_bench *bench, const kernel_case *cases, int32_t count) {
    for (int32_t i = 0; i < count; i++)
        for (int32_t s = 0; s < cases[i].count; s++)
            PTIE_TRY(measure_shape(bench, &cases[i], cases[i].shapes[s]));
    return PTIE_OK;
}

static int32_t count_all(const kernel_case *cases, int32_t count) {
    int32_t total = 0;
    for (int32_t i = 0; i < count; i++) total += cases[i].count;
    return total;
}

/* How many of half_cases there are. */
static int32_t half_count(const ptie_engine *engine) {
    return ptie_half_kernels_of(engine->level) ? COUNT(half_cases) : 0;
}

ptie_status ptie_bench_kernels(ptie_bench *bench) {
    PTIE_TRY(measure_all(bench, kernel_cases, COUNT(kernel_cases)));
    return measure_all(bench, half_cases, half_count(bench->engine));
}

int32_t ptie_bench_kernels_count(const ptie_engine *engine) {
    return count_all(kernel_cases, COUNT(kernel_cases)) + count_all(half_cases, half_count(engine));
}

ptie_status ptie_bench_family(ptie_bench *bench) {
    return measure_all(bench, family_cases, COUNT(family_cases));
}

int32_t ptie_bench_family_count(const ptie_engine *engine) {
    (void)engine;
    return count_all(family_cases, COUNT(family_cases));
}

bool ptie_bench_has_kernel(const char *name) {
    for (int32_t i = 0; i < COUNT(kernel_cases); i++)
        if (strcmp(kernel_cases[i].kernel, name) == 0) return true;
    return false;
}
