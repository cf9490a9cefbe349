/* SPDX-License-Identifier: BSD-3-Clause */
/* What a recording is asked before it is trusted; and the real ones. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include <ptie/preprocess.h>
#include <ptie/recording.h>

#include "base/random.h"

/* The numbers of the paper's set-up: 532 nm, 10 mm. */
static void chi_tells_where_linear_tie_ends(void **state) {
    (void)state;
    assert_near(ptie_chi(532e-9, 10e-3, 129e-6), 1, 0.005);
    assert_near(ptie_chi(532e-9, -10e-3, 2 * 20e-6), 10.44, 0.01);
    assert_near(ptie_chi(532e-9, 10e-3, 2 * 40e-6), 2.61, 0.01);
}

static void crossed_polarisers_share_the_light(void **state) {
    (void)state;
    enum { W = 41, H = 31 };
    static float image[W * H];
    for (int32_t i = 0; i < W * H;
         i++) { /* partly polarised at an angle that changes from cell to cell */
        const int x = i % W, y = i / W;
        const double light = 100 + x / 2, angle = 0.3 * (x / 2) + 0.2 * (y / 2);
        static const double polariser[] = {90, 45, 135, 0};
        const double turn =
            2 * (angle - polariser[y % 2 * 2 + x % 2] * 3.14159265358979323846 / 180);
        image[i] = (float)(light / 2 * (1 + 0.8 * cos(turn)));
    }
    assert_near(ptie_mosaic_imbalance(image, W, H), 0, 1e-6); /* rounding of floats */
    for (int32_t i = 0; i < W * H; i++) image[i] = i % W % 2 == i / W % 2 ? 3 : 1; /* no mosaic */
    assert_near(ptie_mosaic_imbalance(image, W, H), 0.5, 0);
}

static void planes_are_compared_over_the_light(void **state) {
    (void)state;
    const float a[] = {1, 3, 1000}, b[] = {2, 2.2f, -5}, c[] = {2, 1.8f, 0};
    const float *const planes[] = {a, b, c};
    assert_near(ptie_plane_spread(planes, 3, (const uint8_t[]){1, 1, 0}, 3), 0.1,
                1e-7); /* means 2, 2.1, 1.9 */
    assert_near(ptie_plane_spread(planes, 1, NULL, 3), 0, 0);
}

static void saturated_pixels_are_counted(void **state) {
    (void)state;
    float image[100];
    for (int i = 0; i < 100; i++) image[i] = (float)i;
    assert_int_equal(ptie_count_saturated(image, 100, 90), 10);
    assert_int_equal(ptie_count_saturated(image, 100, 99.5), 0);
}

static void a_trend_is_told_from_noise(void **state) {
    (void)state;
    enum { N = 400 };
    double values[N];
    float noise[N];
    ptie_random random;
    ptie_random_init(&random, 13, PTIE_STREAM_TEXTURE, 0);
    ptie_random_normals(&random, noise, N);
    for (int i = 0; i < N; i++) values[i] = 4 - 0.01 * i + 0.5 * (double)noise[i];
    const ptie_trend trend = ptie_trend_of(values, N);
    const double deviation =
        0.5 / sqrt(N * (N * N - 1.0) / 12); /* closed form, 400 residuals know it to 4 % */
    assert_near(trend.deviation, deviation, 0.15 * deviation);
    assert_near(trend.slope, -0.01, 4 * deviation);
    assert_near(trend.rms, 0.5, 0.08);
    const ptie_trend line = ptie_trend_of((const double[]){1, 3, 5}, 3);
    assert_near(line.slope, 2, 1e-15);
    assert_near(line.rms, 0, 1e-15);
    assert_true(isnan(ptie_trend_of(values, 1).slope) && isnan(ptie_trend_of(values, 2).deviation));
}

/* First frame of a real recording, or NULL. */
static float *load(const char *name, int32_t *width, int32_t *height) {
    const char *path = support_data(name);
    if (!path) return NULL;
    ptie_recording *recording;
    assert_ok(ptie_recording_open(&recording, path));
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    *width = info->width_px, *height = info->height_px;
    float *image = malloc((size_t)*width * (size_t)*height * sizeof *image);
    assert_non_null(image);
    assert_ok(ptie_recording_read(recording, 0, image));
    ptie_recording_close(recording);
    return image;
}

static void a_real_mosaic_passes(void **state) {
    (void)state;
    int32_t width, height;
    float *image = load("polarisation/polarizer_IMX250MZR.png", &width, &height);
    if (!image) skip();
    assert_near(ptie_mosaic_imbalance(image, width, height), 0.013813, 1e-6); /* by NumPy */
    free(image);
}

/* A pair of a setup that did not move: in place within what a change of focus does to lenses 60 px
 * wide. */
static void the_microlens_stays_in_place(void **state) {
    (void)state;
    int32_t width, height;
    float *fixed = load("microlens/I0.tiff", &width, &height),
          *moving = load("microlens/Iz.tiff", &width, &height);
    if (!fixed || !moving) skip();
    ptie_registration found;
    assert_ok(ptie_register(&found, fixed, moving, NULL, width, height));
    assert_near(found.place.shift_x_px, 0, 0.5);     /* found -0.30 +- 0.03 */
    assert_near(found.place.shift_y_px, 0, 0.5);     /* -0.16 +- 0.03 */
    assert_near(found.place.magnification, 1, 3e-3); /* -0.0016 +- 0.00006 */
    assert_near(found.place.rotation_rad, 0, 3e-4);  /* 0.00009 +- 0.00007 */
    assert_true(found.correlation > 0.8);
    free(fixed);
    free(moving);
}

/* Schlieren everywhere: a frame with flow is no reference, and is not taken for one. */
static void a_flow_is_no_reference(void **state) {
    (void)state;
    int32_t width, height;
    float *still = load("plume/noflow.png", &width, &height),
          *flow = load("plume/flow_00.png", &width, &height);
    if (!still || !flow) skip();
    ptie_registration found;
    assert_fails(ptie_register(&found, still, flow, NULL, width, height), PTIE_ENUMERIC,
                 "registration: ");
    free(still);
    free(flow);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chi_tells_where_linear_tie_ends),
        cmocka_unit_test(crossed_polarisers_share_the_light),
        cmocka_unit_test(planes_are_compared_over_the_light),
        cmocka_unit_test(saturated_pixels_are_counted),
        cmocka_unit_test(a_trend_is_told_from_noise),
        cmocka_unit_test(a_real_mosaic_passes),
        cmocka_unit_test(the_microlens_stays_in_place),
        cmocka_unit_test(a_flow_is_no_reference),
    };
    return cmocka_run_group_tests_name("check", tests, NULL, NULL);
}
