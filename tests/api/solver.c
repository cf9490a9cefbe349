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
    assert_true(p.method == PTIE_SOLVE_DIRECT && p.max_iterations == 100 && !p.mask);
    assert_true(p.plane_count == 2 && p.z_m[0] == 10e-3 && p.z_m[1] == -10e-3);
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
    p = good, p.plane_count = 1;
    refuse(*state, p, "plane_count is out of range (expected 2..8, found 1)");
    p = good, p.z_m[0] = (double)INFINITY;
    refuse(*state, p, "z_m is out of range");
    p = good, p.z_m[1] = (double)NAN;
    refuse(*state, p, "z_m is out of range");
    p = good, p.z_m[1] = p.z_m[0];
    refuse(*state, p, "planes 0 and 1 lie at the same place");
    p = good, p.polynomial_order = 2;
    refuse(*state, p, "polynomial_order is out of range (expected 0..1, found 2)");
    p = good, p.method = (ptie_solver_method)99;
    refuse(*state, p, "method is out of range");
    p = good, p.method = PTIE_SOLVE_ITERATIVE_DCT;
    refuse(*state, p, "the iterative DCT has the mirror boundary");
    p = good, p.max_iterations = 0;
    refuse(*state, p, "max_iterations is out of range");
    p = good, p.intensity_floor = 1.5;
    refuse(*state, p, "intensity_floor is out of range");
    static uint8_t dark[256 * 256];
    p = good, p.mask = dark;
    refuse(*state, p, "the mask leaves no light");
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
    const float *const planes[] = {image, image}, *const missing[] = {image, NULL};
    ptie_solver_report report = {.iterations = -1, .residual = -1};
    assert_ok(ptie_solver_run(solver, phase, planes, scratch, &report));
    assert_true(report.iterations == 1 && report.residual == 0);
    for (int i = 0; i < PIXELS; i++) assert_true(phase[i] == 0);
    assert_fails(ptie_solver_run(solver, phase, missing, scratch, NULL), PTIE_EINVAL,
                 "ptie_solver_run: planes[1] is missing (expected 2 pointers, found NULL)");
    assert_fails(ptie_solver_run(solver, phase, NULL, scratch, NULL), PTIE_EINVAL, "planes is missing");
    assert_fails(ptie_solver_run(solver, NULL, planes, scratch, NULL), PTIE_EINVAL, "phase_rad is missing");
    assert_fails(ptie_solver_run(NULL, phase, planes, scratch, NULL), PTIE_EINVAL, "solver is missing");
    assert_fails(ptie_solver_run(solver, phase, planes, NULL, NULL), PTIE_EINVAL, "scratch is missing");
    assert_fails(ptie_solver_run(solver, phase, planes, scratch + 8, NULL), PTIE_EINVAL,
                 "scratch is not aligned");
    ptie_scratch_free(scratch);
    ptie_solver_free(solver);
}

static double noise_of(ptie_ctx *ctx, int32_t count, const double *z_m, double sigma) {
    ptie_solver_params p;
    ptie_solver_params_init(&p);
    p.width_px = W, p.height_px = H, p.plane_count = count;
    memcpy(p.z_m, z_m, (size_t)count * sizeof *z_m);
    ptie_solver *solver;
    assert_ok(ptie_solver_create(&solver, ctx, &p));
    const double noise = ptie_solver_noise_rad(solver, sigma);
    ptie_solver_free(solver);
    return noise;
}

static void noise_is_proportional_and_ordered(void **state) {
    static const double planes[] = {10e-3, -10e-3, 0}, reference[] = {10e-3, 0};
    const double pair = noise_of(*state, 2, planes, 0.01);
    assert_true(pair > 0);
    assert_near(noise_of(*state, 2, planes, 0.02), 2 * pair, 1e-12);
    /* Equal steps give the plane in focus no weight; half the distance has twice the noise. */
    assert_near(noise_of(*state, 3, planes, 0.01), pair, 1e-12);
    assert_near(noise_of(*state, 2, reference, 0.01), 2 * pair, 1e-12);
    assert_true(isnan(ptie_solver_noise_rad(NULL, 0.01)));
}

static void border_and_cutoff_check_their_arguments(void **state) {
    ptie_solver *solver = small_solver(*state);
    ptie_solver_params p;
    ptie_solver_params_init(&p);
    p.width_px = W, p.height_px = H;
    uint8_t mask[PIXELS];
    assert_ok(ptie_solver_border(solver, mask));
    assert_true(mask[0] == 0 && mask[10 * W + 16] == 1);
    assert_fails(ptie_solver_border(NULL, mask), PTIE_EINVAL, "solver is missing");
    assert_fails(ptie_solver_border(solver, NULL), PTIE_EINVAL, "mask is missing");
    float plus[PIXELS], minus[PIXELS];
    for (int i = 0; i < PIXELS; i++) plus[i] = 1 + 0.01f * (float)sin(i * i), minus[i] = 2 - plus[i];
    const float *const planes[] = {plus, minus}, *const missing[] = {NULL, minus};
    double cutoff = -1;
    assert_ok(ptie_solver_choose_cutoff(&cutoff, *state, &p, planes, PTIE_CUTOFF_NOISE, 0.01));
    assert_true(cutoff >= 0);
    assert_fails(ptie_solver_choose_cutoff(NULL, *state, &p, planes, PTIE_CUTOFF_NOISE, 0), PTIE_EINVAL,
                 "cutoff_m is missing");
    assert_fails(ptie_solver_choose_cutoff(&cutoff, NULL, &p, planes, PTIE_CUTOFF_NOISE, 0), PTIE_EINVAL,
                 "ctx is missing");
    assert_fails(ptie_solver_choose_cutoff(&cutoff, *state, NULL, planes, PTIE_CUTOFF_NOISE, 0), PTIE_EINVAL,
                 "params is missing");
    assert_fails(ptie_solver_choose_cutoff(&cutoff, *state, &p, missing, PTIE_CUTOFF_NOISE, 0), PTIE_EINVAL,
                 "planes[0] is missing");
    assert_fails(ptie_solver_choose_cutoff(&cutoff, *state, &p, planes, (ptie_cutoff_rule)2, 0), PTIE_EINVAL,
                 "rule is out of range");
    assert_fails(ptie_solver_choose_cutoff(&cutoff, *state, &p, planes, PTIE_CUTOFF_NOISE, -1), PTIE_EINVAL,
                 "sigma is out of range");
    plus[5] = NAN;
    assert_fails(ptie_solver_choose_cutoff(&cutoff, *state, &p, planes, PTIE_CUTOFF_NOISE, 0), PTIE_ENUMERIC,
                 "value is not finite");
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
    const float *const planes[] = {j->plus, j->minus};
    void *scratch = ptie_scratch_alloc(ptie_solver_scratch_bytes(j->solver));
    for (int i = 0; i < 50 && j->status == PTIE_OK; i++)
        j->status = ptie_solver_run(j->solver, j->phase, planes, scratch, NULL);
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
        cmocka_unit_test(border_and_cutoff_check_their_arguments),
        cmocka_unit_test(nothing_is_a_fine_thing_to_free),
        cmocka_unit_test(threads_share_a_plan),
    };
    return cmocka_run_group_tests_name("solver", tests, start, stop);
}
