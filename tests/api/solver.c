/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/solver.h>: every function, its arguments and their refusal; concurrent runs. */
#include "support/support.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>

#include <ptie/solver.h>

enum { W = 32, H = 20, PIXELS = W * H };

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

static ptie_solver *small_solver(ptie_ctx *ctx) {
    ptie_solver_params p;
    ptie_solver_params_init(&p);
    p.width_px = W, p.height_px = H;
    ptie_solver *solver;
    assert_ok(ptie_solver_create(&solver, ctx, &p));
    return solver;
}

static void params_init_sets_the_documented_defaults(void **state) {
    (void)state;
    ptie_solver_params p;
    memset(&p, 0xff, sizeof p);
    ptie_solver_params_init(&p);
    assert_int_equal(p.struct_size, sizeof p);
    assert_true(p.width_px == 256 && p.height_px == 256 && p.pixel_m == 20e-6);
    assert_true(p.wavelength_m == 532e-9 && p.boundary == PTIE_PERIODIC && p.cutoff_m == 0);
    assert_true(p.defocus_plus_m == 10e-3 && p.defocus_minus_m == -10e-3);
}

static void refuse(ptie_ctx *ctx, ptie_solver_params params, const char *message) {
    ptie_solver *solver = (ptie_solver *)&params;
    assert_fails(ptie_solver_create(&solver, ctx, &params), PTIE_EINVAL, message);
    assert_null(solver);
}

static void create_checks_every_parameter(void **state) {
    ptie_solver_params good, p;
    ptie_solver_params_init(&good);
    p = good, p.width_px = -5;
    refuse(*state, p, "ptie_solver_create: width_px is out of range (expected 2..32768, found -5)");
    p = good, p.height_px = 0;
    refuse(*state, p, "height_px is out of range");
    p = good, p.pixel_m = 0;
    refuse(*state, p, "pixel_m is out of range");
    p = good, p.wavelength_m = 532; /* forgot the nano */
    refuse(*state, p, "wavelength_m is out of range (expected 1e-12..0.01, found 532)");
    p = good, p.defocus_plus_m = (double)INFINITY;
    refuse(*state, p, "defocus_plus_m is out of range");
    p = good, p.defocus_minus_m = (double)NAN;
    refuse(*state, p, "defocus_minus_m is out of range");
    p = good, p.boundary = (ptie_boundary)-1;
    refuse(*state, p, "boundary is out of range");
    p = good, p.cutoff_m = -1;
    refuse(*state, p, "cutoff_m is out of range (expected 0..1e+06, found -1)");
    p = good, p.struct_size = 0;
    refuse(*state, p, "params are not initialised");
    ptie_solver *solver;
    assert_fails(ptie_solver_create(NULL, *state, &good), PTIE_EINVAL, "out is missing");
    assert_fails(ptie_solver_create(&solver, NULL, &good), PTIE_EINVAL, "ctx is missing");
    assert_fails(ptie_solver_create(&solver, *state, NULL), PTIE_EINVAL, "params is missing");
}

static void run_checks_every_pointer(void **state) {
    ptie_solver *solver = small_solver(*state);
    unsigned char *scratch = ptie_scratch_alloc(ptie_solver_scratch_bytes(solver));
    float image[PIXELS], phase[PIXELS];
    for (int i = 0; i < PIXELS; i++) image[i] = 1;
    assert_ok(ptie_solver_run(solver, phase, image, NULL, image, scratch));
    for (int i = 0; i < PIXELS; i++) assert_true(phase[i] == 0);
    assert_ok(ptie_solver_run(solver, phase, image, image, image, scratch));
    assert_ok(ptie_solver_run(solver, phase, image, image, NULL, scratch));
    assert_fails(ptie_solver_run(solver, phase, image, NULL, NULL, scratch), PTIE_EINVAL,
                 "ptie_solver_run: a second plane is missing");
    assert_fails(ptie_solver_run(solver, phase, NULL, image, image, scratch), PTIE_EINVAL,
                 "i_plus is missing");
    assert_fails(ptie_solver_run(solver, NULL, image, image, image, scratch), PTIE_EINVAL,
                 "phase_rad is missing");
    assert_fails(ptie_solver_run(NULL, phase, image, image, image, scratch), PTIE_EINVAL,
                 "solver is missing");
    assert_fails(ptie_solver_run(solver, phase, image, image, image, NULL), PTIE_EINVAL,
                 "scratch is missing");
    assert_fails(ptie_solver_run(solver, phase, image, image, image, scratch + 8), PTIE_EINVAL,
                 "scratch is not aligned");
    ptie_scratch_free(scratch);
    ptie_solver_free(solver);
}

static void noise_is_proportional_and_ordered(void **state) {
    ptie_solver *solver = small_solver(*state);
    const double pair = ptie_solver_noise_rad(solver, PTIE_PLANES_PAIR, 0.01);
    assert_true(pair > 0);
    assert_near(ptie_solver_noise_rad(solver, PTIE_PLANES_PAIR, 0.02), 2 * pair, 1e-12);
    /* Equal steps give the plane in focus no weight; half the distance has twice the noise. */
    assert_near(ptie_solver_noise_rad(solver, PTIE_PLANES_TRIPLE, 0.01), pair, 1e-12);
    assert_near(ptie_solver_noise_rad(solver, PTIE_PLANES_REFERENCE, 0.01), 2 * pair, 1e-12);
    assert_true(isnan(ptie_solver_noise_rad(NULL, PTIE_PLANES_PAIR, 0.01)));
    assert_true(isnan(ptie_solver_noise_rad(solver, (ptie_planes)3, 0.01)));
    ptie_solver_free(solver);
}

static void nothing_is_a_fine_thing_to_free(void **state) {
    (void)state;
    ptie_solver_free(NULL);
    assert_int_equal(ptie_solver_scratch_bytes(NULL), 0);
}

typedef struct job {
    const ptie_solver *solver;
    const float *plus, *minus;
    float phase[PIXELS];
    ptie_status status;
} job;

static void *work(void *argument) {
    job *j = argument;
    void *scratch = ptie_scratch_alloc(ptie_solver_scratch_bytes(j->solver));
    for (int i = 0; i < 50 && j->status == PTIE_OK; i++)
        j->status = ptie_solver_run(j->solver, j->phase, j->plus, NULL, j->minus, scratch);
    ptie_scratch_free(scratch);
    return NULL;
}

static void threads_share_a_plan(void **state) {
    ptie_solver *solver = small_solver(*state);
    float plus[PIXELS], minus[PIXELS];
    for (int i = 0; i < PIXELS; i++) plus[i] = 1 + 0.1f * (float)sin(i), minus[i] = 1;
    static job jobs[4];
    pthread_t threads[4];
    for (int i = 0; i < 4; i++) {
        jobs[i] = (job){.solver = solver, .plus = plus, .minus = minus};
        assert_int_equal(pthread_create(&threads[i], NULL, work, &jobs[i]), 0);
    }
    for (int i = 0; i < 4; i++) {
        pthread_join(threads[i], NULL);
        assert_ok(jobs[i].status);
        assert_memory_equal(jobs[i].phase, jobs[0].phase, sizeof jobs[0].phase);
    }
    ptie_solver_free(solver);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(params_init_sets_the_documented_defaults),
        cmocka_unit_test(create_checks_every_parameter),
        cmocka_unit_test(run_checks_every_pointer),
        cmocka_unit_test(noise_is_proportional_and_ordered),
        cmocka_unit_test(nothing_is_a_fine_thing_to_free),
        cmocka_unit_test(threads_share_a_plan),
    };
    return cmocka_run_group_tests_name("solver", tests, start, stop);
}
