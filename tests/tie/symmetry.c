/* SPDX-License-Identifier: BSD-3-Clause */
/* What must not change the phase, and what must change it in a known way.  Inputs are random
   images: the symmetries hold for any. */
#include "tie/plan.h"

enum { W = 36, H = 28, PIXELS = W * H };

static void set_planes(float *plus, float *minus) {
    ptie_random random;
    ptie_random_init(&random, 4, PTIE_STREAM_TEXTURE, 0);
    for (int i = 0; i < PIXELS; i++) {
        plus[i] = (float)ptie_random_uniform(&random, 0.9, 1.1);
        minus[i] = (float)ptie_random_uniform(&random, 0.9, 1.1);
    }
}

/* Phase of the standard planes, changed by `factor` in one parameter. */
static void solve_with(float *phase, ptie_boundary boundary, double wavelength, double step,
                       double pixel) {
    float plus[PIXELS], minus[PIXELS];
    ptie_solver_params p = solver_params(boundary, W, H);
    p.wavelength_m *= wavelength, p.pixel_m *= pixel;
    p.z_m[0] *= step, p.z_m[1] *= step;
    set_planes(plus, minus);
    assert_ok(solve(&p, phase, plus, NULL, minus));
}

/* Powers of two scale every number of the computation: equal to the bit. */
static void phase_scales_with_wavelength_step_and_pixel(void **state) {
    (void)state;
    for (int boundary = 0; boundary < 2; boundary++) {
        float phase[PIXELS], wavelength[PIXELS], step[PIXELS], pixel[PIXELS];
        solve_with(phase, (ptie_boundary)boundary, 1, 1, 1);
        solve_with(wavelength, (ptie_boundary)boundary, 2, 1, 1);
        solve_with(step, (ptie_boundary)boundary, 1, 4, 1);
        solve_with(pixel, (ptie_boundary)boundary, 1, 1, 2);
        for (int i = 0; i < PIXELS; i++) {
            assert_true(wavelength[i] == phase[i] / 2);
            assert_true(step[i] == phase[i] / 4);
            assert_true(pixel[i] == phase[i] * 4);
        }
    }
}

static void swapping_planes_negates(void **state) {
    (void)state;
    for (int boundary = 0; boundary < 2; boundary++) {
        const ptie_solver_params p = solver_params((ptie_boundary)boundary, W, H);
        float plus[PIXELS], minus[PIXELS], phase[PIXELS], swapped[PIXELS];
        set_planes(plus, minus);
        assert_ok(solve(&p, phase, plus, NULL, minus));
        assert_ok(solve(&p, swapped, minus, NULL, plus));
        for (int i = 0; i < PIXELS; i++) assert_true(swapped[i] == -phase[i]);
    }
}

static void a_common_scale_drops_out(void **state) {
    (void)state;
    ptie_solver_params p = solver_params(PTIE_MIRROR, W, H);
    float plus[PIXELS], minus[PIXELS], zero[PIXELS], phase[3][PIXELS], scaled[3][PIXELS];
    set_planes(plus, minus);
    for (int i = 0; i < PIXELS; i++) zero[i] = 0.5f * (plus[i] + minus[i]);
    assert_ok(solve(&p, phase[0], plus, NULL, minus));
    assert_ok(solve(&p, phase[1], plus, zero, minus));
    assert_ok(solve(&p, phase[2], plus, zero, NULL));
    for (int i = 0; i < PIXELS; i++) plus[i] *= 1024, minus[i] *= 1024, zero[i] *= 1024;
    assert_ok(solve(&p, scaled[0], plus, NULL, minus));
    assert_ok(solve(&p, scaled[1], plus, zero, minus));
    assert_ok(solve(&p, scaled[2], plus, zero, NULL));
    assert_memory_equal(scaled, phase, sizeof phase);
}

/* A constant added to one plane changes the mean that normalises, and nothing else. */
static void a_constant_drops_out(void **state) {
    (void)state;
    for (int boundary = 0; boundary < 2; boundary++) {
        const ptie_solver_params p = solver_params((ptie_boundary)boundary, W, H);
        float plus[PIXELS], minus[PIXELS], phase[PIXELS], shifted[PIXELS];
        set_planes(plus, minus);
        assert_ok(solve(&p, phase, plus, NULL, minus));
        double mean = 0;
        for (int i = 0; i < PIXELS; i++)
            mean += ((double)plus[i] + (double)minus[i]) / (2 * PIXELS);
        for (int i = 0; i < PIXELS; i++) plus[i] += 0.25f;
        assert_ok(solve(&p, shifted, plus, NULL, minus));
        for (int i = 0; i < PIXELS; i++) phase[i] *= (float)(mean / (mean + 0.125));
        /* Rounding of I + 0.25 at 6e-8 and of a transform over an offset: measured 1.8e-6. */
        assert_near(support_relative_error(shifted, phase, PIXELS), 0, 5e-6);
    }
}

static void the_mean_is_zero(void **state) {
    (void)state;
    for (int boundary = 0; boundary < 2; boundary++) {
        float phase[PIXELS];
        solve_with(phase, (ptie_boundary)boundary, 1, 1, 1);
        double sum = 0, magnitude = 0;
        for (int i = 0; i < PIXELS; i++)
            sum += (double)phase[i], magnitude += fabs((double)phase[i]);
        assert_near(sum / magnitude, 0, 1e-7); /* rounding of the inverse transform */
    }
}

/* Where a pixel of the changed image comes from; the changed image may be turned on its side. */
typedef int32_t (*source)(int32_t x, int32_t y);

static int32_t shifted(int32_t x, int32_t y) {
    return (y + H - 5) % H * W + (x + W - 9) % W;
}

static int32_t flipped_x(int32_t x, int32_t y) {
    return y * W + W - 1 - x;
}

static int32_t flipped_y(int32_t x, int32_t y) {
    return (H - 1 - y) * W + x;
}

static int32_t transposed(int32_t x, int32_t y) {
    return x * W + y;
}

static void change(float *out, const float *in, int32_t width, source from) {
    for (int32_t i = 0; i < PIXELS; i++) out[i] = in[from(i % width, i / width)];
}

static void check_equivariance(ptie_boundary boundary, source from, int32_t w, int32_t h) {
    float plus[PIXELS], minus[PIXELS], phase[PIXELS];
    float changed_plus[PIXELS], changed_minus[PIXELS], changed[PIXELS], expected[PIXELS];
    set_planes(plus, minus);
    ptie_solver_params p = solver_params(boundary, W, H);
    assert_ok(solve(&p, phase, plus, NULL, minus));
    change(changed_plus, plus, w, from);
    change(changed_minus, minus, w, from);
    change(expected, phase, w, from);
    p.width_px = w, p.height_px = h;
    assert_ok(solve(&p, changed, changed_plus, NULL, changed_minus));
    assert_near(support_relative_error(changed, expected, PIXELS), 0, 1e-6); /* measured 3.1e-7 */
}

static void flips_and_transposes_pass_through(void **state) {
    (void)state;
    for (int boundary = 0; boundary < 2; boundary++) {
        check_equivariance((ptie_boundary)boundary, flipped_x, W, H);
        check_equivariance((ptie_boundary)boundary, flipped_y, W, H);
        check_equivariance((ptie_boundary)boundary, transposed, H, W);
    }
}

static void translations_pass_through(void **state) {
    (void)state;
    check_equivariance(PTIE_PERIODIC, shifted, W, H);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(phase_scales_with_wavelength_step_and_pixel),
        cmocka_unit_test(swapping_planes_negates),
        cmocka_unit_test(a_common_scale_drops_out),
        cmocka_unit_test(a_constant_drops_out),
        cmocka_unit_test(the_mean_is_zero),
        cmocka_unit_test(flips_and_transposes_pass_through),
        cmocka_unit_test(translations_pass_through),
    };
    return cmocka_run_group_tests_name("symmetry", tests, NULL, NULL);
}
