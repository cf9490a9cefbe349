/* SPDX-License-Identifier: BSD-3-Clause */
/* Synthetic recordings: what is in them, and that threads do not matter. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include <ptie/recording.h>
#include <ptie/simulate.h>
#include <ptie/solver.h>

#include "io/h5.h"
#include "rig/rig.h"

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

/* A mosaic camera with everything that a real one has. */
static ptie_camera_params faulty(void) {
    ptie_camera_params c;
    ptie_camera_params_init(&c);
    c.layout = PTIE_CAMERA_MOSAIC;
    c.extinction = 40, c.minus_gain = 0.8, c.gain[0] = 0.9;
    c.minus_shift_x_px = 1.5, c.minus_magnification = 1.01, c.minus_rotation_rad = 4e-3;
    c.pixel_gain = 0.01, c.pixel_offset = 1, c.dust = 3, c.fringes = 0.02, c.flicker = 0.01;
    c.beam_m = 2e-3, c.nozzle_length_m = 0.2e-3, c.nozzle_width_m = 0.3e-3;
    return c;
}

static void a_camera_writes_the_same_bytes_with_any_threads(void **state) {
    (void)state;
    static const char *const beside[] = {"", "_reference", "_dark", "_target"};
    const ptie_camera_params camera = faulty();
    unsigned char *first[5] = {0};
    size_t bytes[5];
    for (int threads = 1; threads <= 3; threads += 2) {
        ptie_simulate_params p = small(support_temporary("lab.npy"));
        p.camera = &camera, p.reference_frames = 3, p.dark_frames = 2, p.target_frames = 2;
        p.propagation = PTIE_ANGULAR_SPECTRUM;
        simulate(&p, threads);
        for (int i = 0; i < 5; i++) {
            char name[64];
            size_t length;
            snprintf(name, sizeof name, i < 4 ? "lab%s.npy" : "lab_truth.h5", i < 4 ? beside[i] : "");
            unsigned char *file = support_read(support_temporary(name), &length);
            if (threads == 1) {
                first[i] = file, bytes[i] = length;
                continue;
            }
            assert_int_equal(length, bytes[i]);
            assert_memory_equal(file, first[i], length);
            free(file), free(first[i]);
        }
    }
}

/* Frames, size and pixel of a file, and its first frame. */
static float *first_frame(const char *path, int64_t frames, int32_t side, double pixel_m) {
    ptie_recording *recording;
    assert_ok(ptie_recording_open(&recording, path));
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    assert_int_equal(info->frames, frames);
    assert_true(info->width_px == side && info->height_px == side);
    if (pixel_m > 0) assert_near(info->pixel_m, pixel_m, 1e-12);
    float *frame = malloc(sizeof *frame * (size_t)(side * side));
    assert_ok(ptie_recording_read(recording, 0, frame));
    ptie_recording_close(recording);
    return frame;
}

static void a_camera_records_flow_reference_dark_and_truth(void **state) {
    (void)state;
    ptie_camera_params camera;
    ptie_camera_params_init(&camera);
    camera.layout = PTIE_CAMERA_MOSAIC;
    camera.full_well = 1e9, camera.read_noise = 0, camera.bits = 16; /* noise below a count and a half */
    ptie_simulate_params p = small(support_temporary("lab.tif"));
    p.camera = &camera, p.reference_frames = 4, p.dark_frames = 2, p.amplitude_rad = 0.3;
    simulate(&p, 2);
    float *flow = first_frame(p.output, FRAMES, SIDE, 20e-6),
          *still = first_frame(support_temporary("lab_reference.tif"), 4, SIDE, 20e-6),
          *dark = first_frame(support_temporary("lab_dark.tif"), 2, SIDE, 20e-6),
          *truth = first_frame(support_temporary("lab_truth.h5"), FRAMES, SIDE / 2, 40e-6);
    p.camera = NULL, p.noise = 0, p.output = support_temporary("clean.h5");
    simulate(&p, 2);
    float *plus = maps(p.output, "/entry/data/plus"), *minus = maps(p.output, "/entry/data/minus"),
          *phase = maps(p.output, "/entry/truth/phase");
    const double half = (65535 - 64) / 2.0; /* counts at intensity 1 */
    for (int i = 0; i < SIDE * SIDE; i++) {
        const int x = i % SIDE, y = i / SIDE, c = 2 * (y % 2) + x % 2;
        /* Sony's cell: 90 45, 135 0 degrees; plus is polarised along 0. */
        const double a = c == 3 ? 1 : c == 0 ? 0 : 0.5, b = 1 - a;
        /* Shot noise is 1.5 counts, six of it; rounding half a count. */
        assert_near((double)flow[i], 64 + half * (a * (double)plus[i] + b * (double)minus[i]), 9.5);
        assert_near((double)still[i], 64 + half, 9.5);
        assert_true(dark[i] == 64);
    }
    for (int i = 0; i < SIDE * SIDE / 4; i++) {
        const float *cell = phase + 2 * (i % (SIDE / 2)) + 2 * (i / (SIDE / 2)) * SIDE;
        assert_near((double)truth[i],
                    ((double)cell[0] + (double)cell[1] + (double)cell[SIDE] + (double)cell[SIDE + 1]) / 4, 1e-7);
    }
    free(flow), free(still), free(dark), free(truth), free(plus), free(minus), free(phase);
}

static void the_rigs_of_a_camera_say_what_is_known_and_what_is_true(void **state) {
    (void)state;
    const ptie_camera_params camera = faulty();
    ptie_simulate_params p = small(support_temporary("lab.npy"));
    ptie_rig known, truth;
    p.camera = &camera, p.rig = support_temporary("lab.ini");
    p.reference_frames = p.dark_frames = p.target_frames = 1;
    simulate(&p, 2);
    assert_ok(ptie_rig_read(&known, p.rig));
    assert_ok(ptie_rig_read(&truth, support_temporary("lab_true.ini")));
    assert_int_equal(known.layout, PTIE_LAYOUT_MOSAIC);
    assert_string_equal(known.reference, support_temporary("lab_reference.npy"));
    assert_string_equal(known.dark, support_temporary("lab_dark.npy"));
    assert_true(known.plane[PTIE_PLUS].mix[3] == 1 && known.plane[PTIE_MINUS].mix[0] == 1);
    assert_true(known.plane[PTIE_MINUS].gain == 1 && known.plane[PTIE_MINUS].shift_x_px == 0);
    assert_true(known.saturation_counts == 4095 && known.read_noise_electrons == 20 && known.mask_below > 0);
    assert_near(truth.plane[PTIE_MINUS].gain, 1.25, 1e-12);
    assert_true(truth.plane[PTIE_MINUS].shift_x_px == 0.75 && truth.plane[PTIE_MINUS].magnification == 1.01 &&
                truth.plane[PTIE_MINUS].rotation_rad == 4e-3);
    /* Channels of plus and minus alone come back as planes: 1 of the own, 0 of the other. */
    const double *plus = truth.plane[PTIE_PLUS].mix, *minus = truth.plane[PTIE_MINUS].mix;
    assert_near(plus[3] * 1 + plus[0] * 0.9 / 40, 1, 1e-9);
    assert_near(plus[3] / 40 + plus[0] * 0.9, 0, 1e-9);
    assert_near(minus[3] / 40 + minus[0] * 0.9, 1, 1e-9);
    assert_near(minus[3] * 1 + minus[0] * 0.9 / 40, 0, 1e-9);
}

static void separate_sensors_are_data_sets_of_one_file(void **state) {
    (void)state;
    ptie_camera_params camera;
    ptie_camera_params_init(&camera);
    ptie_simulate_params p = small(support_temporary("two.h5"));
    ptie_rig rig;
    p.camera = &camera, p.rig = support_temporary("two.ini"), p.noise = 9; /* not used */
    simulate(&p, 2);
    assert_ok(ptie_rig_read(&rig, p.rig));
    assert_int_equal(rig.layout, PTIE_LAYOUT_SEPARATE);
    float *plus = maps(p.output, rig.plane[PTIE_PLUS].source), *minus = maps(p.output, rig.plane[PTIE_MINUS].source);
    for (int i = 0; i < FRAMES * SIDE * SIDE; i++)
        assert_true(plus[i] >= 0 && plus[i] <= 4095 && plus[i] == rintf(plus[i]) && minus[i] == rintf(minus[i]));
    free(plus), free(minus);
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
    ptie_camera_params camera;
    ptie_camera_params_init(&camera);
    p.output = "jet.npy", p.camera = &camera;
    assert_fails(ptie_simulate(ctx, &p, (ptie_progress){0}), PTIE_EINVAL, "jet.npy: cannot write two planes");
    camera.bits = 7;
    assert_fails(ptie_simulate(ctx, &p, (ptie_progress){0}), PTIE_EINVAL, "bits is out of range");
    camera.bits = 12, camera.layout = PTIE_CAMERA_MOSAIC, p.output = support_temporary("other.npy");
    support_write(support_temporary("other_dark.npy"), "mine", 4), p.overwrite = false;
    assert_fails(ptie_simulate(ctx, &p, (ptie_progress){0}), PTIE_EEXIST, "other_dark.npy");
    p.camera = NULL, p.overwrite = true;
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
        cmocka_unit_test(a_camera_writes_the_same_bytes_with_any_threads),
        cmocka_unit_test(a_camera_records_flow_reference_dark_and_truth),
        cmocka_unit_test(the_rigs_of_a_camera_say_what_is_known_and_what_is_true),
        cmocka_unit_test(separate_sensors_are_data_sets_of_one_file),
        cmocka_unit_test(failures_leave_no_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
