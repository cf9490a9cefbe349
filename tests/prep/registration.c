/* SPDX-License-Identifier: BSD-3-Clause */
/* Registration estimated: planes of blobs whose places are known exactly, under all that tells
 * planes apart. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include <ptie/preprocess.h>

#include "base/random.h"

enum { BLOBS = 1500 };

typedef struct blob {
    double x, y, sigma, height; /* from the centre of the frame, pixels */
} blob;

static blob blobs[BLOBS];

static void scatter(double extent) {
    ptie_random random;
    ptie_random_init(&random, 5, PTIE_STREAM_TEXTURE, 0);
    for (int i = 0; i < BLOBS; i++) {
        blobs[i].x = ptie_random_uniform(&random, -extent, extent);
        blobs[i].y = ptie_random_uniform(&random, -extent, extent);
        blobs[i].sigma = ptie_random_uniform(&random, 1.2, 4);
        blobs[i].height = ptie_random_uniform(&random, -0.15, 0.15);
    }
}

static void add_blob(float *image, int32_t width, int32_t height, blob b) {
    const double x = b.x + (width - 1) / 2.0, y = b.y + (height - 1) / 2.0, reach = 6 * b.sigma;
    for (int32_t v = (int32_t)fmax(0, ceil(y - reach)); v < height && v <= y + reach; v++)
        for (int32_t u = (int32_t)fmax(0, ceil(x - reach)); u < width && u <= x + reach; u++)
            image[v * width + u] +=
                (float)(b.height *
                        exp(-((u - x) * (u - x) + (v - y) * (v - y)) / (2 * b.sigma * b.sigma)));
}

/* The blobs as a plane at `place` shows them: 1 plus texture. */
static void show(float *image, int32_t width, int32_t height, ptie_similarity place) {
    const double c = place.magnification * cos(place.rotation_rad),
                 s = place.magnification * sin(place.rotation_rad);
    for (int i = 0; i < width * height; i++) image[i] = 1;
    for (int i = 0; i < BLOBS; i++) {
        const blob b = blobs[i];
        add_blob(image, width, height,
                 (blob){place.shift_x_px + c * b.x - s * b.y, place.shift_y_px + s * b.x + c * b.y,
                        b.sigma * place.magnification, b.height});
    }
}

static void add_noise(float *image, int32_t pixels, double sigma, uint64_t which) {
    ptie_random random;
    ptie_random_init(&random, 6, PTIE_STREAM_SENSOR, which);
    float *noise = malloc((size_t)pixels * sizeof *noise);
    assert_non_null(noise);
    ptie_random_normals(&random, noise, (size_t)pixels);
    for (int32_t i = 0; i < pixels; i++) image[i] += (float)sigma * noise[i];
    free(noise);
}

/* A gain, and light that is brighter at one side. */
static void light(float *image, int32_t width, int32_t height, double gain, double tilt) {
    for (int32_t i = 0; i < width * height; i++)
        image[i] *= (float)(gain * (1 + tilt * ((double)(i % width) / width - 0.5)));
}

static const ptie_similarity in_place = {.magnification = 1};

/* Each number within four of its deviations; and those small. */
static void check(const ptie_registration *found, ptie_similarity place, double shift_px) {
    const ptie_similarity *p = &found->place, *d = &found->deviation;
    assert_near(p->shift_x_px, place.shift_x_px, 4 * d->shift_x_px);
    assert_near(p->shift_y_px, place.shift_y_px, 4 * d->shift_y_px);
    assert_near(p->magnification, place.magnification, 4 * d->magnification);
    assert_near(p->rotation_rad, place.rotation_rad, 4 * d->rotation_rad);
    assert_true(d->shift_x_px < shift_px && d->shift_y_px < shift_px);
}

/* Texture of 4 % rms, 1 % of noise in each plane, other gains, other light.  Measured deviations
   0.0073 to 0.0094 px, errors up to 0.0067 px. */
static void small_motions_are_found_through_noise(void **state) {
    (void)state;
    enum { N = 256 };
    static const ptie_similarity places[] = {{0, 0, 1, 0},
                                             {0.5, -0.25, 1, 0},
                                             {3.37, -5.81, 1.004, -0.006},
                                             {-0.73, 0.11, 0.997, 0.002}};
    static float fixed[N * N], moving[N * N];
    scatter(N * 0.7);
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        ptie_registration found;
        show(fixed, N, N, in_place);
        show(moving, N, N, places[i]);
        light(fixed, N, N, 900, -0.2);
        light(moving, N, N, 0.7, 0.3);
        add_noise(fixed, N * N, 9, 2 * i);
        add_noise(moving, N * N, 0.007, 2 * i + 1);
        assert_ok(ptie_register(&found, fixed, moving, NULL, N, N));
        check(&found, places[i], 0.012);
        assert_true(found.correlation > 0.9);
    }
}

static void large_motions_are_found(void **state) {
    (void)state;
    enum { W = 400, H = 300 };
    static const ptie_similarity places[] = {{60, -40, 1, 0},       {-20, 15, 1.08, 0.1},
                                             {10, 30, 0.93, -0.14}, {0, 0, 1.1, 0.157},
                                             {0, 0, 0.9, -0.157},   {-5, 8, 0.9, 0.05}};
    static float fixed[W * H], moving[W * H];
    scatter(W * 0.7);
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        ptie_registration found;
        show(fixed, W, H, in_place);
        show(moving, W, H, places[i]);
        add_noise(fixed, W * H, 0.01, 2 * i);
        add_noise(moving, W * H, 0.01, 2 * i + 1);
        assert_ok(ptie_register(&found, fixed, moving, NULL, W, H));
        check(&found, places[i], 0.012);
    }
}

/* Over noise, the errors scatter as the deviations say: 12 draws of 4 numbers, whose mean square in
   units of the deviation has a standard deviation of sqrt(2 / 48) = 0.2.  Measured 0.90. */
static void deviations_are_honest(void **state) {
    (void)state;
    enum { N = 160, DRAWS = 12 };
    static const ptie_similarity place = {1.3, -0.4, 1.003, 0.004};
    static float fixed[N * N], moving[N * N];
    scatter(N * 0.7);
    double squares = 0;
    for (uint64_t i = 0; i < DRAWS; i++) {
        ptie_registration found;
        show(fixed, N, N, in_place);
        show(moving, N, N, place);
        add_noise(fixed, N * N, 0.03, 2 * i);
        add_noise(moving, N * N, 0.03, 2 * i + 1);
        assert_ok(ptie_register(&found, fixed, moving, NULL, N, N));
        const ptie_similarity *p = &found.place, *d = &found.deviation;
        squares += pow((p->shift_x_px - place.shift_x_px) / d->shift_x_px, 2) +
                   pow((p->shift_y_px - place.shift_y_px) / d->shift_y_px, 2) +
                   pow((p->magnification - place.magnification) / d->magnification, 2) +
                   pow((p->rotation_rad - place.rotation_rad) / d->rotation_rad, 2);
    }
    assert_near(squares / (4 * DRAWS), 1, 0.6);
}

/* Defocus blurs the texture, or turns dark into bright. */
static void planes_may_differ_in_focus(void **state) {
    (void)state;
    enum { N = 200 };
    static const ptie_similarity place = {-2.6, 4.2, 0.992, -0.01};
    static float fixed[N * N], moving[N * N];
    for (int inverted = 0; inverted < 2; inverted++) {
        ptie_registration found;
        scatter(N * 0.7);
        show(fixed, N, N, in_place);
        for (int i = 0; i < BLOBS; i++) {
            blobs[i].height *= inverted ? -0.7 : 0.7;
            blobs[i].sigma *= 1.3;
        }
        show(moving, N, N, place);
        add_noise(fixed, N * N, 0.01, 40);
        add_noise(moving, N * N, 0.01, 41);
        assert_ok(ptie_register(&found, fixed, moving, NULL, N, N));
        check(&found, place, 0.03);
        assert_true((found.correlation < 0) == inverted);
    }
}

/* A nozzle that does not move with the field of view is left out by the mask. */
static void masked_pixels_do_not_count(void **state) {
    (void)state;
    enum { N = 200 };
    static const ptie_similarity place = {2.25, -1.5, 1, 0.003};
    static float fixed[N * N], moving[N * N];
    static uint8_t mask[N * N];
    ptie_registration found;
    scatter(N * 0.7);
    show(fixed, N, N, in_place);
    show(moving, N, N, place);
    for (int i = 0; i < N * N; i++) {
        const int x = i % N, y = i / N;
        if (abs(x - 60) < 20 && y > 120) fixed[i] = moving[i] = 0;
        mask[i] = !(abs(x - 60) < 40 && y > 100); /* and what the filter smears of it */
    }
    add_noise(fixed, N * N, 0.01, 50);
    add_noise(moving, N * N, 0.01, 51);
    assert_ok(ptie_register(&found, fixed, moving, mask, N, N));
    check(&found, place, 0.02);
}

static void planes_without_anything_in_common_are_refused(void **state) {
    (void)state;
    enum { N = 96 };
    static float fixed[N * N], moving[N * N];
    ptie_registration found;
    for (int i = 0; i < N * N; i++) fixed[i] = moving[i] = 5;
    assert_fails(ptie_register(&found, fixed, moving, NULL, N, N), PTIE_ENUMERIC,
                 "no texture to compare");
    add_noise(fixed, N * N, 1, 60);
    add_noise(moving, N * N, 1, 61);
    assert_fails(ptie_register(&found, fixed, moving, NULL, N, N), PTIE_ENUMERIC, "registration: ");
    fixed[N + 3] = NAN;
    assert_fails(ptie_register(&found, fixed, moving, NULL, N, N), PTIE_ENUMERIC,
                 "fixed: value is not finite (at x=3, y=1");
    assert_fails(ptie_register(&found, fixed, moving, NULL, 63, N), PTIE_EINVAL,
                 "width_px is out of range");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_motions_are_found_through_noise),
        cmocka_unit_test(large_motions_are_found),
        cmocka_unit_test(deviations_are_honest),
        cmocka_unit_test(planes_may_differ_in_focus),
        cmocka_unit_test(masked_pixels_do_not_count),
        cmocka_unit_test(planes_without_anything_in_common_are_refused),
    };
    return cmocka_run_group_tests_name("registration", tests, NULL, NULL);
}
