/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/optics.h>: every function, its arguments and their refusal. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include <ptie/optics.h>

static int start(void **state) {
    ptie_ctx *ctx;
    assert_ok(ptie_ctx_create(&ctx, NULL));
    *state = ctx;
    return 0;
}

static int stop(void **state) {
    ptie_ctx_free(*state);
    return 0;
}

static void params_init_sets_the_documented_defaults(void **state) {
    (void)state;
    ptie_optics_params p;
    memset(&p, 0xff, sizeof p);
    ptie_optics_params_init(&p);
    assert_int_equal(p.struct_size, sizeof p);
    assert_true(p.width_px == 256 && p.height_px == 256 && p.pixel_m == 20e-6);
    assert_true(p.wavelength_m == 532e-9 && p.defocus_m == 10e-3);
    assert_true(p.boundary == PTIE_PERIODIC && p.propagation == PTIE_TIE_SPECTRAL);
}

static void refuse(ptie_ctx *ctx, ptie_optics_params params, const char *message) {
    ptie_optics *optics = (ptie_optics *)&params;
    assert_fails(ptie_optics_create(&optics, ctx, &params), PTIE_EINVAL, message);
    assert_null(optics);
}

static void create_checks_every_parameter(void **state) {
    ptie_optics_params good, p;
    ptie_optics_params_init(&good);
    p = good, p.width_px = 1;
    refuse(*state, p, "ptie_optics_create: width_px is out of range (expected 2..32768, found 1)");
    p = good, p.height_px = 32769;
    refuse(*state, p, "height_px is out of range (expected 2..32768, found 32769)");
    p = good, p.pixel_m = 20; /* forgot the micro */
    refuse(*state, p, "pixel_m is out of range (expected 1e-09..1, found 20)");
    p = good, p.wavelength_m = (double)NAN;
    refuse(*state, p, "wavelength_m is out of range (expected 1e-12..0.01, found nan)");
    p = good, p.defocus_m = 0;
    refuse(*state, p, "defocus_m is out of range");
    p = good, p.boundary = (ptie_boundary)2;
    refuse(*state, p, "boundary is out of range (expected 0..1, found 2)");
    p = good, p.propagation = (ptie_propagation)3;
    refuse(*state, p, "propagation is out of range (expected 0..2, found 3)");
    p = good, p.struct_size = 0;
    refuse(*state, p, "params are not initialised");
    ptie_optics *optics;
    assert_fails(ptie_optics_create(NULL, *state, &good), PTIE_EINVAL, "out is missing");
    assert_fails(ptie_optics_create(&optics, NULL, &good), PTIE_EINVAL, "ctx is missing");
    assert_fails(ptie_optics_create(&optics, *state, NULL), PTIE_EINVAL, "params is missing");
}

static void run_checks_every_pointer(void **state) {
    enum { W = 12, H = 10 };
    ptie_optics_params p;
    ptie_optics_params_init(&p);
    p.width_px = W, p.height_px = H, p.defocus_m = -5e-3;
    ptie_optics *optics;
    assert_ok(ptie_optics_create(&optics, *state, &p));
    unsigned char *scratch = ptie_scratch_alloc(ptie_optics_scratch_bytes(optics));
    float phase[W * H] = {0}, plus[W * H], minus[W * H];
    assert_ok(ptie_optics_run(optics, plus, minus, phase, NULL, scratch));
    for (int i = 0; i < W * H; i++) assert_true(plus[i] == 1 && minus[i] == 1);
    assert_fails(ptie_optics_run(NULL, plus, minus, phase, NULL, scratch), PTIE_EINVAL,
                 "ptie_optics_run: optics is missing");
    assert_fails(ptie_optics_run(optics, NULL, minus, phase, NULL, scratch), PTIE_EINVAL,
                 "i_plus is missing");
    assert_fails(ptie_optics_run(optics, plus, NULL, phase, NULL, scratch), PTIE_EINVAL,
                 "i_minus is missing");
    assert_fails(ptie_optics_run(optics, plus, minus, NULL, NULL, scratch), PTIE_EINVAL,
                 "phase_rad is missing");
    assert_fails(ptie_optics_run(optics, plus, minus, phase, NULL, NULL), PTIE_EINVAL,
                 "scratch is missing");
    assert_fails(ptie_optics_run(optics, plus, minus, phase, NULL, scratch + 4), PTIE_EINVAL,
                 "scratch is not aligned");
    ptie_scratch_free(scratch);
    ptie_optics_free(optics);
}

static void nothing_is_a_fine_thing_to_free(void **state) {
    (void)state;
    ptie_optics_free(NULL);
    assert_int_equal(ptie_optics_scratch_bytes(NULL), 0);
}

static void noise_may_be_added_to_nothing(void **state) {
    (void)state;
    float value = 5;
    ptie_add_gaussian_noise(&value, 0, 1, 0, 0, 0);
    assert_true(value == 5);
    ptie_add_gaussian_noise(NULL, 0, 1, 0, 0, 0);
    ptie_add_gaussian_noise(&value, 1, 0, 0, 0, 0);
    assert_true(value == 5);
    ptie_add_gaussian_noise(&value, 1, 1, 0, 0, 0);
    assert_true(value != 5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(params_init_sets_the_documented_defaults),
        cmocka_unit_test(create_checks_every_parameter),
        cmocka_unit_test(run_checks_every_pointer),
        cmocka_unit_test(nothing_is_a_fine_thing_to_free),
        cmocka_unit_test(noise_may_be_added_to_nothing),
    };
    return cmocka_run_group_tests_name("optics", tests, start, stop);
}
