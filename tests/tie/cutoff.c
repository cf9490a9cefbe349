/* SPDX-License-Identifier: BSD-3-Clause */
/* Cut-offs chosen from the planes: near the best there is, which only the truth knows. */
#include "tie/plan.h"

enum { N = 128, PIXELS = N * N, SEEDS = 9 };

typedef struct scene {
    ptie_solver_params params;
    float truth[PIXELS], plus[PIXELS], minus[PIXELS];
} scene;

/* Two Gaussian bumps, seen with noise; mean 0. */
static void set_scene(scene *s, ptie_boundary boundary, double sigma, uint64_t seed) {
    double mean = 0;
    s->params = solver_params(boundary, N, N);
    for (int32_t i = 0; i < PIXELS; i++) {
        const double x = i % N, y = i / N;
        const double phase = 1.5 * exp(-(pow(x - 50, 2) + pow(y - 60, 2)) / (2 * 8 * 8)) -
                             0.8 * exp(-(pow(x - 80, 2) + pow(y - 70, 2)) / (2 * 5 * 5));
        s->truth[i] = (float)phase;
        mean += phase / PIXELS;
    }
    for (int32_t i = 0; i < PIXELS; i++) s->truth[i] -= (float)mean;
    forward(&s->params, s->plus, s->minus, s->truth, PTIE_TIE_SPECTRAL);
    ptie_add_gaussian_noise(s->plus, PIXELS, sigma, 11, PTIE_STREAM_NOISE_PLUS, seed);
    ptie_add_gaussian_noise(s->minus, PIXELS, sigma, 11, PTIE_STREAM_NOISE_MINUS, seed);
}

static double error_with(const scene *s, double cutoff_m) {
    ptie_solver_params p = s->params;
    p.cutoff_m = cutoff_m;
    static float phase[PIXELS];
    assert_ok(solve(&p, phase, s->plus, NULL, s->minus));
    return support_relative_error(phase, s->truth, PIXELS);
}

static double least_error(const scene *s) {
    double best = error_with(s, 0);
    for (double cutoff = 4; cutoff < 4 * N; cutoff *= 1.1)
        best = fmin(best, error_with(s, cutoff * s->params.pixel_m));
    return best;
}

static double chosen(const scene *s, ptie_cutoff_rule rule, double sigma) {
    double cutoff_m = -1;
    const float *const planes[] = {s->plus, s->minus};
    assert_ok(ptie_tie_choose_cutoff(&cutoff_m, &s->params, planes, rule, sigma));
    return cutoff_m;
}

/* Median over frames of the error with the chosen cut-off relative to the least there is. */
static double typical_excess(ptie_boundary boundary, double sigma, double told) {
    static scene s;
    double excess[SEEDS];
    for (int i = 0; i < SEEDS; i++) {
        set_scene(&s, boundary, sigma, (uint64_t)i);
        const double value = error_with(&s, chosen(&s, PTIE_CUTOFF_NOISE, told)) / least_error(&s);
        int32_t at = i;
        for (; at > 0 && excess[at - 1] > value; at--) excess[at] = excess[at - 1];
        excess[at] = value;
    }
    return excess[SEEDS / 2];
}

static void noise_gives_nearly_the_least_error(void **state) {
    (void)state;
    for (int boundary = 0; boundary < 2; boundary++)
        for (double sigma = 0.003; sigma < 0.1; sigma *= 4) {
            /* Worst of these six 1.30 (mirror, 0.003), the others below 1.06. */
            assert_near(typical_excess((ptie_boundary)boundary, sigma, sigma), 1, 0.4);
            assert_near(typical_excess((ptie_boundary)boundary, sigma, 0), 1, 0.4);
        }
}

/* A gradient of the light from plane to plane: the cloud of a false source, stronger than noise. */
static void the_l_curve_removes_a_cloud(void **state) {
    (void)state;
    static scene s;
    for (int boundary = 0; boundary < 2; boundary++)
        for (double gradient = 0.005; gradient < 0.03; gradient *= 2) {
            set_scene(&s, (ptie_boundary)boundary, 0.002, 0);
            for (int32_t i = 0; i < PIXELS; i++)
                s.plus[i] *= 1 + (float)(gradient * cos(2 * PI * (i % N + 0.5) / N));
            const double error = error_with(&s, chosen(&s, PTIE_CUTOFF_L_CURVE, 0));
            /* Measured 1.02 .. 1.15; without a cut-off 3.6 .. 11.4. */
            assert_near(error / least_error(&s), 1, 0.25);
            assert_true(error_with(&s, 0) > 3 * error);
        }
}

static void the_choice_does_not_depend_on_the_scale_of_the_planes(void **state) {
    (void)state;
    static scene s;
    double cutoff[2][2];
    set_scene(&s, PTIE_MIRROR, 0.05, 1);
    for (int scaled = 0; scaled < 2; scaled++) {
        cutoff[scaled][0] = chosen(&s, PTIE_CUTOFF_NOISE, 0.05);
        cutoff[scaled][1] = chosen(&s, PTIE_CUTOFF_NOISE, 0);
        for (int32_t i = 0; i < PIXELS; i++) s.plus[i] *= 4096, s.minus[i] *= 4096;
    }
    assert_true(cutoff[0][0] > 0 && cutoff[0][1] > 0);
    assert_memory_equal(cutoff[0], cutoff[1], sizeof cutoff[0]);
}

static void without_noise_there_is_nothing_to_cut(void **state) {
    (void)state;
    static scene s;
    set_scene(&s, PTIE_PERIODIC, 0, 0);
    assert_true(chosen(&s, PTIE_CUTOFF_NOISE, 1e-9) == 0);
    assert_true(chosen(&s, PTIE_CUTOFF_L_CURVE, 0) == 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_gives_nearly_the_least_error),
        cmocka_unit_test(the_l_curve_removes_a_cloud),
        cmocka_unit_test(the_choice_does_not_depend_on_the_scale_of_the_planes),
        cmocka_unit_test(without_noise_there_is_nothing_to_cut),
    };
    return cmocka_run_group_tests_name("cutoff", tests, NULL, NULL);
}
