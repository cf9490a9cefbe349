/* SPDX-License-Identifier: BSD-3-Clause */
/* Halves: what rounding makes of every one of them, and the kernels that compute with them against
 * their twins.  Nothing outside the interior may change.
 *
 * A chain of n multiply-adds in half precision is off by at most gamma_n sum |a b| and, among the
 * subnormals, by n times half of the smallest number; the twins round once.
 */
#include "kernel/half.h"

#include "kernel/block.h"

enum { WIDEST = 3 * 64 + 1, LARGEST = 0x7bff /* 65504 */ };

static const int32_t channel_counts[] = {1, 2, 3, 4, 7, 8, 9, 16, 24, 48};
enum { CHANNEL_COUNTS = sizeof channel_counts / sizeof *channel_counts };

/* One case: sizes, the kernels under test, random numbers. */
typedef struct twin {
    const ptie_half_kernels *kernels, *scalar;
    block_sizes size;
    bool exact; /* only small integers: nothing is rounded */
    ptie_random random;
} twin;

static double half_gamma(double n) {
    const double u = 0x1p-11;
    return n * u / (1 - n * u);
}

static float number(twin *t, int32_t low, int32_t high) {
    return t->exact ? (float)ptie_random_integer(&t->random, low, high)
                    : (float)ptie_random_uniform(&t->random, low, high);
}

/* Of halves in [low, high]: a block of floats has room for two each. */
static block half_block(twin *t, int32_t channels, int32_t height, int32_t width, int32_t low,
                        int32_t high) {
    block b = block_make(channels, height, width, &t->random);
    ptie_half *memory = (ptie_half *)b.memory;
    for (size_t i = 0; i < 2 * b.floats; i++) memory[i] = ptie_half_from(number(t, low, high));
    return b;
}

static ptie_half *half_pixel(const block *b, int32_t c, int32_t y, int32_t x) {
    return (ptie_half *)block_pixel(b, c, y, 0) + x;
}

static double value_at(const block *b, int32_t c, int32_t y, int32_t x) {
    return (double)ptie_half_to(*half_pixel(b, c, y, x));
}

/* Interior: |found - expected| <= factor * magnitude + extra, floats of the same shape, NULL for 0;
   elsewhere the same bits. */
static void compare(const twin *t, const block *found, const block *expected,
                    const block *magnitude, double factor, double extra, const char *kernel) {
    const ptie_map *map = &found->map;
    block outside = block_copy(found);
    for (int32_t c = 0; c < map->channels; c++)
        for (int32_t y = 0; y < map->height; y++)
            for (int32_t x = 0; x < map->width; x++) {
                const double size = magnitude ? (double)*block_pixel(magnitude, c, y, x) : 0;
                const double difference =
                    fabs(value_at(found, c, y, x) - value_at(expected, c, y, x));
                if (!(difference <= factor * size + extra))
                    fail_msg("%s: %d -> %d channels, %d x %d, at (%d, %d, %d): off by %g, bound %g",
                             kernel, t->size.in_channels, t->size.out_channels, t->size.width,
                             t->size.height, c, y, x, difference, factor * size + extra);
                *half_pixel(&outside, c, y, x) = *half_pixel(expected, c, y, x);
            }
    assert_memory_equal(outside.memory, expected->memory, outside.floats * sizeof(float));
    block_free(&outside);
}

/* The magnitudes of a map of halves as floats: what single precision makes of them bounds rounding.
 */
static block half_magnitudes(const block *b, twin *t) {
    const ptie_map *map = &b->map;
    block m = block_make(map->channels, map->height, map->width, &t->random);
    for (int32_t c = 0; c < map->channels; c++)
        for (int32_t y = -1; y <= map->height; y++)
            for (int32_t x = -1; x <= map->width; x++)
                *block_pixel(&m, c, y, x) = (float)fabs(value_at(b, c, y, x));
    return m;
}

static void test_conv3x3(twin *t) {
    const size_t packed_count = ptie_conv3x3_packed(t->size.out_channels, t->size.in_channels);
    float weights[48 * 48 * 9], bias[48];
    for (int32_t i = 0; i < t->size.out_channels * t->size.in_channels * 9; i++)
        weights[i] = number(t, -1, 1);
    for (int32_t o = 0; o < t->size.out_channels; o++)
        bias[o] = ptie_half_to(ptie_half_from(number(t, -1, 1)));
    block in = half_block(t, t->size.in_channels, t->size.height, t->size.width, 0, 2);
    block found = half_block(t, t->size.out_channels, t->size.height, t->size.width, 0, 2),
          expected = block_copy(&found);
    float *packed = malloc(packed_count * sizeof *packed),
          *sizes = malloc(packed_count * sizeof *sizes);
    ptie_conv3x3_pack(packed, weights, t->size.out_channels, t->size.in_channels, NULL);
    for (size_t i = 0; i < packed_count; i++)
        sizes[i] = fabsf(ptie_half_to(ptie_half_from(packed[i])));
    ptie_half_pairs(packed, packed_count);
    t->kernels->conv3x3(&found.map, &in.map, packed, bias);
    t->scalar->conv3x3(&expected.map, &in.map, packed, bias);

    block in_abs = half_magnitudes(&in, t), magnitude = half_magnitudes(&found, t);
    float bias_abs[48];
    for (int32_t o = 0; o < t->size.out_channels; o++) bias_abs[o] = fabsf(bias[o]);
    ptie_kernels_of(PTIE_CPU_SCALAR)->conv3x3(&magnitude.map, &in_abs.map, sizes, bias_abs, false);
    const double terms = 9 * t->size.in_channels + 1;
    if (t->exact) /* every partial sum is an integer of at most 48 * 18 + 1 < 2048 */
        compare(t, &found, &expected, NULL, 0, 0, "conv3x3, integers");
    else /* the twin rounds to a half once, and in single precision terms / 8192 as much */
        compare(t, &found, &expected, &magnitude, half_gamma(terms + 2), terms * 0x1p-25,
                "conv3x3");
    block_free(&in), block_free(&found), block_free(&expected), block_free(&in_abs),
        block_free(&magnitude);
    free(packed), free(sizes);
}

static void test_conv1x1(twin *t) {
    float weights[48 * 48], bias[48];
    for (int32_t i = 0; i < t->size.out_channels * t->size.in_channels; i++)
        weights[i] = number(t, -1, 1);
    for (int32_t o = 0; o < t->size.out_channels; o++) bias[o] = number(t, -1, 1);
    block in = half_block(t, t->size.in_channels, t->size.height, t->size.width, 0, 2);
    block found = block_make(t->size.out_channels, t->size.height, t->size.width, &t->random),
          expected = block_copy(&found);
    t->kernels->conv1x1(&found.map, &in.map, weights, bias);
    t->scalar->conv1x1(&expected.map, &in.map, weights, bias);
    /* Twice the rounding of terms of at most 2. */
    const double bound = 2 * gamma_n(t->size.in_channels + 1) * (2 * t->size.in_channels + 1);
    for (size_t i = 0; i < found.floats; i++)
        assert_near((double)found.memory[i], (double)expected.memory[i], bound);
    block_free(&in), block_free(&found), block_free(&expected);
}

static void test_maxpool(twin *t) {
    block in = half_block(t, t->size.out_channels, 2 * t->size.height, 2 * t->size.width, 0, 3);
    block found = half_block(t, t->size.out_channels, t->size.height, t->size.width, 0, 3),
          expected = block_copy(&found);
    t->kernels->maxpool(&found.map, &in.map);
    t->scalar->maxpool(&expected.map, &in.map);
    compare(t, &found, &expected, NULL, 0, 0, "maxpool");
    block_free(&in), block_free(&found), block_free(&expected);
}

/* Two blends of two numbers of at most 3, each of a product and a multiply-add; the twin rounds
   once. */
static void test_upsample(twin *t) {
    const int32_t first = t->size.width % (2 * t->size.height);
    block in = half_block(t, t->size.out_channels, t->size.height, t->size.width, 0, 3);
    block found = half_block(t, t->size.out_channels, 2 * t->size.height - first, 2 * t->size.width,
                             0, 3),
          expected = block_copy(&found);
    t->kernels->upsample(&found.map, &in.map, first);
    t->scalar->upsample(&expected.map, &in.map, first);
    compare(t, &found, &expected, NULL, 0, 3 * half_gamma(5), "upsample");
    block_free(&in), block_free(&found), block_free(&expected);
}

/* Of all magnitudes, subnormal to too large. */
static void test_narrow(twin *t) {
    float in[WIDEST];
    ptie_half found[WIDEST + 1], expected[WIDEST + 1] = {0};
    for (int i = 0; i < t->size.width; i++)
        in[i] = ldexpf((float)ptie_random_uniform(&t->random, -1, 1), i % 44 - 26);
    expected[t->size.width] = found[t->size.width] = 1234;
    t->kernels->narrow(found, in, t->size.width);
    t->scalar->narrow(expected, in, t->size.width);
    assert_memory_equal(found, expected, (size_t)(t->size.width + 1) * sizeof *found);
}

static void run_cases(void (*test)(twin *)) {
    twin t = {.kernels = ptie_half_kernels_of(ptie_cpu_detect()),
              .scalar = &ptie_half_kernels_scalar};
    if (!t.kernels) skip();
    ptie_random_init(&t.random, 12, PTIE_STREAM_WEIGHTS, 0);
    for (int exact = 0; exact < 2; exact++) {
        t.exact = exact;
        for (int32_t i = 0; i < WIDEST + CHANNEL_COUNTS * CHANNEL_COUNTS; i++) {
            t.size = block_case(i, WIDEST, channel_counts, CHANNEL_COUNTS);
            test(&t);
        }
    }
}

#define PTIE_KERNEL(name, parameters)                                                              \
    static void name##_equals_its_twin(void **state) {                                             \
        (void)state;                                                                               \
        run_cases(test_##name);                                                                    \
    }
#include "kernel/half_kernels.inc"
#undef PTIE_KERNEL

/* A half is (1 + fraction / 1024) 2^(exponent - 15) or fraction 2^-24, IEEE 754-2019, 3.4. */
static void every_half_is_what_the_standard_says(void **state) {
    (void)state;
    for (int32_t bits = 0; bits <= LARGEST; bits++) {
        const int32_t exponent = bits >> 10, fraction = bits & 1023;
        const double expected =
            exponent ? ldexp(1 + fraction / 1024.0, exponent - 15) : ldexp(fraction, -24);
        const double value = (double)ptie_half_to((ptie_half)bits);
        assert_true(value == expected);
        assert_true((double)ptie_half_to((ptie_half)(bits | 0x8000)) == -expected);
        assert_int_equal(ptie_half_from((float)value), bits);
        assert_int_equal(ptie_half_from((float)-value), bits | 0x8000);
    }
}

/* To the nearest, halfway to the even one, and never beyond the largest. */
static void floats_are_rounded_to_the_nearest_half(void **state) {
    (void)state;
    for (int32_t bits = 0; bits < LARGEST; bits++) {
        const float low = ptie_half_to((ptie_half)bits), high = ptie_half_to((ptie_half)(bits + 1));
        const float middle = (low + high) / 2; /* exact: one bit more */
        assert_int_equal(ptie_half_from(middle), bits + bits % 2);
        assert_int_equal(ptie_half_from(nextafterf(middle, 0)), bits);
        assert_int_equal(ptie_half_from(nextafterf(middle, 1e6f)), bits + 1);
    }
    assert_int_equal(ptie_half_from(1e30f), LARGEST);
    assert_int_equal(ptie_half_from(-65530), LARGEST | 0x8000);
}

/* Sums of either sign that a half cannot hold: the largest half, and nothing. */
static void sums_beyond_the_largest_half_stay_there(void **state) {
    (void)state;
    const ptie_half_kernels *tables[] = {&ptie_half_kernels_scalar,
                                         ptie_half_kernels_of(ptie_cpu_detect())};
    twin t = {.size.width = 70};
    ptie_random_init(&t.random, 13, PTIE_STREAM_WEIGHTS, 0);
    for (int i = 0; i < 2; i++) {
        block in = half_block(&t, 2, 1, 70, 60000, 65000), out = half_block(&t, 2, 1, 70, 0, 1);
        float weights[2 * 2 * 9], packed[8 * 2 * 9], bias[2] = {0};
        for (int k = 0; k < 36; k++) weights[k] = k < 18 ? 9 : -9;
        ptie_conv3x3_pack(packed, weights, 2, 2, NULL);
        ptie_half_pairs(packed, 8 * 2 * 9);
        if (tables[i]) tables[i]->conv3x3(&out.map, &in.map, packed, bias);
        for (int32_t x = 0; tables[i] && x < 70; x++) {
            assert_int_equal(*half_pixel(&out, 0, 0, x), LARGEST);
            assert_int_equal(*half_pixel(&out, 1, 0, x), 0);
        }
        block_free(&in), block_free(&out);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_half_is_what_the_standard_says),
        cmocka_unit_test(floats_are_rounded_to_the_nearest_half),
#define PTIE_KERNEL(name, parameters) cmocka_unit_test(name##_equals_its_twin),
#include "kernel/half_kernels.inc"
#undef PTIE_KERNEL
        cmocka_unit_test(sums_beyond_the_largest_half_stay_there),
    };
    return cmocka_run_group_tests_name("half", tests, NULL, NULL);
}
