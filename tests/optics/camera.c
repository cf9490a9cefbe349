/* SPDX-License-Identifier: BSD-3-Clause */
/* The camera against closed forms and against the statistics of its noise. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/random.h"
#include "optics/camera.h"

#define PI 3.14159265358979323846

enum { W = 96, H = 64, PIXELS = W * H };

static ptie_camera_params defaults(void) {
    ptie_camera_params p;
    ptie_camera_params_init(&p);
    return p;
}

static ptie_camera *make(const ptie_camera_params *params) {
    ptie_camera *camera;
    assert_ok(ptie_camera_check(params, "test"));
    assert_ok(ptie_camera_plan(&camera, params, W, H, 20e-6, 5));
    return camera;
}

static float *image(void) {
    float *pixels = calloc(PIXELS, sizeof *pixels);
    assert_non_null(pixels);
    return pixels;
}

static void capture(const ptie_camera *camera, float *counts, float *other, const float *plus, const float *minus,
                    ptie_exposure exposure, int64_t frame) {
    void *scratch = ptie_alloc(ptie_camera_scratch(camera), 1);
    ptie_camera_capture(camera, (float *[]){counts, other}, plus, minus, exposure, frame, scratch);
    ptie_free(scratch);
}

/* A wave of `period` px that an object at x, y shows. */
static double wave(double x, double y, double period, double heading) {
    return 1 + 0.5 * cos(2 * PI * (x * cos(heading) + y * sin(heading)) / period + 0.3);
}

static double worst_displacement(const ptie_similarity *p, double period, double heading) {
    float *in = image(), *out = image();
    ptie_displacer *displacer;
    double worst = 0;
    for (int i = 0; i < PIXELS; i++) in[i] = (float)wave(i % W, i / W, period, heading);
    assert_ok(ptie_displacer_create(&displacer, W, H, p));
    ptie_displacer_run(displacer, out, in);
    for (int y = 8; y < H - 8; y++)
        for (int x = 8; x < W - 8; x++) {
            /* Undo shift, magnification and rotation, one after the other. */
            const double u = (x - p->shift_x_px - (W - 1) / 2.0) / p->magnification,
                         v = (y - p->shift_y_px - (H - 1) / 2.0) / p->magnification;
            const double c = cos(p->rotation_rad), s = sin(p->rotation_rad);
            const double expected = wave(c * u + s * v + (W - 1) / 2.0, c * v - s * u + (H - 1) / 2.0, period, heading);
            worst = fmax(worst, fabs((double)out[y * W + x] - expected));
        }
    ptie_displacer_free(displacer);
    free(in), free(out);
    return worst;
}

static void a_moved_plane_shows_the_object_where_it_should(void **state) {
    (void)state;
    const ptie_similarity placements[] = {
        {1.7, -2.3, 1, 0}, {0, 0, 1.012, 0}, {0, 0, 1, 0.01}, {-0.6, 1.1, 0.991, -0.008}};
    for (size_t i = 0; i < sizeof placements / sizeof *placements; i++)
        for (int k = 0; k < 8; k++) {
            /* The kernel leaves 1e-3 of the amplitude of 0.5 (twice: both axes) from periods of 4 px on; the table's
               places err by 1/1024 px, times the slope pi / period, on either axis. */
            const double heading = k * PI / 8;
            for (double period = 4; period < 40; period *= 2.1)
                assert_near(worst_displacement(&placements[i], period, heading), 0,
                            1e-3 + 1.5 * PI / period / 1024);
        }
    /* Whole pixels are copies. */
    assert_near(worst_displacement(&(ptie_similarity){3, -2, 1, 0}, 3, 0.7), 0, 3e-7);
}

static void a_cell_sees_what_malus_says(void **state) {
    (void)state;
    ptie_camera_params p = defaults();
    p.layout = PTIE_CAMERA_MOSAIC; /* Sony's, row by row: 90 45, 135 0 degrees */
    p.extinction = 50;
    p.gain[0] = 0.9, p.gain[1] = 1.1, p.gain[2] = 0.95, p.gain[3] = 1.02;
    p.minus_gain = 0.8;
    const double plus[4] = {1.0 / 50, 0.51, 0.51, 1}, minus[4] = {1, 0.51, 0.51, 1.0 / 50};
    for (int parity = 0; parity < 4; parity++) {
        p.roi_x_px = parity % 2, p.roi_y_px = parity / 2;
        ptie_camera *camera = make(&p);
        for (int i = 0; i < PIXELS; i++) {
            const int c = (i % W + parity % 2) % 2 + 2 * ((i / W + parity / 2) % 2);
            assert_near((double)camera->sensor[0].plus[i], 20e3 * p.gain[c] * plus[c], 4e-3);
            assert_near((double)camera->sensor[0].minus[i], 20e3 * 0.8 * p.gain[c] * minus[c], 4e-3);
        }
        ptie_camera_free(camera);
    }
}

static void separate_sensors_see_a_plane_each(void **state) {
    (void)state;
    ptie_camera_params p = defaults();
    p.minus_gain = 0.7;
    ptie_camera *camera = make(&p);
    assert_int_equal(camera->sensors, 2);
    assert_true(camera->sensor[0].plus[17] == 20e3f && !camera->sensor[0].minus);
    assert_true(camera->sensor[1].minus[17] == 14e3f && !camera->sensor[1].plus);
    ptie_camera_free(camera);
}

typedef struct moments {
    double mean, variance, fourth; /* central */
} moments;

static moments moments_of(const float *values, size_t count) {
    moments m = {0};
    for (size_t i = 0; i < count; i++) m.mean += (double)values[i] / (double)count;
    for (size_t i = 0; i < count; i++) {
        const double d = (double)values[i] - m.mean;
        m.variance += d * d / (double)count;
        m.fourth += d * d * d * d / (double)count;
    }
    return m;
}

/* Five standard errors of mean and variance. */
static void assert_moments(const float *values, size_t count, double mean, double variance) {
    const moments m = moments_of(values, count);
    assert_near(m.mean, mean, 5 * sqrt(m.variance / (double)count));
    assert_near(m.variance, variance, 5 * sqrt((m.fourth - m.variance * m.variance) / (double)count));
}

static void noise_is_that_of_photons_and_of_the_reading(void **state) {
    (void)state;
    enum { FRAMES = 40 };
    float *plane = image(), *all = calloc((size_t)FRAMES * PIXELS, sizeof *all), *other = image();
    ptie_camera_params p = defaults();
    p.full_well = 4000, p.read_noise = 12, p.exposure = 1; /* about an electron per count */
    ptie_camera *camera = make(&p);
    const double gain = (4095.0 - 64) / 4000;
    const double intensities[] = {0, 0.001, 0.0039, 0.0041, 0.02, 0.3, 0.9};
    for (size_t k = 0; k < sizeof intensities / sizeof *intensities; k++) {
        for (int i = 0; i < PIXELS; i++) plane[i] = (float)intensities[k];
        for (int t = 0; t < FRAMES; t++)
            capture(camera, all + (size_t)t * PIXELS, other, plane, plane, PTIE_EXPOSE_FLOW, t);
        const double electrons = 4000 * intensities[k];
        /* Rounding adds 1/12: the noise is far wider than a count. */
        assert_moments(all, (size_t)FRAMES * PIXELS, 64 + gain * electrons, gain * gain * (electrons + 144) + 1.0 / 12);
    }
    ptie_camera_free(camera);
    free(plane), free(all), free(other);
}

static void poisson_numbers_are_poisson(void **state) {
    (void)state;
    enum { N = 400000 };
    float *normal = calloc(N, sizeof *normal), *drawn = calloc(N, sizeof *drawn);
    ptie_random random;
    ptie_random_init(&random, 3, PTIE_STREAM_SENSOR, 1);
    ptie_random_normals(&random, normal, N);
    const float means[] = {0, 0.5f, 3, 15.9f, 16.1f, 100, 1e4f};
    for (size_t k = 0; k < sizeof means / sizeof *means; k++) {
        for (int i = 0; i < N; i++) drawn[i] = ptie_poisson(means[k], normal[i]);
        assert_moments(drawn, N, (double)means[k], (double)means[k]);
    }
    /* Frequencies of few, within five standard errors. */
    double term = exp(-3);
    for (int k = 0; k < 12; term *= 3.0 / ++k) {
        double found = 0;
        for (int i = 0; i < N; i++) found += ptie_poisson(3, normal[i]) == (float)k;
        assert_near(found / N, term, 5 * sqrt(term * (1 - term) / N));
    }
    /* The third moment of many, which a normal would not have: that of Poisson numbers is the mean.  Standard error for
       nearly normal numbers: sqrt(15 / N) mean^1.5. */
    double third = 0;
    for (int i = 0; i < N; i++) third += pow((double)ptie_poisson(20, normal[i]) - 20, 3) / N;
    assert_near(third, 20, 5 * sqrt(15.0 / N) * pow(20, 1.5));
    free(normal), free(drawn);
}

static void counts_end_at_black_and_white(void **state) {
    (void)state;
    float *bright = image(), *dark = image(), *counts = image(), *other = image();
    ptie_camera_params p = defaults();
    p.bits = 8, p.black = 3, p.full_well = 1000, p.read_noise = 30;
    for (int i = 0; i < PIXELS; i++) bright[i] = 9;
    ptie_camera *camera = make(&p);
    capture(camera, counts, other, bright, dark, PTIE_EXPOSE_FLOW, 0);
    float low = 255;
    for (int i = 0; i < PIXELS; i++) {
        assert_true(counts[i] == 255);
        assert_true(other[i] >= 0 && other[i] == rintf(other[i]));
        low = fminf(low, other[i]);
    }
    assert_true(low == 0); /* 3 counts are 12 electrons, read noise is 30 */
    ptie_camera_free(camera);
    free(bright), free(dark), free(counts), free(other);
}

static void a_frame_is_a_function_of_its_name(void **state) {
    (void)state;
    float *plane = image(), *a = image(), *b = image(), *other = image();
    ptie_camera_params p = defaults();
    p.flicker = 0.01, p.dust = 20, p.fringes = 0.05, p.pixel_gain = 0.01, p.pixel_offset = 2;
    for (int i = 0; i < PIXELS; i++) plane[i] = 1;
    ptie_camera *camera = make(&p), *twin = make(&p);
    capture(camera, a, other, plane, plane, PTIE_EXPOSE_FLOW, 3);
    assert_memory_not_equal(a, other, PIXELS * sizeof *a);
    capture(twin, b, other, plane, plane, PTIE_EXPOSE_FLOW, 4);
    assert_memory_not_equal(a, b, PIXELS * sizeof *a);
    capture(twin, b, other, plane, plane, PTIE_EXPOSE_REFERENCE, 3);
    assert_memory_not_equal(a, b, PIXELS * sizeof *a);
    capture(twin, b, other, plane, plane, PTIE_EXPOSE_FLOW, 3);
    assert_memory_equal(a, b, PIXELS * sizeof *a);
    ptie_camera_free(camera), ptie_camera_free(twin);
    free(plane), free(a), free(b), free(other);
}

static void without_light_there_is_black(void **state) {
    (void)state;
    float *a = image(), *b = image();
    ptie_camera_params p = defaults();
    p.pixel_offset = 3, p.read_noise = 0, p.fringes = 0.1;
    ptie_camera *camera = make(&p);
    capture(camera, a, b, NULL, NULL, PTIE_EXPOSE_DARK, 0);
    assert_moments(a, PIXELS, 64, 9 + 1.0 / 12);
    assert_moments(b, PIXELS, 64, 9 + 1.0 / 12);
    for (int i = 0; i < PIXELS; i++) assert_true(a[i] == floorf(camera->sensor[0].black[i] + 0.5f));
    ptie_camera_free(camera);
    free(a), free(b);
}

static void patterns_have_the_stated_size(void **state) {
    (void)state;
    ptie_camera_params p = defaults();
    p.exposure = 1, p.full_well = 1, p.pixel_gain = 0.02;
    ptie_camera *camera = make(&p);
    assert_moments(camera->sensor[0].plus, PIXELS, 1, 4e-4);
    ptie_camera_free(camera);
    p.pixel_gain = 0, p.fringes = 0.06;
    camera = make(&p);
    float low = 2, high = 0, difference = 0;
    for (int i = 0; i < PIXELS; i++) {
        const float plus = camera->sensor[0].plus[i], minus = camera->sensor[1].minus[i];
        low = fminf(low, plus), high = fmaxf(high, plus), difference = fmaxf(difference, fabsf(plus - minus));
    }
    /* Two plates of 3 % each, which meet somewhere in crest and trough; the planes differ. */
    assert_near((double)high, 1.03 * 1.03, 2e-3);
    assert_near((double)low, 0.97 * 0.97, 2e-3);
    assert_true(difference > 0.05f);
    ptie_camera_free(camera);
    p.fringes = 0, p.dust = 1, p.dust_depth = 0.3;
    camera = make(&p);
    for (int i = 0; i < PIXELS; i++) low = fminf(low, camera->sensor[0].plus[i]);
    /* The middle of the speck, radius 1.5 px at least, is within 0.71 px of a pixel: 0.3 exp(-0.22) .. 0.3. */
    assert_true(low >= 0.7f - 1e-6f && low <= 1 - 0.3f * expf(-0.23f));
    ptie_camera_free(camera);
}

static void flicker_is_the_power_of_a_plane(void **state) {
    (void)state;
    enum { FRAMES = 2000 };
    float *plane = image(), *counts = image(), *other = image(), ratio[FRAMES];
    ptie_camera_params p = defaults();
    p.flicker = 0.02, p.full_well = 1e9, p.read_noise = 0, p.bits = 16, p.black = 0;
    for (int i = 0; i < PIXELS; i++) plane[i] = 1;
    ptie_camera *camera = make(&p);
    for (int t = 0; t < FRAMES; t++) {
        capture(camera, counts, other, plane, plane, PTIE_EXPOSE_FLOW, t);
        ratio[t] = counts[0] / other[0];
    }
    /* Ratio of two such powers; its mean is 1 + 0.02^2, its variance 2 * 0.02^2 but for terms of 0.02^4. */
    assert_moments(ratio, FRAMES, 1 + 4e-4, 8e-4);
    ptie_camera_free(camera);
    free(plane), free(counts), free(other);
}

static void light_is_a_beam_behind_a_nozzle(void **state) {
    (void)state;
    float *light = image();
    ptie_camera_params p = defaults();
    p.beam_m = 1e-3, p.nozzle_length_m = 0.2e-3, p.nozzle_width_m = 0.4e-3; /* 10 x 20 px */
    ptie_camera *camera = make(&p);
    ptie_camera_illuminate(camera, light);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const double dx = (x - 47.5) * 20e-6, dy = (y - 31.5) * 20e-6;
            const bool opaque = x < 10 && y >= 22 && y < 42;
            assert_near((double)light[y * W + x], opaque ? 0 : exp(-2 * (dx * dx + dy * dy) / 1e-6), 1e-7);
        }
    ptie_camera_free(camera);
    free(light);
}

static void read_file(ptie_camera_params *p, const char *text) {
    const char *path = support_temporary("camera.ini");
    support_write(path, text, strlen(text));
    assert_ok(ptie_camera_read(p, path));
}

static void refuse(const char *text, ptie_status status, const char *message) {
    ptie_camera_params p;
    const char *path = support_temporary("camera.ini");
    support_write(path, text, strlen(text));
    assert_fails(ptie_camera_read(&p, path), status, message);
}

static void files_say_what_a_camera_is(void **state) {
    (void)state;
    ptie_camera_params p, none = defaults();
    read_file(&p, "");
    assert_memory_equal(&p, &none, sizeof p);
    read_file(&p, "[sensor]\nlayout = mosaic\n[mosaic]\nangles = crysta\nplus = 0 rad\nminus = 90 deg\nextinction = 80\ngain = 1 .9 1.1 1\n"
                  "[minus]\nrotation = 2 mrad\nshift_x = -1.5\n[light]\nbeam = 8 mm\n[sensor]\nexposure = 60 %\n");
    assert_int_equal(p.layout, PTIE_CAMERA_MOSAIC);
    assert_true(p.angle_deg[0] == 0 && p.angle_deg[1] == 45 && p.angle_deg[2] == 135 && p.angle_deg[3] == 90);
    assert_true(p.extinction == 80 && p.gain[1] == 0.9 && p.gain[2] == 1.1 && p.minus_rotation_rad == 2e-3 &&
                p.minus_shift_x_px == -1.5 && p.beam_m == 8e-3 && p.exposure == 0.6);
    assert_near(p.minus_rad, PI / 2, 1e-15);
    read_file(&p, "[mosaic]\nangles = 0 90 45 30\n");
    assert_true(p.layout == PTIE_CAMERA_SEPARATE && p.angle_deg[1] == 90 && p.angle_deg[3] == 30);
    refuse("[mosaic]\nangles = canon\n", PTIE_EFORMAT, "angles: expected sony, crysta or four different angles");
    refuse("[mosaic]\ngain = 1 1 1\n", PTIE_EFORMAT, "gain: expected four numbers from 0 to 100, row by row, found '1 1 1'");
    refuse("[mosaic]\ngain = 1 1 1 1 1\n", PTIE_EFORMAT, "gain: expected four numbers");
    refuse("[mosaic]\ngain = 1 1 1 -1\n", PTIE_EFORMAT, "gain: expected four numbers from 0 to 100");
    refuse("[sensor]\nblack = 255\nbits = 8\n", PTIE_EINVAL, "black is out of range (expected 0..254, found 255)");
    refuse("[sensor]\nbits = 20\n", PTIE_EFORMAT, "bits: out of range");
    refuse("[light]\nbeem = 8 mm\n", PTIE_ENAME, "did you mean 'beam'?");
    none.gain[2] = -1;
    assert_fails(ptie_camera_check(&none, "here"), PTIE_EINVAL, "here: gain is out of range (expected 0..100, found -1)");
    none.exposure = (double)NAN;
    assert_fails(ptie_camera_check(&none, "here"), PTIE_EINVAL, "here: exposure is out of range");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_moved_plane_shows_the_object_where_it_should),
        cmocka_unit_test(a_cell_sees_what_malus_says),
        cmocka_unit_test(separate_sensors_see_a_plane_each),
        cmocka_unit_test(noise_is_that_of_photons_and_of_the_reading),
        cmocka_unit_test(poisson_numbers_are_poisson),
        cmocka_unit_test(counts_end_at_black_and_white),
        cmocka_unit_test(a_frame_is_a_function_of_its_name),
        cmocka_unit_test(without_light_there_is_black),
        cmocka_unit_test(patterns_have_the_stated_size),
        cmocka_unit_test(flicker_is_the_power_of_a_plane),
        cmocka_unit_test(light_is_a_beam_behind_a_nozzle),
        cmocka_unit_test(files_say_what_a_camera_is),
    };
    return cmocka_run_group_tests_name("camera", tests, NULL, NULL);
}
