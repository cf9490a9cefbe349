/* SPDX-License-Identifier: BSD-3-Clause */
/* Every kernel of every level this machine runs against its scalar twin: all widths from one pixel
 * to past three blocks, channel counts with every tail, odd strides, unaligned rows.  Nothing
 * outside the interior may change.
 *
 * Two sums of the same n products in different orders differ by at most 2 gamma_n sum |a b|
 * (Higham, Accuracy and Stability, 3.1); sum |a b| is what the scalar twin makes of the magnitudes.
 */
#include "kernel/block.h"

enum { WIDEST = 3 * 32 + 1 }; /* the widest block is 2 vectors of 16 */

static const int32_t channel_counts[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 16, 24, 32, 48};
enum { CHANNEL_COUNTS = sizeof channel_counts / sizeof *channel_counts };

/* One case: sizes, the kernel under test, its twin, random numbers. */
typedef struct twin {
    const ptie_kernels *kernels, *scalar;
    block_sizes size;
    ptie_random random;
} twin;

static double uniform(twin *t, double low, double high) {
    return ptie_random_uniform(&t->random, low, high);
}

/* Interior: |found - expected| <= factor * magnitude + extra; elsewhere the same bits.  magnitude
 * NULL: 0. */
static void compare(const twin *t, const block *found, const block *expected,
                    const block *magnitude, double factor, const double *extra,
                    const char *kernel) {
    const ptie_map *map = &found->map;
    bool *inside = calloc(found->floats, sizeof *inside);
    size_t pixel = 0;
    for (int32_t c = 0; c < map->channels; c++)
        for (int32_t y = 0; y < map->height; y++)
            for (int32_t x = 0; x < map->width; x++, pixel++) {
                inside[block_pixel(found, c, y, x) - found->memory] = true;
                double difference = fabs((double)*block_pixel(found, c, y, x) -
                                         (double)*block_pixel(expected, c, y, x));
                double bound = (magnitude ? factor * (double)*block_pixel(magnitude, c, y, x) : 0) +
                               (extra ? extra[pixel] : 0);
                if (!(difference <= bound))
                    fail_msg("%s: %d -> %d channels, %d x %d, at (%d, %d, %d): off by %g, bound %g",
                             kernel, t->size.in_channels, t->size.out_channels, t->size.width,
                             t->size.height, c, y, x, difference, bound);
            }
    for (size_t i = 0; i < found->floats; i++)
        if (!inside[i] && memcmp(&found->memory[i], &expected->memory[i], sizeof(float)) != 0)
            fail_msg("%s: %d -> %d channels, %d x %d: wrote outside, %zu floats into the block",
                     kernel, t->size.in_channels, t->size.out_channels, t->size.width,
                     t->size.height, i);
    free(inside);
}

static void compare_sums(const twin *t, const double *found, const double *expected,
                         const double *magnitude, double factor, size_t count, const char *kernel) {
    for (size_t i = 0; i < count; i++)
        if (!(fabs(found[i] - expected[i]) <= factor * magnitude[i]))
            fail_msg("%s: %d -> %d channels, %d x %d, sum %zu: found %.9g, expected %.9g, bound %g",
                     kernel, t->size.in_channels, t->size.out_channels, t->size.width,
                     t->size.height, i, found[i], expected[i], factor * magnitude[i]);
}

static float *make_floats(twin *t, size_t count) {
    float *values = malloc(count * sizeof *values);
    for (size_t i = 0; i < count; i++) values[i] = (float)uniform(t, -1, 1);
    return values;
}

static float *magnitudes(const float *values, size_t count) {
    float *result = malloc(count * sizeof *result);
    for (size_t i = 0; i < count; i++) result[i] = fabsf(values[i]);
    return result;
}

/* Rounds to eighths, so that equal neighbours occur. */
static void make_ties(block *b) {
    for (size_t i = 0; i < b->floats; i++) b->memory[i] = roundf(b->memory[i] * 8) / 8;
}

static void test_conv3x3(twin *t) {
    const size_t weight_count = (size_t)t->size.out_channels * (size_t)t->size.in_channels * 9;
    const size_t packed_count = ptie_conv3x3_packed(t->size.out_channels, t->size.in_channels);
    block in = block_make(t->size.in_channels, t->size.height, t->size.width, &t->random),
          in_abs = block_absolute(&in);
    block found = block_make(t->size.out_channels, t->size.height, t->size.width, &t->random);
    block expected = block_copy(&found), magnitude = block_copy(&found);
    float *weights = make_floats(t, weight_count),
          *bias = make_floats(t, (size_t)t->size.out_channels);
    float *packed = guarded_make(packed_count, false);
    ptie_conv3x3_pack(packed, weights, t->size.out_channels, t->size.in_channels, NULL);
    float *packed_abs = magnitudes(packed, packed_count),
          *bias_abs = magnitudes(bias, (size_t)t->size.out_channels);
    t->scalar->conv3x3(&magnitude.map, &in_abs.map, packed_abs, bias_abs, false);
    for (int variant = 0; variant < 3; variant++) { /* bare; with bias; with bias and ReLU */
        const float *used = variant ? bias : NULL;
        t->kernels->conv3x3(&found.map, &in.map, packed, used, variant == 2);
        t->scalar->conv3x3(&expected.map, &in.map, packed, used, variant == 2);
        compare(t, &found, &expected, &magnitude, 2 * gamma_n(9 * t->size.in_channels + 1), NULL,
                "conv3x3");
    }
    block_free(&in), block_free(&in_abs), block_free(&found), block_free(&expected),
        block_free(&magnitude);
    free(weights), free(bias), free(packed_abs), free(bias_abs);
    guarded_free(packed, packed_count);
}

/* Products summed by one lane of a vector, and the lanes: at least 8 of them. */
static double lane_terms(const twin *t, int32_t rows) {
    return rows * ((t->size.width + 7) / 8) + 6;
}

/* Magnitudes of the matrices of minimal filtering F(4,3), docs/math.md (N9). */
static const double input_matrix[6][6] = {{4, 0, 5, 0, 1, 0}, {0, 4, 4, 1, 1, 0},
                                          {0, 4, 4, 1, 1, 0}, {0, 2, 1, 2, 1, 0},
                                          {0, 2, 1, 2, 1, 0}, {0, 4, 0, 5, 0, 1}};
static const double output_matrix[4][6] = {
    {1, 1, 1, 1, 1, 0}, {0, 1, 1, 2, 2, 0}, {0, 1, 1, 4, 4, 0}, {0, 1, 1, 8, 8, 1}};
static const double weight_matrix[6][3] = {{1. / 4, 0, 0},
                                           {1. / 6, 1. / 6, 1. / 6},
                                           {1. / 6, 1. / 6, 1. / 6},
                                           {1. / 24, 1. / 12, 1. / 6},
                                           {1. / 24, 1. / 12, 1. / 6},
                                           {0, 0, 1}};

/* Part j of the magnitudes of the six rows that begin above row y. */
static double input_part(const block *in_abs, int j, int32_t c, int32_t y, int32_t x) {
    double sum = 0;
    for (int r = 0; r < 6; r++) {
        int32_t row = y - 1 + r < in_abs->map.height ? y - 1 + r : in_abs->map.height;
        sum += input_matrix[j][r] * (double)*block_pixel(in_abs, c, row, x);
    }
    return sum;
}

/* What the magnitudes of weights and pixels add up to on the way through the parts: what rounding
   is relative to. */
static void winograd_magnitude(block *out, const block *in_abs, const float *weights_abs,
                               const float *bias_abs) {
    const ptie_map *map = &out->map;
    const int32_t inputs = in_abs->map.channels;
    for (int32_t o = 0; o < map->channels; o++)
        for (int32_t y = 0; y < map->height; y++)
            for (int32_t x = 0; x < map->width; x++) {
                double sum = (double)bias_abs[o];
                for (int32_t i = 0; i < 3 * inputs; i++)
                    for (int j = 0; j < 6; j++) {
                        const float *taps = &weights_abs[(o * inputs + i / 3) * 9 + i % 3];
                        double weight = 0;
                        for (int k = 0; k < 3; k++)
                            weight += weight_matrix[j][k] * (double)taps[3 * k];
                        sum += output_matrix[y % 4][j] * weight *
                               input_part(in_abs, j, i / 3, y - y % 4, x + i % 3 - 1);
                    }
                *block_pixel(out, o, y, x) = (float)sum;
            }
}

/* Streamed past the cache the result is the same, and its sums are those of what was stored. */
static void check_moments(twin *t, block *found, const block *in, const float *packed,
                          float *scratch) {
    const size_t count = 2 * (size_t)t->size.out_channels;
    double *sums = calloc(3 * count, sizeof *sums), *exact = sums + count, *size = exact + count;
    for (size_t i = 0; i < count; i++) sums[i] = exact[i] = 0.5; /* it adds */
    t->kernels->winograd3x3(&found->map, &in->map, packed, NULL, false, NULL, scratch, NULL);
    block streamed = block_copy(found);
    for (int32_t c = 0; c < t->size.out_channels; c++)
        for (int32_t y = 0; y < t->size.height; y++)
            for (int32_t x = 0; x < t->size.width; x++) {
                const double value = (double)*block_pixel(found, c, y, x);
                exact[2 * c] += value, size[2 * c] += fabs(value);
                exact[2 * c + 1] += value * value, size[2 * c + 1] += value * value;
                *block_pixel(&streamed, c, y, x) = 0;
            }
    t->kernels->winograd3x3(&streamed.map, &in->map, packed, NULL, false, sums, scratch, NULL);
    compare(t, &streamed, found, NULL, 0, NULL, "winograd3x3, streamed");
    compare_sums(t, sums, exact, size, gamma_n(lane_terms(t, 4)), count, "winograd3x3, moments");
    block_free(&streamed);
    free(sums);
}

static void test_winograd3x3(twin *t) {
    const size_t weight_count = (size_t)t->size.out_channels * (size_t)t->size.in_channels * 9;
    block in = block_make(t->size.in_channels, t->size.height, t->size.width, &t->random),
          in_abs = block_absolute(&in);
    block found = block_make(t->size.out_channels, t->size.height, t->size.width, &t->random);
    block expected = block_copy(&found), magnitude = block_copy(&found);
    float *weights = make_floats(t, weight_count),
          *bias = make_floats(t, (size_t)t->size.out_channels);
    float *weights_abs = magnitudes(weights, weight_count),
          *bias_abs = magnitudes(bias, (size_t)t->size.out_channels);
    const size_t packed_count = ptie_winograd_packed(t->size.out_channels, t->size.in_channels);
    const size_t direct_count = ptie_conv3x3_packed(t->size.out_channels, t->size.in_channels);
    const size_t scratch_count = ptie_winograd_scratch(t->size.out_channels, t->size.in_channels);
    float *packed = guarded_make(packed_count, false), *direct = guarded_make(direct_count, false);
    float *scratch = guarded_make(scratch_count, false);
    ptie_winograd_pack(packed, weights, t->size.out_channels, t->size.in_channels, NULL);
    ptie_conv3x3_pack(direct, weights, t->size.out_channels, t->size.in_channels, NULL);
    winograd_magnitude(&magnitude, &in_abs, weights_abs, bias_abs);
    /* Roundings in a row: 1 of the weights, 6 of the input's transform, 3 I products and sums, 6 of
       the output's, 1 of the bias; the direct sums are shorter and of smaller magnitude. */
    const double factor = 2 * gamma_n(3 * t->size.in_channels + 14);
    for (int variant = 0; variant < 3; variant++) {
        const float *used = variant ? bias : NULL;
        t->kernels->winograd3x3(&found.map, &in.map, packed, used, variant == 2, NULL, scratch,
                                NULL);
        t->scalar->winograd3x3(&expected.map, &in.map, packed, used, variant == 2, NULL, scratch,
                               NULL);
        compare(t, &found, &expected, &magnitude, factor, NULL, "winograd3x3");
        t->scalar->conv3x3(&expected.map, &in.map, direct, used, variant == 2);
        compare(t, &found, &expected, &magnitude, factor + 2 * gamma_n(9 * t->size.in_channels),
                NULL, "winograd3x3, direct");
    }
    check_moments(t, &found, &in, packed, scratch);
    block_free(&in), block_free(&in_abs), block_free(&found), block_free(&expected),
        block_free(&magnitude);
    free(weights), free(bias), free(weights_abs), free(bias_abs);
    guarded_free(packed, packed_count), guarded_free(direct, direct_count);
    guarded_free(scratch, scratch_count);
}

/* Magnitude of the gradient of one tap: over strips and parts, |G'| (|A| |g|) (|B'| |d|). */
static double gradient_magnitude(const block *g_abs, const block *in_abs, int32_t o, int32_t i,
                                 int32_t tap) {
    double total = 0;
    for (int32_t y = 0; y < g_abs->map.height; y += 4)
        for (int32_t x = 0; x < g_abs->map.width; x++)
            for (int j = 0; j < 6; j++) {
                double gradient = 0;
                for (int r = 0; r < 4 && y + r < g_abs->map.height; r++)
                    gradient += output_matrix[r][j] * (double)*block_pixel(g_abs, o, y + r, x);
                total += weight_matrix[j][tap / 3] * gradient *
                         input_part(in_abs, j, i, y, x + tap % 3 - 1);
            }
    return total;
}

static void test_conv3x3_weights(twin *t) {
    const int32_t inputs = t->size.in_channels;
    const size_t count = (size_t)t->size.out_channels * (size_t)inputs * 9;
    block in = block_make(inputs, t->size.height, t->size.width, &t->random),
          in_abs = block_absolute(&in);
    block g = block_make(t->size.out_channels, t->size.height, t->size.width, &t->random),
          g_abs = block_absolute(&g);
    double *sums = calloc(3 * count, sizeof *sums);
    const size_t scratch_count = ptie_winograd_scratch(t->size.out_channels, inputs);
    float *scratch = guarded_make(scratch_count, false);
    for (size_t i = 0; i < count; i++) {
        sums[i] = sums[count + i] = 0.5; /* it adds */
        const int32_t o = (int32_t)i / 9 / inputs, c = (int32_t)i / 9 % inputs;
        sums[2 * count + i] = gradient_magnitude(&g_abs, &in_abs, o, c, (int32_t)i % 9);
    }
    t->kernels->conv3x3_weights(sums, &g.map, &in.map, scratch, NULL);
    t->scalar->conv3x3_weights(sums + count, &g.map, &in.map, scratch, NULL);
    /* 6 + 4 roundings of the transforms, then the lanes. */
    compare_sums(t, sums, sums + count, sums + 2 * count,
                 gamma_n(10 + lane_terms(t, (t->size.height + 3) / 4)), count, "conv3x3_weights");
    block_free(&in), block_free(&in_abs), block_free(&g), block_free(&g_abs);
    free(sums);
    guarded_free(scratch, scratch_count);
}

static void test_conv1x1(twin *t) {
    const size_t count = (size_t)t->size.out_channels * (size_t)t->size.in_channels;
    block in = block_make(t->size.in_channels, t->size.height, t->size.width, &t->random),
          in_abs = block_absolute(&in);
    block found = block_make(t->size.out_channels, t->size.height, t->size.width, &t->random);
    block expected = block_copy(&found), magnitude = block_copy(&found);
    float *weights = make_floats(t, count), *bias = make_floats(t, (size_t)t->size.out_channels);
    float *weights_abs = magnitudes(weights, count),
          *bias_abs = magnitudes(bias, (size_t)t->size.out_channels);
    t->scalar->conv1x1(&magnitude.map, &in_abs.map, weights_abs, bias_abs);
    for (int with_bias = 0; with_bias < 2; with_bias++) {
        t->kernels->conv1x1(&found.map, &in.map, weights, with_bias ? bias : NULL);
        t->scalar->conv1x1(&expected.map, &in.map, weights, with_bias ? bias : NULL);
        compare(t, &found, &expected, &magnitude, 2 * gamma_n(t->size.in_channels + 1), NULL,
                "conv1x1");
    }
    block_free(&in), block_free(&in_abs), block_free(&found), block_free(&expected),
        block_free(&magnitude);
    free(weights), free(bias), free(weights_abs), free(bias_abs);
}

static void test_conv1x1_weights(twin *t) {
    const size_t weights = (size_t)t->size.out_channels * (size_t)t->size.in_channels;
    const size_t count = weights + (size_t)t->size.out_channels; /* the biases follow */
    block in = block_make(t->size.in_channels, t->size.height, t->size.width, &t->random),
          in_abs = block_absolute(&in);
    block g = block_make(t->size.out_channels, t->size.height, t->size.width, &t->random),
          g_abs = block_absolute(&g);
    double *sums = calloc(3 * count, sizeof *sums);
    for (size_t i = 0; i < count; i++) sums[i] = sums[count + i] = 0.5;
    t->kernels->conv1x1_weights(sums, sums + weights, &g.map, &in.map);
    t->scalar->conv1x1_weights(sums + count, sums + count + weights, &g.map, &in.map);
    t->scalar->conv1x1_weights(sums + 2 * count, sums + 2 * count + weights, &g_abs.map,
                               &in_abs.map);
    compare_sums(t, sums, sums + count, sums + 2 * count, gamma_n(lane_terms(t, t->size.height)),
                 count, "conv1x1_weights");
    block_free(&in), block_free(&in_abs), block_free(&g), block_free(&g_abs);
    free(sums);
}

static ptie_norm *make_norms(twin *t) {
    ptie_norm *norms = malloc((size_t)t->size.out_channels * sizeof *norms);
    for (int32_t c = 0; c < t->size.out_channels; c++)
        norms[c] = (ptie_norm){.scale = (float)uniform(t, -2, 2),
                               .shift = (float)uniform(t, -1, 1),
                               .mean = (float)uniform(t, -0.5, 0.5),
                               .inverse_std = (float)uniform(t, 0.5, 2),
                               .mean_g = (float)uniform(t, -0.1, 0.1),
                               .mean_gx = (float)uniform(t, -0.1, 0.1)};
    return norms;
}

/* Rounding of scale * z + shift; where the value itself is smaller, the ReLU may be open or shut.
 */
static double normalise_rounding(const ptie_norm *norm, double z) {
    return gamma_n(3) * (fabs((double)norm->scale * z) + fabs((double)norm->shift));
}

static bool undecided(const ptie_norm *norm, double z) {
    return fabs((double)norm->scale * z + (double)norm->shift) <= normalise_rounding(norm, z);
}

static void test_normalise(twin *t) {
    block z = block_make(t->size.out_channels, t->size.height, t->size.width, &t->random);
    block found = block_make(t->size.out_channels, t->size.height, t->size.width, &t->random),
          expected = block_copy(&found);
    ptie_norm *norms = make_norms(t);
    double *bound =
        malloc((size_t)(t->size.out_channels * t->size.height * t->size.width) * sizeof *bound);
    size_t pixel = 0;
    for (int32_t c = 0; c < t->size.out_channels; c++)
        for (int32_t y = 0; y < t->size.height; y++)
            for (int32_t x = 0; x < t->size.width; x++)
                bound[pixel++] = normalise_rounding(&norms[c], (double)*block_pixel(&z, c, y, x));
    t->kernels->normalise(&found.map, &z.map, norms);
    t->scalar->normalise(&expected.map, &z.map, norms);
    compare(t, &found, &expected, NULL, 0, bound, "normalise");
    block_free(&z), block_free(&found), block_free(&expected);
    free(norms), free(bound);
}

static void test_normalise_sums(twin *t) {
    const size_t count = 2 * (size_t)t->size.out_channels;
    block z = block_make(t->size.out_channels, t->size.height, t->size.width, &t->random);
    block g = block_make(t->size.out_channels, t->size.height, t->size.width, &t->random);
    ptie_norm *norms = make_norms(t);
    double *sums = calloc(3 * count, sizeof *sums), *bound = sums + 2 * count;
    const double factor = gamma_n(lane_terms(t, t->size.height) + 3);
    for (int32_t c = 0; c < t->size.out_channels; c++)
        for (int32_t y = 0; y < t->size.height; y++)
            for (int32_t x = 0; x < t->size.width; x++) {
                double value = (double)*block_pixel(&z, c, y, x);
                double xhat = (value - (double)norms[c].mean) * (double)norms[c].inverse_std;
                double weight = fabs((double)*block_pixel(&g, c, y, x)) *
                                (undecided(&norms[c], value) ? 1 : factor);
                bound[2 * c] += weight;
                bound[2 * c + 1] += weight * fabs(xhat);
            }
    t->kernels->normalise_sums(sums, &g.map, &z.map, norms);
    t->scalar->normalise_sums(sums + count, &g.map, &z.map, norms);
    compare_sums(t, sums, sums + count, bound, 1, count, "normalise_sums");
    block_free(&z), block_free(&g);
    free(norms), free(sums);
}

static void test_normalise_backward(twin *t) {
    block z = block_make(t->size.out_channels, t->size.height, t->size.width, &t->random);
    block g = block_make(t->size.out_channels, t->size.height, t->size.width, &t->random);
    block found = block_make(t->size.out_channels, t->size.height, t->size.width, &t->random),
          expected = block_copy(&found);
    ptie_norm *norms = make_norms(t);
    double *bound =
        malloc((size_t)(t->size.out_channels * t->size.height * t->size.width) * sizeof *bound);
    size_t pixel = 0;
    for (int32_t c = 0; c < t->size.out_channels; c++)
        for (int32_t y = 0; y < t->size.height; y++)
            for (int32_t x = 0; x < t->size.width; x++) {
                const ptie_norm *n = &norms[c];
                double value = (double)*block_pixel(&z, c, y, x),
                       grad = (double)*block_pixel(&g, c, y, x);
                double xhat = (value - (double)n->mean) * (double)n->inverse_std;
                double size =
                    fabs(grad) + fabs((double)n->mean_g) + fabs(xhat * (double)n->mean_gx);
                bound[pixel++] = fabs((double)n->scale) *
                                 (gamma_n(6) * size + (undecided(n, value) ? fabs(grad) : 0));
            }
    t->kernels->normalise_backward(&found.map, &g.map, &z.map, norms);
    t->scalar->normalise_backward(&expected.map, &g.map, &z.map, norms);
    compare(t, &found, &expected, NULL, 0, bound, "normalise_backward");
    block_free(&z), block_free(&g), block_free(&found), block_free(&expected);
    free(norms), free(bound);
}

static void test_maxpool(twin *t) {
    block in = block_make(t->size.out_channels, 2 * t->size.height, 2 * t->size.width, &t->random);
    block found = block_make(t->size.out_channels, t->size.height, t->size.width, &t->random),
          expected = block_copy(&found);
    make_ties(&in);
    t->kernels->maxpool(&found.map, &in.map);
    t->scalar->maxpool(&expected.map, &in.map);
    compare(t, &found, &expected, NULL, 0, NULL, "maxpool");
    block_free(&in), block_free(&found), block_free(&expected);
}

static void test_maxpool_backward(twin *t) {
    block in = block_make(t->size.out_channels, 2 * t->size.height, 2 * t->size.width, &t->random);
    block out = block_make(t->size.out_channels, t->size.height, t->size.width, &t->random);
    block g = block_make(t->size.out_channels, t->size.height, t->size.width, &t->random);
    block found =
        block_make(t->size.out_channels, 2 * t->size.height, 2 * t->size.width, &t->random);
    block expected = block_copy(&found);
    make_ties(&in);
    t->scalar->maxpool(&out.map, &in.map);
    t->kernels->maxpool_backward(&found.map, &g.map, &in.map, &out.map);
    t->scalar->maxpool_backward(&expected.map, &g.map, &in.map, &out.map);
    compare(t, &found, &expected, NULL, 0, NULL, "maxpool_backward");
    block_free(&in), block_free(&out), block_free(&g), block_free(&found), block_free(&expected);
}

static void test_upsample(twin *t) {
    const int32_t first =
        t->size.width % (2 * t->size.height); /* rows first .. of the finer image */
    block in = block_make(t->size.out_channels, t->size.height, t->size.width, &t->random),
          in_abs = block_absolute(&in);
    block found =
        block_make(t->size.out_channels, 2 * t->size.height - first, 2 * t->size.width, &t->random);
    block expected = block_copy(&found), magnitude = block_copy(&found);
    t->kernels->upsample(&found.map, &in.map, first);
    t->scalar->upsample(&expected.map, &in.map, first);
    t->scalar->upsample(&magnitude.map, &in_abs.map, first);
    compare(t, &found, &expected, &magnitude, 2 * gamma_n(4), NULL, "upsample");
    block_free(&in), block_free(&in_abs), block_free(&found), block_free(&expected),
        block_free(&magnitude);
}

static void test_upsample_backward(twin *t) {
    const int32_t first = t->size.width % (2 * t->size.height), rows = 2 * t->size.height - first;
    block g =
        block_make(t->size.out_channels, 1 + t->size.width % rows, 2 * t->size.width, &t->random);
    block_clear_halo(&g); /* the kernel relies on it */
    block g_abs = block_absolute(&g);
    block found = block_make(t->size.out_channels, t->size.height, t->size.width, &t->random);
    block expected = block_copy(&found), magnitude = block_absolute(&found);
    t->kernels->upsample_backward(&found.map, &g.map, first);
    t->scalar->upsample_backward(&expected.map, &g.map, first);
    t->scalar->upsample_backward(&magnitude.map, &g_abs.map, first);
    compare(t, &found, &expected, &magnitude, 2 * gamma_n(18), NULL, "upsample_backward");
    block_free(&g), block_free(&g_abs), block_free(&found), block_free(&expected),
        block_free(&magnitude);
}

/* 1 / (1 + e): an error r of e changes the result by at most r / 4; e is good to 8 roundings in
   each twin, and the sum and the quotient round once more. */
static void test_sigmoid(twin *t) {
    block in = block_make(t->size.out_channels, t->size.height, t->size.width, &t->random);
    block found = block_make(t->size.out_channels, t->size.height, t->size.width, &t->random),
          expected = block_copy(&found);
    block ones = block_copy(&found);
    for (size_t i = 0; i < in.floats; i++) in.memory[i] *= i % 50 == 0 ? 200 : 12;
    for (size_t i = 0; i < ones.floats; i++) ones.memory[i] = 1;
    t->kernels->sigmoid(&found.map, &in.map);
    t->scalar->sigmoid(&expected.map, &in.map);
    compare(t, &found, &expected, &ones, gamma_n(2 * 8 / 4.0 + 2 * 2), NULL, "sigmoid");
    block_free(&in), block_free(&found), block_free(&expected), block_free(&ones);
}

/* Contiguous images in a block with one channel. */
static block make_image(twin *t, int32_t height, int32_t width) {
    block b = block_make(1, height, width, &t->random);
    b.map.row = width; /* what lies behind the last row stays watched */
    return b;
}

static void check_window(twin *t, bool adjoint) {
    const int32_t margin = PTIE_SSIM_WINDOW - 1, width = t->size.width + margin,
                  height = t->size.height + margin;
    block small = make_image(t, t->size.height, t->size.width),
          large = make_image(t, height, width);
    block in = adjoint ? small : large, found = adjoint ? large : small;
    block expected = block_copy(&found), magnitude = block_copy(&found),
          in_abs = block_absolute(&in);
    const size_t row_count = (size_t)(width + 64);
    float *row = guarded_make(row_count, false), taps[PTIE_SSIM_WINDOW];
    for (int i = 0; i <= PTIE_SSIM_WINDOW / 2; i++)
        taps[i] = taps[PTIE_SSIM_WINDOW - 1 - i] = (float)uniform(t, 0, 1);
    const ptie_kernels *tables[3] = {t->kernels, t->scalar, t->scalar};
    const block *outs[3] = {&found, &expected, &magnitude}, *ins[3] = {&in, &in, &in_abs};
    for (int i = 0; i < 3; i++)
        (adjoint ? tables[i]->window_adjoint : tables[i]->window)(
            outs[i]->map.data, ins[i]->map.data, width, height, taps, row);
    compare(t, &found, &expected, &magnitude, 2 * gamma_n(2 * PTIE_SSIM_WINDOW), NULL,
            adjoint ? "window_adjoint" : "window");
    block_free(&small), block_free(&large), block_free(&expected), block_free(&magnitude);
    block_free(&in_abs);
    guarded_free(row, row_count);
}

static void test_window(twin *t) {
    check_window(t, false);
}

static void test_window_adjoint(twin *t) {
    check_window(t, true);
}

/* A round multiplies the error that is there by |factor| < 1 and adds that of a product and a sum.
 */
static void test_multiply_add(twin *t) {
    float *found = make_floats(t, PTIE_CHAIN_FLOATS), expected[PTIE_CHAIN_FLOATS];
    memcpy(expected, found, sizeof expected);
    const float factor = (float)uniform(t, -1, 1), addend = (float)uniform(t, -1, 1);
    const double largest = 1 + t->size.width; /* |value| grows by less than 1 in a round */
    t->kernels->multiply_add(found, factor, addend, t->size.width);
    t->scalar->multiply_add(expected, factor, addend, t->size.width);
    for (int i = 0; i < PTIE_CHAIN_FLOATS; i++)
        assert_near((double)found[i], (double)expected[i],
                    2 * t->size.width * gamma_n(2) * largest);
    free(found);
}

static void run_cases(void (*test)(twin *)) {
    if (ptie_cpu_detect() == PTIE_CPU_SCALAR) skip();
    for (int level = 1; level <= (int)ptie_cpu_detect(); level++) {
        twin t = {.kernels = ptie_kernels_of((ptie_cpu_level)level),
                  .scalar = ptie_kernels_of(PTIE_CPU_SCALAR)};
        ptie_random_init(&t.random, 11, PTIE_STREAM_WEIGHTS, (uint64_t)level);
        for (int32_t i = 0; i < WIDEST + CHANNEL_COUNTS * CHANNEL_COUNTS; i++) {
            t.size = block_case(i, WIDEST, channel_counts, CHANNEL_COUNTS);
            test(&t);
        }
        static const block_sizes large[] = {{3, 9, 300, 18}, {2, 3, 40, 70}}; /* several tiles */
        for (int i = 0; i < 2; i++) {
            t.size = large[i];
            test(&t);
        }
    }
}

#define PTIE_KERNEL(name, parameters)                                                              \
    static void name##_equals_its_twin(void **state) {                                             \
        (void)state;                                                                               \
        run_cases(test_##name);                                                                    \
    }
#include "kernel/kernels.inc"
#undef PTIE_KERNEL

int main(void) {
    const struct CMUnitTest tests[] = {
#define PTIE_KERNEL(name, parameters) cmocka_unit_test(name##_equals_its_twin),
#include "kernel/kernels.inc"
#undef PTIE_KERNEL
    };
    return cmocka_run_group_tests_name("twins", tests, NULL, NULL);
}
