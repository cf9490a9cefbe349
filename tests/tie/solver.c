/* SPDX-License-Identifier: BSD-3-Clause */
/* The solver undoes the forward model and meets closed forms, for every kind of input. */
#include "tie/plan.h"

#include "tie/derivative.h"

static const int32_t frames[][2] = {{64, 48}, {97, 61}, {256, 256}, {33, 128}, {8, 8}};
enum { FRAMES = sizeof frames / sizeof *frames };

static void solve_undoes_forward(void **state) {
    (void)state;
    for (int boundary = 0; boundary < 2; boundary++)
        for (int i = 0; i < FRAMES; i++) {
            const int32_t w = frames[i][0], h = frames[i][1];
            const ptie_solver_params p = solver_params((ptie_boundary)boundary, w, h);
            float *phase = image_of(w, h), *plus = image_of(w, h), *minus = image_of(w, h);
            set_band_limited(phase, &p, (uint64_t)i);
            forward(&p, plus, minus, phase, PTIE_TIE_SPECTRAL);
            float *found = image_of(w, h);
            assert_ok(solve(&p, found, plus, NULL, minus));
            assert_near(support_relative_error(found, phase, (size_t)(w * h)), 0, 1e-5);
            free(phase), free(plus), free(minus), free(found);
        }
}

/* Not band-limited: the Laplacians of both sides agree up to Nyquist; only the mean is lost. */
static void solve_undoes_forward_on_sharp_edges(void **state) {
    (void)state;
    enum { W = 128, H = 100 };
    for (int boundary = 0; boundary < 2; boundary++) {
        const ptie_solver_params p = solver_params((ptie_boundary)boundary, W, H);
        float *phase = image_of(W, H), *plus = image_of(W, H), *minus = image_of(W, H);
        for (int32_t i = 0; i < W * H; i++) {
            const bool inside = i % W >= 40 && i % W < 72 && i / W >= 25 && i / W < 75;
            phase[i] = inside ? 0.875f : -0.125f; /* 1600 of 12800 pixels: mean 0 */
        }
        forward(&p, plus, minus, phase, PTIE_TIE_SPECTRAL);
        float *found = image_of(W, H);
        assert_ok(solve(&p, found, plus, NULL, minus));
        const double rms = sqrt(0.125 * 0.875); /* of the phase */
        assert_near(support_relative_error(found, phase, W * H), 0,
                    rounding_rad(&p, plus, minus) / rms);
        free(phase), free(plus), free(minus), free(found);
    }
}

/* dI/dz of a known phase, by hand: I+- = 1 +- dz dI/dz. */
static void planes_of(float *plus, float *minus, const double *derivative, int32_t count,
                      double dz) {
    for (int32_t i = 0; i < count; i++) {
        plus[i] = (float)(1 + dz * derivative[i]);
        minus[i] = (float)(1 - dz * derivative[i]);
    }
}

static void eigenfunctions_come_back_positive(void **state) {
    (void)state;
    enum { W = 48, H = 36 };
    for (int boundary = 0; boundary < 2; boundary++) {
        const ptie_solver_params p = solver_params((ptie_boundary)boundary, W, H);
        const double unit = (boundary == PTIE_MIRROR ? 1 : 2) * PI / p.pixel_m;
        const double kx = 3 * unit / W, ky = 2 * unit / H;
        double derivative[W * H];
        float expected[W * H], found[W * H], plus[W * H], minus[W * H];
        for (int32_t i = 0; i < W * H; i++) {
            const double mode =
                cos(kx * p.pixel_m * (i % W + 0.5)) * cos(ky * p.pixel_m * (i / W + 0.5));
            expected[i] = (float)mode;
            derivative[i] = p.wavelength_m / (2 * PI) * (kx * kx + ky * ky) * mode;
        }
        planes_of(plus, minus, derivative, W * H, p.z_m[0]);
        assert_ok(solve(&p, found, plus, NULL, minus));
        /* Measured 1.2e-7: rounding of I, 3e-8, against signals of 0.1 and more, k^-2 amplified. */
        assert_near(support_relative_error(found, expected, W * H), 0, 2e-6);
    }
}

static void a_gaussian_phase_comes_back(void **state) {
    (void)state;
    enum { N = 128 };
    static double derivative[N * N];
    static float expected[N * N], found[N * N], plus[N * N], minus[N * N];
    const double sigma = 150e-6;
    for (int boundary = 0; boundary < 2; boundary++) {
        const ptie_solver_params p = solver_params((ptie_boundary)boundary, N, N);
        double mean = 0;
        for (int32_t i = 0; i < N * N; i++) {
            const double x = (i % N - (N - 1) / 2.0) * p.pixel_m,
                         y = (i / N - (N - 1) / 2.0) * p.pixel_m;
            const double r2 = (x * x + y * y) / (sigma * sigma), phase = 3 * exp(-r2 / 2);
            derivative[i] = -p.wavelength_m / (2 * PI) * phase * (r2 - 2) / (sigma * sigma);
            expected[i] = (float)phase;
            mean += phase / (N * N);
        }
        for (int32_t i = 0; i < N * N; i++) expected[i] -= (float)mean;
        planes_of(plus, minus, derivative, N * N, p.z_m[0]);
        assert_ok(solve(&p, found, plus, NULL, minus));
        /* The tails at the frame are 1e-16; measured 4e-7. */
        assert_near(support_relative_error(found, expected, N * N), 0, 2e-6);
    }
}

/* Intensity quadratic in z, unequal steps: the derivative at focus is exact (M4b). */
static void unequal_steps_are_exact_on_parabolas(void **state) {
    (void)state;
    enum { W = 40, H = 30 };
    ptie_solver_params p = solver_params(PTIE_MIRROR, W, H);
    p.z_m[0] = 15e-3, p.z_m[1] = -6e-3;
    ptie_solver_params even = solver_params(PTIE_MIRROR, W, H);
    float phase[W * H], slope[W * H], curve[W * H], plus[W * H], zero[W * H], minus[W * H],
        found[W * H];
    set_band_limited(phase, &p, 20);
    set_band_limited(curve, &p, 21);
    forward(&even, plus, minus, phase, PTIE_TIE_SPECTRAL);
    for (int32_t i = 0; i < W * H; i++) {
        slope[i] = (plus[i] - minus[i]) / 2; /* per 10 mm */
        zero[i] = 2 + curve[i] / 4;
        const double up = 1.5, down = -0.6, s = (double)slope[i], c = (double)curve[i];
        plus[i] = zero[i] * (float)(1 + up * s + up * up * c);
        minus[i] = zero[i] * (float)(1 + down * s + down * down * c);
    }
    assert_ok(solve(&p, found, plus, zero, minus));
    assert_near(support_relative_error(found, phase, W * H), 0, 1e-5);
}

static void equal_steps_need_no_focus(void **state) {
    (void)state;
    enum { W = 40, H = 30 };
    const ptie_solver_params p = solver_params(PTIE_PERIODIC, W, H);
    float phase[W * H], plus[W * H], minus[W * H], zero[W * H], pair[W * H], triple[W * H];
    set_band_limited(phase, &p, 22);
    forward(&p, plus, minus, phase, PTIE_TIE_SPECTRAL);
    for (int32_t i = 0; i < W * H; i++) zero[i] = 1;
    assert_ok(solve(&p, pair, plus, NULL, minus));
    assert_ok(solve(&p, triple, plus, zero, minus));
    /* The pair divides by its mean, 1 + 1e-8. */
    assert_near(support_relative_error(triple, pair, W * H), 0, 1e-6);
}

/* One plane against its reference, lit unevenly; at either side of the focus. */
static void a_reference_replaces_the_second_plane(void **state) {
    (void)state;
    enum { W = 40, H = 30 };
    for (int side = -1; side <= 1; side += 2) {
        ptie_solver_params p = solver_params(PTIE_MIRROR, W, H);
        float phase[W * H], plus[W * H], minus[W * H], reference[W * H], found[W * H];
        set_band_limited(phase, &p, 23);
        forward(&p, plus, minus, phase, PTIE_TIE_SPECTRAL);
        float *flow = side > 0 ? plus : minus;
        for (int32_t i = 0; i < W * H; i++) {
            reference[i] = 100 + 50 * (float)sin(0.3 * i);
            flow[i] *= reference[i];
        }
        p.z_m[0] = side * 10e-3;
        assert_ok(solve(&p, found, flow, reference, NULL));
        assert_near(support_relative_error(found, phase, W * H), 0, 1e-5);
    }
}

static void regularisation_keeps_the_amplitude_of_fine_structure(void **state) {
    (void)state;
    enum { N = 64 };
    for (int boundary = 0; boundary < 2; boundary++)
        for (int mode = 1; mode <= 31; mode += 5) {
            ptie_solver_params p = solver_params((ptie_boundary)boundary, N, N);
            float phase[N * N], plus[N * N], minus[N * N], found[N * N];
            const double k = (boundary == PTIE_MIRROR ? 1 : 2) * PI * mode / N; /* rad per pixel */
            for (int32_t i = 0; i < N * N; i++) phase[i] = (float)cos(k * (i % N + 0.5));
            forward(&p, plus, minus, phase, PTIE_TIE_SPECTRAL);
            p.cutoff_m = 16 * p.pixel_m;
            assert_ok(solve(&p, found, plus, NULL, minus));
            const double kept = pow(k, 4) / (pow(k, 4) + pow(2 * PI / 16, 4));
            for (int32_t i = 0; i < N * N; i++) phase[i] *= (float)kept;
            double squares = 0;
            for (int32_t i = 0; i < N * N; i++)
                squares += pow((double)found[i] - (double)phase[i], 2);
            /* And that of the inverse transform, 3e-7 of 0.5 rad; measured 4.3e-8. */
            assert_near(sqrt(squares) / N, 0, rounding_rad(&p, plus, minus) + 1.5e-7);
            if (k > 2 * PI / 16 * 4) assert_true(kept > 0.996); /* 1 - (k_c / k)^4 */
        }
}

static void the_result_may_replace_an_input(void **state) {
    (void)state;
    enum { W = 24, H = 20 };
    ptie_solver_params p = solver_params(PTIE_MIRROR, W, H);
    float phase[W * H], planes[3][W * H], copy[3][W * H], expected[W * H];
    set_band_limited(phase, &p, 24);
    forward(&p, planes[0], planes[2], phase, PTIE_TIE_SPECTRAL);
    for (int32_t i = 0; i < W * H; i++) planes[1][i] = 1;
    assert_ok(solve(&p, expected, planes[0], planes[1], planes[2]));
    for (int which = 0; which < 3; which++) {
        memcpy(copy, planes, sizeof copy);
        assert_ok(solve(&p, copy[which], copy[0], copy[1], copy[2]));
        assert_memory_equal(copy[which], expected, sizeof expected);
    }
}

/* The paper's experiment: linear inversion of diffracted light underestimates by sin(chi) / chi. */
static void diffraction_biases_as_the_validity_bound_says(void **state) {
    (void)state;
    enum { N = 64 };
    const ptie_solver_params p = solver_params(PTIE_MIRROR, N, N);
    for (int mode = 4; mode <= 16; mode += 4) {
        float phase[N * N], plus[N * N], minus[N * N], found[N * N];
        const double k = PI * mode / (N * p.pixel_m);
        const double chi = k * k * p.z_m[0] * p.wavelength_m / (4 * PI);
        for (int32_t i = 0; i < N * N; i++)
            phase[i] = (float)(0.01 * cos(k * p.pixel_m * (i % N + 0.5)));
        forward(&p, plus, minus, phase, PTIE_ANGULAR_SPECTRUM);
        assert_ok(solve(&p, found, plus, NULL, minus));
        double gain = 0, norm = 0;
        for (int32_t i = 0; i < N * N; i++) {
            gain += (double)found[i] * (double)phase[i];
            norm += (double)phase[i] * (double)phase[i];
        }
        /* Third order in 0.01 rad; rounding of I against the signal 0.02 chi. */
        assert_near(gain / norm, sin(chi) / chi, 1e-4 + 3e-6 / chi);
        assert_near(gain / norm, 1, chi * chi / 6 + 1e-4 + 3e-6 / chi);
    }
}

/* Iterating on diffraction takes the bias away, from where it is 5 % to where half of the phase is missing. */
static void iterating_undoes_the_bias_of_diffraction(void **state) {
    (void)state;
    enum { N = 64 };
    ptie_solver_params p = solver_params(PTIE_MIRROR, N, N);
    p.method = PTIE_SOLVE_US_TIE;
    for (int mode = 12; mode <= 28; mode += 4) {
        float phase[N * N], plus[N * N], minus[N * N], found[N * N];
        const double k = PI * mode / N;
        for (int32_t i = 0; i < N * N; i++) phase[i] = (float)(0.01 * cos(k * (i % N + 0.5)));
        forward(&p, plus, minus, phase, PTIE_ANGULAR_SPECTRUM);
        assert_ok(solve(&p, found, plus, NULL, minus));
        /* It stops at 1e-3 of the signal, and each step takes sin(chi) / chi >= 0.45 of what is left. */
        assert_near(support_relative_error(found, phase, N * N), 0, 1e-3 / 0.45);
    }
}

static void bad_images_are_named_with_their_pixel(void **state) {
    (void)state;
    enum { W = 6, H = 4 };
    const ptie_solver_params p = solver_params(PTIE_PERIODIC, W, H);
    float good[W * H], bad[W * H], phase[W * H];
    for (int i = 0; i < W * H; i++) good[i] = bad[i] = 1, phase[i] = 77;
    bad[3 * W + 2] = NAN;
    assert_fails(solve(&p, phase, bad, NULL, good), PTIE_ENUMERIC,
                 "plane 0 (z = 0.01 m): value is not finite (at x=2, y=3");
    assert_fails(solve(&p, phase, good, NULL, bad), PTIE_ENUMERIC,
                 "plane 1 (z = -0.01 m): value is not finite (at x=2, y=3");
    assert_fails(solve(&p, phase, good, bad, good), PTIE_ENUMERIC,
                 "plane 1 (z = 0 m): value is not finite (at x=2, y=3");
    bad[3 * W + 2] = 0;
    assert_fails(
        solve(&p, phase, good, bad, good), PTIE_ENUMERIC,
        "plane 1 (in focus or reference): intensity to divide by is not positive (at x=2, y=3; expected > 0, "
        "found 0");
    for (int i = 0; i < W * H; i++) bad[i] = -1;
    assert_fails(solve(&p, phase, good, NULL, bad), PTIE_ENUMERIC,
                 "planes: mean intensity is not positive (expected > 0, found 0)");
    for (int i = 0; i < W * H; i++) assert_true(phase[i] == 77); /* untouched */
}

static void planes_must_lie_apart(void **state) {
    (void)state;
    ptie_solver *solver;
    ptie_solver_params p =
        with_planes(solver_params(PTIE_PERIODIC, 4, 4), 3, (const double[]){1e-3, 0, 1e-3});
    assert_fails(ptie_tie_plan(&solver, &p), PTIE_EINVAL,
                 "planes 0 and 2 lie at the same place (expected z apart by at least 1e-09 m, found 0.001 "
                 "and 0.001)");
    assert_null(solver);
    p.z_m[2] = 2e-3; /* all on one side of the focus: fine */
    assert_ok(ptie_tie_plan(&solver, &p));
    ptie_solver_free(solver);
}

/* I(z) a polynomial of the fitted degree, planes in any order: its slope at 0 comes back exactly. */
static void polynomials_are_exact_for_any_set_of_planes(void **state) {
    (void)state;
    enum { W = 6, H = 5, PIXELS = W * H };
    static const double z[PTIE_MAX_PLANES] = {4e-3, 0, -10e-3, 7e-3, -3e-3, 12e-3, -6e-3, 1e-3};
    for (int32_t count = 2; count <= PTIE_MAX_PLANES; count++)
        for (int32_t order = 1; order < count; order++) {
            float images[PTIE_MAX_PLANES][PIXELS], derivative[PIXELS];
            const float *planes[PTIE_MAX_PLANES];
            for (int32_t p = 0; p < count; p++) {
                planes[p] = images[p];
                for (int32_t i = 0; i < PIXELS; i++) {
                    double sum = 0; /* of c_n (z / 10 mm)^n, relative to c_0 = 5 */
                    for (int32_t n = order; n > 0; n--)
                        sum = (sum + sin(0.9 * i + n)) * z[p] / 10e-3;
                    images[p][i] = (float)(5 * (1 + 0.1 * sum));
                }
            }
            ptie_solver_params params = with_planes(solver_params(PTIE_MIRROR, W, H), count, z);
            params.polynomial_order = order;
            ptie_tie_weights weights;
            assert_ok(ptie_tie_weigh(&weights, &params));
            assert_ok(ptie_tie_derivative(derivative, &weights, planes));
            double size = 0; /* sum of |w|: rounding of the images, 6e-8 of 5 each, divided by 5 */
            for (int32_t p = 0; p < count; p++) size += fabs(weights.weight[p]);
            for (int32_t i = 0; i < PIXELS; i++)
                assert_near((double)derivative[i], 0.1 * sin(0.9 * i + 1) / 10e-3,
                            1e-7 * size + 1e-6 * 0.1 / 10e-3);
        }
}

/* Five planes, parabola: the least-squares slope has the smallest noise of all, sum z_i I_i / sum z_i^2. */
static void many_planes_are_fitted_by_least_squares(void **state) {
    (void)state;
    const ptie_solver_params p = with_planes(solver_params(PTIE_MIRROR, 4, 4), 5,
                                             (const double[]){-2e-3, -1e-3, 0, 1e-3, 2e-3});
    ptie_tie_weights w;
    assert_ok(ptie_tie_weigh(&w, &p));
    assert_true(w.pixelwise && w.base == 2);
    for (int32_t i = 0; i < 5; i++) assert_near(w.weight[i], p.z_m[i] / 10e-6, 1e-9);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solve_undoes_forward),
        cmocka_unit_test(solve_undoes_forward_on_sharp_edges),
        cmocka_unit_test(eigenfunctions_come_back_positive),
        cmocka_unit_test(a_gaussian_phase_comes_back),
        cmocka_unit_test(unequal_steps_are_exact_on_parabolas),
        cmocka_unit_test(equal_steps_need_no_focus),
        cmocka_unit_test(a_reference_replaces_the_second_plane),
        cmocka_unit_test(regularisation_keeps_the_amplitude_of_fine_structure),
        cmocka_unit_test(the_result_may_replace_an_input),
        cmocka_unit_test(diffraction_biases_as_the_validity_bound_says),
        cmocka_unit_test(iterating_undoes_the_bias_of_diffraction),
        cmocka_unit_test(bad_images_are_named_with_their_pixel),
        cmocka_unit_test(planes_must_lie_apart),
        cmocka_unit_test(polynomials_are_exact_for_any_set_of_planes),
        cmocka_unit_test(many_planes_are_fitted_by_least_squares),
    };
    return cmocka_run_group_tests_name("solver", tests, NULL, NULL);
}
