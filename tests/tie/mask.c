/* SPDX-License-Identifier: BSD-3-Clause */
/* Opaque parts of a frame, and how far their light and that from beyond the frame reaches. */
#include "tie/plan.h"

#include "tie/derivative.h"

enum { N = 256, PIXELS = N * N };

/* A nozzle from the left edge, and the flow out of it. */
static bool lit(int32_t i) {
    return i % N >= 70 || abs(i / N - 128) >= 30;
}

static double flow(int32_t i) {
    return 3 * exp(-pow((i % N - 95) / 45.0, 2) / 2 - pow((i / N - 128) / 14.0, 2) / 2);
}

typedef struct scene {
    ptie_solver_params params;
    uint8_t mask[PIXELS];
    float truth[PIXELS], light[PIXELS], plus[PIXELS], minus[PIXELS], phase[PIXELS];
} scene;

static void set_scene(scene *s, double defocus_m) {
    s->params = with_planes(solver_params(PTIE_MIRROR, N, N), 2, (const double[]){defocus_m, -defocus_m});
    s->params.mask = s->mask;
    for (int32_t i = 0; i < PIXELS; i++) {
        s->mask[i] = lit(i);
        s->light[i] = lit(i);
        s->truth[i] = (float)flow(i);
    }
    ptie_optics_params p;
    ptie_optics_params_init(&p);
    p.width_px = p.height_px = N, p.defocus_m = defocus_m, p.boundary = PTIE_MIRROR;
    p.propagation = PTIE_ANGULAR_SPECTRUM;
    ptie_optics *optics;
    assert_ok(ptie_optics_plan(&optics, &p));
    void *scratch = ptie_alloc(ptie_optics_scratch(optics), 1);
    assert_ok(ptie_optics_defocus(optics, s->plus, s->minus, s->truth, s->light, scratch));
    ptie_free(scratch);
    ptie_optics_free(optics);
}

/* rms error where there is light, relative to the phase's own variation there. */
static double error_of(const scene *s) {
    double sum = 0, squares = 0, mean = 0, power = 0;
    int32_t count = 0;
    for (int32_t i = 0; i < PIXELS; i++)
        if (lit(i)) {
            const double truth = (double)s->truth[i], error = (double)s->phase[i] - truth;
            sum += error, squares += error * error, mean += truth, power += truth * truth, count++;
        }
    return sqrt((squares - sum * sum / count) / (power - mean * mean / count));
}

/* 1 mm: linear. */
static void structured_light_solvers_see_past_a_nozzle(void **state) {
    (void)state;
    static scene s;
    set_scene(&s, 1e-3);
    const float *const planes[] = {s.plus, s.minus};
    assert_ok(solve_planes(&s.params, s.phase, planes));
    assert_true(error_of(&s) > 0.2); /* 0.28: it takes an opaque pixel for one without signal */
    s.params.method = PTIE_SOLVE_US_TIE;
    assert_ok(solve_planes(&s.params, s.phase, planes));
    assert_true(error_of(&s) < 0.001); /* 5.7e-4 */
    s.params.method = PTIE_SOLVE_ITERATIVE_DCT;
    assert_ok(solve_planes(&s.params, s.phase, planes));
    assert_true(error_of(&s) < 0.001); /* 5.7e-4 */
    for (int32_t i = 0; i < PIXELS; i++)
        if (!lit(i)) assert_true(s.phase[i] == 0);
}

static void reprojection_knows_truth_from_nothing(void **state) {
    (void)state;
    static scene s;
    static float nothing[PIXELS];
    set_scene(&s, 1e-3);
    s.params.method = PTIE_SOLVE_MAX_INTENSITY;
    ptie_solver *solver;
    assert_ok(ptie_tie_plan(&solver, &s.params));
    void *scratch = ptie_alloc(ptie_tie_scratch(solver), 1);
    const float *const planes[] = {s.plus, s.minus}, *const maps[] = {s.truth, nothing};
    double residual[2];
    assert_ok(ptie_tie_reproject(solver, residual, maps, 2, planes, scratch));
    /* The light is taken to be the mean of both planes, which have the edge's fringes: measured 0.042. */
    assert_near(residual[0], 0, 0.06);
    assert_near(residual[1], 1, 1e-5);
    ptie_free(scratch);
    ptie_solver_free(solver);
}

/* What stands in opaque pixels far from light changes nothing. */
static void opaque_pixels_are_not_read(void **state) {
    (void)state;
    static scene s;
    static float expected[PIXELS];
    set_scene(&s, 1e-3);
    const float *const planes[] = {s.plus, s.minus};
    for (int method = PTIE_SOLVE_DIRECT; method <= PTIE_SOLVE_US_TIE; method++) {
        s.params.method = (ptie_solver_method)method;
        s.params.max_iterations = 3;
        assert_ok(solve_planes(&s.params, s.phase, planes));
        memcpy(expected, s.phase, sizeof expected);
        for (int32_t i = 0; i < PIXELS; i++) /* diffraction reaches 1 pixel */
            if (i % N < 68 && abs(i / N - 128) < 28) s.plus[i] += 7;
        assert_ok(solve_planes(&s.params, s.phase, planes));
        assert_memory_equal(s.phase, expected, sizeof expected);
        for (int32_t i = 0; i < PIXELS; i++)
            if (i % N < 68 && abs(i / N - 128) < 28) s.plus[i] -= 7;
    }
}

/* With light everywhere a mask is none. */
static void a_mask_of_light_changes_nothing(void **state) {
    (void)state;
    enum { W = 30, H = 22 };
    ptie_solver_params p = solver_params(PTIE_MIRROR, W, H);
    float phase[W * H], plus[W * H], minus[W * H], with[W * H], without[W * H];
    uint8_t mask[W * H];
    memset(mask, 1, sizeof mask);
    set_band_limited(phase, &p, 30);
    forward(&p, plus, minus, phase, PTIE_TIE_SPECTRAL);
    for (int method = PTIE_SOLVE_DIRECT; method <= PTIE_SOLVE_US_TIE; method++) {
        p.method = (ptie_solver_method)method;
        p.mask = NULL;
        assert_ok(solve(&p, without, plus, NULL, minus));
        p.mask = mask;
        assert_ok(solve(&p, with, plus, NULL, minus));
        /* The mean is summed in another order. */
        assert_near(support_relative_error(with, without, W * H), 0, 1e-6);
    }
}

static void the_border_is_what_diffraction_reaches(void **state) {
    (void)state;
    static scene s;
    static uint8_t border[PIXELS];
    set_scene(&s, 10e-3);
    ptie_solver *solver;
    assert_ok(ptie_tie_plan(&solver, &s.params));
    ptie_tie_border(solver, border);
    ptie_solver_free(solver);
    enum { REACH = 7 }; /* 10 mm * 532 nm / (2 * (20 um)^2) = 6.65 */
    for (int32_t i = 0; i < PIXELS; i++) {
        const int32_t x = i % N, y = i / N;
        const bool inside = x >= REACH && y >= REACH && x < N - REACH && y < N - REACH;
        const bool clear = x >= 70 + REACH || abs(y - 128) >= 30 + REACH;
        assert_int_equal(border[i], inside && clear);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(structured_light_solvers_see_past_a_nozzle),
        cmocka_unit_test(reprojection_knows_truth_from_nothing),
        cmocka_unit_test(opaque_pixels_are_not_read),
        cmocka_unit_test(a_mask_of_light_changes_nothing),
        cmocka_unit_test(the_border_is_what_diffraction_reaches),
    };
    return cmocka_run_group_tests_name("mask", tests, NULL, NULL);
}
