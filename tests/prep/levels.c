/* SPDX-License-Identifier: BSD-3-Clause */
/* Dark, mixing, flat field and gain against their definitions. */
#include "support/support.h"

#include <math.h>

#include <ptie/preprocess.h>

#include "base/random.h"

enum { W = 67, H = 41, PIXELS = W * H }; /* no multiple of a vector */

static void fill(float *image, double mean, double sigma, uint64_t which) {
    ptie_random random;
    ptie_random_init(&random, 11, PTIE_STREAM_TEXTURE, which);
    ptie_random_normals(&random, image, PIXELS);
    for (int i = 0; i < PIXELS; i++) image[i] = (float)(mean + sigma * (double)image[i]);
}

/* I = dark + leaking polarisers * uneven light * flow; undone step by step. */
static void the_chain_undoes_the_sensor(void **state) {
    (void)state;
    static float flow[PIXELS], light[PIXELS], dark[PIXELS], gain[PIXELS], a[PIXELS], b[PIXELS];
    fill(flow, 1, 0.05, 0);
    fill(dark, 20, 2, 1);
    for (int i = 0; i < PIXELS; i++) {
        const float shape = (float)(800 + 300 * cos(0.05 * (i % W)) * cos(0.04 * (i / W)));
        light[i] = shape;
        a[i] = dark[i] + 0.9f * shape * flow[i] +
               0.1f * shape; /* a share of channel b, which has no flow */
        b[i] = dark[i] + shape;
    }
    ptie_subtract_dark(a, dark, PIXELS);
    ptie_subtract_dark(b, dark, PIXELS);
    const float *const channels[] = {a, NULL, b};
    ptie_mix_channels(a, channels, (const double[]){1 / 0.9, 0, -0.1 / 0.9}, 3, PIXELS);
    assert_ok(ptie_flat_gain(gain, light, NULL, W, H, 0.01));
    ptie_apply_gain(a, gain, PIXELS);
    const double mean = ptie_masked_mean(a, NULL, PIXELS);
    ptie_scale_image(a, ptie_masked_mean(flow, NULL, PIXELS) / mean, PIXELS);
    /* Rounding of 1100 + 20, five operations of 6e-8 each. */
    for (int i = 0; i < PIXELS; i++) assert_near((double)a[i], (double)flow[i], 1e-6);
    assert_near(mean, ptie_masked_mean(light, NULL, PIXELS),
                2); /* the level: 5 % / sqrt(2747) of 1000 */
}

static void the_mean_is_over_the_light(void **state) {
    (void)state;
    static float image[PIXELS];
    static uint8_t mask[PIXELS];
    double sum = 0;
    int count = 0;
    fill(image, 3, 1, 2);
    for (int i = 0; i < PIXELS; i++) {
        mask[i] = i % 7 != 0;
        if (mask[i]) sum += (double)image[i], count++;
    }
    assert_near(ptie_masked_mean(image, mask, PIXELS), sum / count,
                1e-13); /* 2747 roundings of doubles */
    memset(mask, 0, sizeof mask);
    assert_true(isnan(ptie_masked_mean(image, mask, PIXELS)));
}

/* A nozzle that lets no light through: its gain is bounded, and it does not count for the level. */
static void opaque_references_do_not_divide_by_nothing(void **state) {
    (void)state;
    static float reference[PIXELS], gain[PIXELS];
    static uint8_t mask[PIXELS];
    for (int i = 0; i < PIXELS; i++) {
        mask[i] = i % W >= 10;
        reference[i] = mask[i] ? 200 : i % 2 ? 0 : -3;
    }
    assert_ok(ptie_flat_gain(gain, reference, mask, W, H, 0.1));
    for (int i = 0; i < PIXELS; i++) assert_near((double)gain[i], mask[i] ? 1 : 10, 1e-6);
}

static void references_without_light_are_refused(void **state) {
    (void)state;
    float image[12] = {0}, gain[12];
    assert_fails(ptie_flat_gain(gain, image, NULL, 4, 3, 0.1), PTIE_ENUMERIC,
                 "mean intensity is not positive");
    image[6] = NAN;
    assert_fails(ptie_flat_gain(gain, image, NULL, 4, 3, 0.1), PTIE_ENUMERIC,
                 "reference: value is not finite (at x=2, y=1");
    assert_fails(ptie_flat_gain(gain, image, NULL, 4, 3, 0), PTIE_EINVAL, "floor is out of range");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_chain_undoes_the_sensor),
        cmocka_unit_test(the_mean_is_over_the_light),
        cmocka_unit_test(opaque_references_do_not_divide_by_nothing),
        cmocka_unit_test(references_without_light_are_refused),
    };
    return cmocka_run_group_tests_name("levels", tests, NULL, NULL);
}
