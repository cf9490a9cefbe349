/* SPDX-License-Identifier: BSD-3-Clause */
/* Registration applied: SciPy's splines, polynomials, waves. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include <ptie/preprocess.h>

#define PI 3.14159265358979323846

static void resample(float *out, uint8_t *inside, const float *image, int32_t width, int32_t height,
                     ptie_similarity where) {
    ptie_resampler *resampler;
    assert_ok(ptie_resampler_create(&resampler, width, height, where));
    void *scratch = ptie_scratch_alloc(ptie_resampler_scratch_bytes(resampler));
    assert_ok(ptie_resampler_run(resampler, out, image, scratch));
    if (inside) ptie_resampler_inside(resampler, inside, 0);
    ptie_scratch_free(scratch);
    ptie_resampler_free(resampler);
}

static void scipy_gives_the_same_images(void **state) {
    (void)state;
    enum { W = 29, H = 22 };
    float image[W * H], found[W * H];
    for (int64_t i = 0; i < W * H; i++) {
        const int64_t x = i % W, y = i / W;
        image[i] = (float)((x * x + 3 * y * y + x * y) % 97) / 97;
    }
    FILE *file = fopen(support_source("tests/golden/prep.txt"), "r");
    assert_non_null(file);
    char line[256];
    assert_non_null(fgets(line, sizeof line, file));
    ptie_similarity t;
    int transforms = 0;
    while (fscanf(file, "%lf %lf %lf %lf", &t.shift_x_px, &t.shift_y_px, &t.magnification,
                  &t.rotation_rad) == 4) {
        resample(found, NULL, image, W, H, t);
        for (int i = 0; i < W * H; i++) {
            double expected;
            assert_int_equal(fscanf(file, "%lf", &expected), 1);
            /* Fractions to 1e-6 of a pixel, slopes up to 2 per pixel, 20 roundings of 6e-8;
             * measured 2.7e-7. */
            assert_near((double)found[i], expected, 1.5e-6);
        }
        transforms++;
    }
    assert_int_equal(transforms, 4);
    fclose(file);
}

/* Cubic splines reproduce cubics, but for the mirrored edges: 20 pixels in, 0.27^20 of them are
 * left. */
static void cubics_stay_cubics(void **state) {
    (void)state;
    enum { N = 96 };
    static float image[N * N], found[N * N];
    const ptie_similarity t = {1.37, -2.61, 1.013, 0.021};
    for (int i = 0; i < N * N; i++) {
        const double x = (i % N - (N - 1) / 2.0) / N, y = (i / N - (N - 1) / 2.0) / N;
        image[i] =
            (float)(1 + x - 2 * y + x * x - 3 * x * y + 4 * x * x * x - 2 * x * x * y + y * y * y);
    }
    resample(found, NULL, image, N, N, t);
    for (int i = 0; i < N * N; i++) {
        const double u = i % N - (N - 1) / 2.0, v = i / N - (N - 1) / 2.0;
        if (fabs(u) > N / 2 - 24 || fabs(v) > N / 2 - 24) continue;
        const double c = t.magnification * cos(t.rotation_rad),
                     s = t.magnification * sin(t.rotation_rad);
        const double x = (t.shift_x_px + c * u - s * v) / N, y = (t.shift_y_px + s * u + c * v) / N;
        const double expected =
            1 + x - 2 * y + x * x - 3 * x * y + 4 * x * x * x - 2 * x * x * y + y * y * y;
        assert_near((double)found[i], expected,
                    1.5e-6); /* 20 roundings of values below 2; measured 5.1e-7 */
    }
}

static void staying_in_place_changes_nothing(void **state) {
    (void)state;
    enum { W = 50, H = 4 };
    float image[W * H], found[W * H];
    uint8_t inside[W * H];
    for (int i = 0; i < W * H; i++) image[i] = (float)(i * 7919 % 101) / 101;
    resample(found, inside, image, W, H, (ptie_similarity){.magnification = 1});
    for (int i = 0; i < W * H; i++) {
        assert_near((double)found[i], (double)image[i], 1e-6);
        assert_true(inside[i]);
    }
    memcpy(found, image, sizeof found); /* in place */
    resample(found, NULL, found, W, H, (ptie_similarity){.shift_x_px = 1, .magnification = 1});
    for (int i = 0; i < W * H; i++)
        assert_near((double)found[i], (double)image[i % W < W - 1 ? i + 1 : i], 1e-6);
}

/* The accuracy that the header states, over all fractions; exact waves, away from the edges. */
static void waves_keep_their_amplitude(void **state) {
    (void)state;
    enum { W = 160, H = 4 };
    static const struct { double period, error; } cases[] = {{16, 0.0001}, {8, 0.0012}, {4, 0.028}};
    float image[W * H], found[W * H];
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        double worst = 0;
        for (int step = 0; step <= 8; step++) {
            const double k = 2 * PI / cases[c].period;
            for (int i = 0; i < W * H; i++) image[i] = (float)cos(k * (i % W) + 0.4);
            resample(found, NULL, image, W, H,
                     (ptie_similarity){.shift_x_px = step / 8.0, .magnification = 1});
            for (int x = 24; x < W - 24; x++)
                worst = fmax(worst, fabs((double)found[x] - cos(k * (x + step / 8.0) + 0.4)));
        }
        assert_true(worst <= cases[c].error);
        assert_true(worst > cases[c].error / 2); /* the statement is not idle */
    }
}

static void what_was_mirrored_is_marked(void **state) {
    (void)state;
    enum { W = 20, H = 12 };
    float image[W * H], found[W * H];
    uint8_t inside[W * H];
    for (int i = 0; i < W * H; i++) image[i] = (float)(i % W);
    resample(found, inside, image, W, H, (ptie_similarity){.shift_x_px = 3, .magnification = 1});
    for (int i = 0; i < W * H; i++) {
        assert_int_equal(inside[i], i % W < W - 3);
        const int x = i % W + 3;
        assert_near((double)found[i], x < W ? x : 2 * W - 1 - x, 5e-6);
    }
}

static void planes_must_overlap(void **state) {
    (void)state;
    ptie_resampler *resampler;
    assert_fails(ptie_resampler_create(&resampler, 64, 32,
                                       (ptie_similarity){.shift_y_px = 31, .magnification = 1}),
                 PTIE_EINVAL, "plane leaves the frame");
    assert_fails(ptie_resampler_create(&resampler, 64, 32, (ptie_similarity){0}), PTIE_EINVAL,
                 "magnification is out of range");
    assert_null(resampler);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scipy_gives_the_same_images),
        cmocka_unit_test(cubics_stay_cubics),
        cmocka_unit_test(staying_in_place_changes_nothing),
        cmocka_unit_test(waves_keep_their_amplitude),
        cmocka_unit_test(what_was_mirrored_is_marked),
        cmocka_unit_test(planes_must_overlap),
    };
    return cmocka_run_group_tests_name("resample", tests, NULL, NULL);
}
