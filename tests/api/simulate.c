/* SPDX-License-Identifier: BSD-3-Clause */
/* Synthetic recordings: what is in them, and that threads do not matter. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include <ptie/simulate.h>
#include <ptie/solver.h>

#include "io/h5.h"
#include "run/rig.h"

enum { SIDE = 64, FRAMES = 5 };

static ptie_simulate_params small(const char *output) {
    ptie_simulate_params p;
    ptie_simulate_params_init(&p);
    p.flow.width_px = p.flow.height_px = SIDE;
    p.flow.morphology = "jet";
    p.flow.seed = 7;
    p.frames = FRAMES;
    p.output = output;
    p.overwrite = true;
    return p;
}

static void simulate(const ptie_simulate_params *p, int32_t threads) {
    ptie_ctx_params c;
    ptie_ctx *ctx;
    ptie_ctx_params_init(&c);
    c.threads = threads;
    assert_ok(ptie_ctx_create(&ctx, &c));
    assert_ok(ptie_simulate(ctx, p, (ptie_progress){0}));
    ptie_ctx_free(ctx);
}

static float *maps(const char *path, const char *name) {
    float *data = malloc(sizeof *data * FRAMES * SIDE * SIDE);
    ptie_h5 *h5;
    assert_ok(ptie_h5_open(&h5, path));
    assert_ok(ptie_h5_read(h5, name, PTIE_H5_F32, 0, FRAMES, data));
    assert_ok(ptie_h5_close(h5));
    return data;
}

static void threads_do_not_change_a_byte(void **state) {
    (void)state;
    const char *paths[2] = {support_temporary("one.h5"), support_temporary("three.h5")};
    size_t bytes[2];
    unsigned char *files[2];
    for (int i = 0; i < 2; i++) {
        ptie_simulate_params p = small(paths[i]);
        simulate(&p, 1 + 2 * i);
        files[i] = support_read(paths[i], &bytes[i]);
    }
    assert_int_equal(bytes[0], bytes[1]);
    assert_memory_equal(files[0], files[1], bytes[0]);
    free(files[0]);
    free(files[1]);
}

static void planes_are_those_of_the_truth(void **state) {
    (void)state;
    const char *path = support_temporary("clean.h5");
    ptie_simulate_params p = small(path);
    p.noise = 0;
    p.amplitude_rad = 0.5;
    simulate(&p, 2);
    float *plus = maps(path, "/entry/data/plus"), *minus = maps(path, "/entry/data/minus"),
          *truth = maps(path, "/entry/truth/phase"), *phase = malloc(sizeof *phase * SIDE * SIDE);
    ptie_solver_params sp;
    ptie_solver *solver;
    ptie_ctx *ctx;
    ptie_solver_params_init(&sp);
    sp.width_px = sp.height_px = SIDE;
    sp.pixel_m = p.flow.pixel_m;
    sp.boundary = p.boundary;
    assert_ok(ptie_ctx_create(&ctx, NULL));
    assert_ok(ptie_solver_create(&solver, ctx, &sp));
    void *scratch = ptie_scratch_alloc(ptie_solver_scratch_bytes(solver));
    for (int t = 0; t < FRAMES; t++) {
        float *map = truth + t * SIDE * SIDE;
        double mean = 0, peak = 0;
        const float *const planes[] = {plus + t * SIDE * SIDE, minus + t * SIDE * SIDE};
        assert_ok(ptie_solver_run(solver, phase, planes, scratch, NULL));
        for (int i = 0; i < SIDE * SIDE; i++) {
            mean += (double)map[i] / (SIDE * SIDE);
            peak = fmax(peak, (double)map[i]);
        }
        assert_near(peak, 0.5, 1e-6);
        for (int i = 0; i < SIDE * SIDE; i++) map[i] -= (float)mean;
        /* What the forward model and its inverse promise of each other; measured 3.5e-7. */
        assert_true(support_relative_error(phase, map, SIDE * SIDE) < 1e-5);
    }
    assert_true(support_relative_error(truth, truth + SIDE * SIDE, SIDE * SIDE) >
                1e-3); /* it moves */
    ptie_scratch_free(scratch);
    ptie_solver_free(solver);
    ptie_ctx_free(ctx);
    free(plus), free(minus), free(truth), free(phase);
}

static void noise_has_the_stated_size(void **state) {
    (void)state;
    const char *noisy = support_temporary("noisy.h5"), *clean = support_temporary("clean.h5");
    ptie_simulate_params p = small(noisy);
    p.noise = 0.03;
    simulate(&p, 2);
    p.output = clean, p.noise = 0;
    simulate(&p, 2);
    const char *names[] = {"/entry/data/plus", "/entry/data/minus"};
    for (int k = 0; k < 2; k++) {
        float *a = maps(noisy, names[k]), *b = maps(clean, names[k]);
        enum { N = FRAMES * SIDE * SIDE };
        double squares = 0;
        for (int i = 0; i < N; i++) squares += pow((double)a[i] - (double)b[i], 2);
        /* Standard error of a variance: sqrt(2/N); five of them, halved for the root. */
        assert_near(sqrt(squares / N), 0.03, 0.03 * 2.5 * sqrt(2.0 / N));
        free(a);
        free(b);
    }
}

static void physical_flows_reach_the_wanted_phase(void **state) {
    (void)state;
    const char *path = support_temporary("plasma.h5");
    ptie_simulate_params p = small(path);
    p.flow.family = PTIE_PHYSICAL;
    p.flow.morphology = "plasma";
    p.amplitude_rad = 0.25;
    simulate(&p, 2);
    float *truth = maps(path, "/entry/truth/phase");
    double peak = 0;
    for (int i = 0; i < SIDE * SIDE; i++) peak = fmax(peak, fabs((double)truth[i]));
    assert_near(peak, 0.25, 1e-6);
    free(truth);
}

static void the_rig_fits_the_recording(void **state) {
    (void)state;
    ptie_simulate_params p = small(support_temporary("jet.h5"));
    ptie_rig rig;
    p.rig = support_temporary("jet.ini");
    p.flow.wavelength_m = 633e-9;
    p.flow.pixel_m = 13.7e-6;
    p.defocus_m = 7e-3;
    simulate(&p, 2);
    assert_ok(ptie_rig_read(&rig, p.rig));
    assert_true(rig.wavelength_m == 633e-9 && rig.pixel_m == 13.7e-6 &&
                rig.plane[PTIE_PLUS].defocus_m == 7e-3 && rig.plane[PTIE_MINUS].defocus_m == -7e-3 &&
                rig.frame_rate_hz == 25e3);
    assert_false(rig.one_plane || rig.plane[PTIE_ZERO].used);
    assert_int_equal(rig.layout, PTIE_LAYOUT_SEPARATE);
    assert_int_equal(rig.boundary, p.boundary);
    assert_int_equal(rig.polarity, 1);
    assert_string_equal(rig.plane[PTIE_PLUS].source, "/entry/data/plus");
    assert_string_equal(rig.plane[PTIE_MINUS].source, "/entry/data/minus");
}

static int stop_after_three(void *user, uint64_t done, uint64_t total, const char *note) {
    (void)user, (void)total, (void)note;
    return done >= 3;
}

static void failures_leave_no_file(void **state) {
    (void)state;
    ptie_ctx *ctx;
    const char *path = support_temporary("never.h5"), *rig = support_temporary("never.ini");
    ptie_simulate_params p = small(path);
    p.rig = rig;
    assert_ok(ptie_ctx_create(&ctx, NULL));
    assert_fails(ptie_simulate(ctx, &p, (ptie_progress){stop_after_three, NULL}), PTIE_ECANCELLED,
                 "cancelled");
    p.flow.morphology = "jett";
    assert_fails(ptie_simulate(ctx, &p, (ptie_progress){0}), PTIE_ENAME, "'jet'");
    p.flow.morphology = "jet", p.noise = -1;
    assert_fails(ptie_simulate(ctx, &p, (ptie_progress){0}), PTIE_EINVAL, "noise");
    p.noise = 0, p.frame_rate_hz = 1e-9;
    assert_fails(ptie_simulate(ctx, &p, (ptie_progress){0}), PTIE_EINVAL,
                 "time of the last frame is out of range (expected 0..1e+06, found 5e+09)");
    p.frame_rate_hz = 25e3, p.output = NULL;
    assert_fails(ptie_simulate(ctx, &p, (ptie_progress){0}), PTIE_EINVAL, "output");
    p.output = "jet.tif";
    assert_fails(ptie_simulate(ctx, &p, (ptie_progress){0}), PTIE_EINVAL, "jet.tif");
    p.output = p.rig = path;
    assert_fails(ptie_simulate(ctx, &p, (ptie_progress){0}), PTIE_EINVAL, "would be written over");
    assert_false(support_exists(path) || support_exists(rig));
    p = small(path), p.rig = rig, p.overwrite = false;
    support_write(rig, "mine", 4);
    assert_fails(ptie_simulate(ctx, &p, (ptie_progress){0}), PTIE_EEXIST, "never.ini");
    assert_false(support_exists(path));
    ptie_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_do_not_change_a_byte),
        cmocka_unit_test(planes_are_those_of_the_truth),
        cmocka_unit_test(noise_has_the_stated_size),
        cmocka_unit_test(physical_flows_reach_the_wanted_phase),
        cmocka_unit_test(the_rig_fits_the_recording),
        cmocka_unit_test(failures_leave_no_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
