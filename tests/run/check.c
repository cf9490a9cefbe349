/* SPDX-License-Identifier: BSD-3-Clause */
/* Checks and calibrations of rigs, on recordings of a simulated camera whose faults are known. */
#include "support/support.h"

#include <math.h>

#include <ptie/rig.h>
#include <ptie/simulate.h>

enum { SIDE = 256 };

static const char *file(const char *name) {
    static char paths[4][256];
    static int next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s", support_temporary(name));
    return path;
}

/* cam.mraw and what belongs to it: a mosaic whose minus plane is darker, shifted, larger and
 * turned. */
static int setup(void **state) {
    (void)state;
    ptie_ctx *ctx;
    ptie_camera_params camera;
    ptie_simulate_params p;
    ptie_camera_params_init(&camera);
    ptie_simulate_params_init(&p);
    camera.layout = PTIE_CAMERA_MOSAIC;
    camera.minus_gain = 0.9;
    camera.minus_shift_x_px = 1.6, camera.minus_shift_y_px = -2.4;
    camera.minus_magnification = 1.004;
    camera.minus_rotation_rad = 3e-3;
    p.flow.morphology = "jet";
    p.flow.width_px = p.flow.height_px = SIDE;
    p.amplitude_rad = 0.2;
    p.propagation = PTIE_ANGULAR_SPECTRUM;
    p.boundary = PTIE_MIRROR;
    p.frames = 4;
    p.camera = &camera;
    p.reference_frames = p.dark_frames = p.target_frames = 8;
    p.output = file("cam.mraw");
    p.rig = file("cam.ini");
    assert_ok(ptie_ctx_create(&ctx, NULL));
    assert_ok(ptie_simulate(ctx, &p, (ptie_progress){0}));
    ptie_ctx_free(ctx);
    return 0;
}

static ptie_rig load(const char *name) {
    ptie_rig rig;
    assert_ok(ptie_rig_load(&rig, file(name)));
    return rig;
}

static void calibration_finds_where_the_planes_lie(void **state) {
    (void)state;
    ptie_plane_calibration found[PTIE_ROLES];
    const ptie_rig rig = load("cam.ini"), truth = load("cam_true.ini");
    const ptie_plane *minus = &truth.plane[PTIE_MINUS];
    assert_ok(ptie_rig_calibrate(found, &rig, file("cam_target.mraw"), NULL));
    const ptie_plane_calibration *c = &found[PTIE_MINUS];
    assert_true(c->measured && !found[PTIE_PLUS].measured && !found[PTIE_ZERO].measured);
    const ptie_similarity *p = &c->where.place, *d = &c->where.deviation;
    /* Within four of its own standard deviations, which are small enough to be of use: a tenth of a
       pixel at the corner. */
    assert_near(p->shift_x_px, minus->shift_x_px, 4 * d->shift_x_px);
    assert_near(p->shift_y_px, minus->shift_y_px, 4 * d->shift_y_px);
    assert_near(p->magnification, minus->magnification, 4 * d->magnification);
    assert_near(p->rotation_rad, minus->rotation_rad, 4 * d->rotation_rad);
    assert_true(d->shift_x_px < 0.05 && d->shift_y_px < 0.05 && d->magnification < 5e-4 &&
                d->rotation_rad < 5e-4);
    assert_near(c->gain, minus->gain, 0.01);
}

static const ptie_rig_finding *find(const ptie_rig_report *report, const char *name) {
    for (int32_t i = 0; i < report->count; i++)
        if (strcmp(report->finding[i].name, name) == 0) return &report->finding[i];
    fail_msg("no finding '%s'", name);
    return NULL;
}

static ptie_rig_report check(const ptie_rig *rig) {
    ptie_rig_report report;
    assert_ok(ptie_rig_check(rig, file("cam.mraw"), NULL, file("cam_target.mraw"), &report));
    assert_true(report.count > 0 && report.count <= PTIE_RIG_FINDINGS);
    return report;
}

static void a_right_rig_is_found_right(void **state) {
    (void)state;
    const ptie_rig rig = load("cam_true.ini");
    const ptie_rig_report report = check(&rig);
    static const char *const good[] = {
        "size",       "saturation",   "exposure", "mosaic", "means of planes",
        "flat field", "registration", "noise"};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++)
        assert_int_equal(find(&report, good[i])->verdict, PTIE_GOOD);
    /* Shot and read noise of the mean light, in electrons: 20 % for a median instead of a variance,
       and for light that is not even. */
    const double electrons =
        find(&report, "exposure")->value * rig.saturation_counts * rig.electrons_per_count;
    const double sigma =
        sqrt(electrons + rig.read_noise_electrons * rig.read_noise_electrons) / electrons;
    /* Bilinear de-mosaicking averages four neighbours with 1/16, 3/16, 3/16, 9/16: noise times
     * 0.625. */
    assert_near(find(&report, "noise")->value / (0.625 * sigma), 1, 0.2);
    /* 40 um pixels, 10 mm, 532 nm: pi lambda z / (80 um)^2. */
    assert_near(find(&report, "linear TIE")->value, 3.14159265 * 532e-9 * 10e-3 / 6.4e-9, 1e-3);
    assert_int_equal(find(&report, "linear TIE")->verdict, PTIE_DOUBTFUL);
}

static void what_is_wrong_is_found(void **state) {
    (void)state;
    ptie_rig rig = load("cam_true.ini");
    rig.plane[PTIE_MINUS].shift_x_px += 3;
    rig.saturation_counts = 500;
    rig.match_gain = false;
    rig.plane[PTIE_MINUS].gain *= 1.2;
    rig.plane[PTIE_PLUS].defocus_m = 0.5e-3, rig.plane[PTIE_MINUS].defocus_m = -0.5e-3;
    ptie_rig_report report = check(&rig);
    assert_int_equal(find(&report, "registration")->verdict, PTIE_WRONG);
    assert_near(find(&report, "registration")->value, 3, 0.2);
    assert_int_equal(find(&report, "saturation")->verdict, PTIE_WRONG);
    assert_int_equal(find(&report, "means of planes")->verdict, PTIE_WRONG);
    assert_int_equal(find(&report, "linear TIE")->verdict, PTIE_GOOD);
    rig = load("cam.ini");
    snprintf(rig.reference, sizeof rig.reference, "%s", file("cam_dark.mraw"));
    rig.dark[0] = 0;
    report = check(&rig);
    assert_int_equal(find(&report, "flat field")->verdict, PTIE_WRONG);
    rig = load("cam.ini");
    rig.reference[0] = 0;
    assert_ok(ptie_rig_check(&rig, file("cam.mraw"), NULL, NULL, &report));
    assert_int_equal(find(&report, "flat field")->verdict, PTIE_DOUBTFUL);
    assert_int_equal(find(&report, "registration")->verdict, PTIE_DOUBTFUL);
    assert_true(isnan(find(&report, "registration")->value));
}

static void one_plane_has_no_registration(void **state) {
    (void)state;
    ptie_rig rig = load("cam.ini");
    ptie_plane_calibration found[PTIE_ROLES];
    ptie_rig_report report;
    rig.one_plane = true;
    rig.plane[PTIE_MINUS].used = false;
    assert_fails(ptie_rig_calibrate(found, &rig, file("cam_target.mraw"), NULL), PTIE_EINVAL,
                 "one plane");
    assert_ok(ptie_rig_check(&rig, file("cam.mraw"), NULL, NULL, &report));
    for (int32_t i = 0; i < report.count; i++)
        assert_true(strcmp(report.finding[i].name, "registration") != 0);
    assert_fails(ptie_rig_check(&rig, file("none.mraw"), NULL, NULL, &report), PTIE_EIO,
                 "none.mraw");
    assert_fails(ptie_rig_check(&rig, NULL, NULL, NULL, &report), PTIE_EINVAL,
                 "recording is missing");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(calibration_finds_where_the_planes_lie),
        cmocka_unit_test(a_right_rig_is_found_right),
        cmocka_unit_test(what_is_wrong_is_found),
        cmocka_unit_test(one_plane_has_no_registration),
    };
    return cmocka_run_group_tests_name("check", tests, setup, NULL);
}
