/* SPDX-License-Identifier: BSD-3-Clause */
/* Opaque regions found and filled. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include <ptie/preprocess.h>

#include "base/random.h"

enum { W = 120, H = 93, PIXELS = W * H };

/* A nozzle from the left edge. */
static bool in_nozzle(int x, int y, int margin) {
    return x < 30 + margin && abs(y - 46) < 12 + margin;
}

static void a_nozzle_is_found_and_specks_are_not(void **state) {
    (void)state;
    static float reference[PIXELS];
    static uint8_t mask[PIXELS];
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % W, y = i / W;
        reference[i] = in_nozzle(x, y, 0) ? 15 : (float)(500 + 2 * x);
        if (x == 15 && y == 46) reference[i] = 600;                  /* a glint on the nozzle */
        if (abs(x - 80) <= 1 && abs(y - 20) <= 1) reference[i] = 20; /* dust */
    }
    for (int margin = 0; margin <= 5; margin += 5) {
        assert_ok(ptie_opaque_mask(mask, reference, W, H, 0.3, 2, margin));
        for (int i = 0; i < PIXELS; i++)
            assert_int_equal(mask[i], !in_nozzle(i % W, i / W, margin));
    }
    assert_ok(ptie_opaque_mask(mask, reference, W, H, 0.3, 0, 0)); /* as the threshold says */
    for (int i = 0; i < PIXELS; i++) assert_int_equal(mask[i], reference[i] > 100);
    reference[3] = INFINITY;
    assert_fails(ptie_opaque_mask(mask, reference, W, H, 0.3, 0, 0), PTIE_ENUMERIC,
                 "reference: value is not finite");
}

static void fill(float *image, const uint8_t *mask, int32_t width, int32_t height) {
    void *scratch = ptie_scratch_alloc(ptie_fill_scratch_bytes(width, height));
    ptie_fill_masked(image, mask, width, height, scratch);
    ptie_scratch_free(scratch);
}

static void what_is_filled_continues_its_surroundings(void **state) {
    (void)state;
    static float image[PIXELS], before[PIXELS];
    static uint8_t mask[PIXELS];
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % W, y = i / W;
        mask[i] = !in_nozzle(x, y, 0);
        before[i] = (float)(100 + 0.2 * x - 0.1 * y);
        image[i] = mask[i] ? before[i] : -1e9f;
    }
    fill(image, mask, W, H);
    for (int i = 0; i < PIXELS; i++)
        if (mask[i])
            assert_true(image[i] == before[i]);
        else /* means of neighbours: within the range at the nozzle's rim, 96.6 to 106.5 */
            assert_true(image[i] > 94 && image[i] < 107);
    /* At the rim the fill follows within what the surface changes over three pixels. */
    for (int x = 0; x < 30; x++)
        assert_near((double)image[35 * W + x], (double)before[34 * W + x], 0.9);
}

static void constants_are_filled_by_themselves_at_any_size(void **state) {
    (void)state;
    static const int32_t sizes[][2] = {{1, 1},   {2, 1},   {1, 7},   {5, 3},
                                       {16, 16}, {33, 17}, {120, 93}};
    ptie_random random;
    ptie_random_init(&random, 12, PTIE_STREAM_TEXTURE, 0);
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        static float image[PIXELS];
        static uint8_t mask[PIXELS];
        const int32_t pixels = sizes[s][0] * sizes[s][1];
        for (int32_t i = 0; i < pixels; i++) {
            mask[i] = i == pixels - 1 || ptie_random_uniform(&random, 0, 1) < 0.05;
            image[i] = mask[i] ? 7 : NAN;
        }
        fill(image, mask, sizes[s][0], sizes[s][1]);
        for (int32_t i = 0; i < pixels; i++)
            assert_near((double)image[i], 7, 1e-5); /* 7 levels of roundings */
        memset(mask, 0, sizeof mask);
        fill(image, mask, sizes[s][0], sizes[s][1]);
        for (int32_t i = 0; i < pixels; i++) assert_true(image[i] == 0 || pixels == 1);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_nozzle_is_found_and_specks_are_not),
        cmocka_unit_test(what_is_filled_continues_its_surroundings),
        cmocka_unit_test(constants_are_filled_by_themselves_at_any_size),
    };
    return cmocka_run_group_tests_name("mask", tests, NULL, NULL);
}
