/* SPDX-License-Identifier: BSD-3-Clause */
/* What is not flow comes off the phase: the median of still frames, a surface, the level of a
 * region. */
#include "support/support.h"

#include <math.h>

#include <ptie/ptie.h>

enum { SIDE = 64, PIXELS = SIDE * SIDE, FRAMES = 6, STILL = 3 };

static const double pi = 3.14159265358979323846;

/* dI/dz of a phase is a sum of cosines, which the mirror boundary's solver takes back exactly. */
static double background(int y, int x) {
    return cos(pi * (x + 0.5) / SIDE) + 0.5 * cos(2 * pi * (y + 0.5) / SIDE);
}

static double flow(int y, int x) {
    return cos(4 * pi * (x + 0.5) / SIDE) * cos(6 * pi * (y + 0.5) / SIDE);
}

static void write_plane(const char *name, int sign) {
    ptie_writer *writer;
    float frame[PIXELS];
    const ptie_recording_info info = {.width_px = SIDE, .height_px = SIDE, .frames = FRAMES};
    assert_ok(ptie_writer_create(&writer, support_temporary(name), "intensity", &info, true));
    for (int t = 0; t < FRAMES; t++) {
        for (int i = 0; i < PIXELS; i++) {
            const int y = i / SIDE, x = i % SIDE;
            frame[i] = (float)(1000 * (1 + sign * (0.001 * background(y, x) +
                                                   (t < STILL ? 0 : 0.02 * flow(y, x)))));
        }
        assert_ok(ptie_writer_append(writer, frame));
    }
    assert_ok(ptie_writer_close(writer));
}

static ptie_status run(const ptie_rig *rig, float phase[FRAMES][PIXELS]) {
    char plus[256], minus[256], output[256];
    ptie_ctx *ctx;
    ptie_run_params p;
    ptie_run_summary summary;
    ptie_recording *recording;
    snprintf(plus, sizeof plus, "%s", support_temporary("plus.npy"));
    snprintf(minus, sizeof minus, "%s", support_temporary("minus.npy"));
    snprintf(output, sizeof output, "%s", support_temporary("phase.h5"));
    ptie_run_params_init(&p);
    p.rig = rig;
    p.plane[PTIE_PLUS] = plus, p.plane[PTIE_MINUS] = minus;
    p.output = output;
    p.overwrite = true;
    assert_ok(ptie_ctx_create(&ctx, NULL));
    ptie_status status = ptie_run(ctx, &p, &summary, (ptie_progress){0});
    ptie_ctx_free(ctx);
    if (status != PTIE_OK) return status;
    assert_ok(ptie_recording_open(&recording, output));
    for (int t = 0; t < FRAMES; t++) assert_ok(ptie_recording_read(recording, t, phase[t]));
    ptie_recording_close(recording);
    return status;
}

static ptie_rig plain_rig(void) {
    ptie_rig rig;
    ptie_rig_init(&rig);
    rig.pixel_m = 20e-6;
    rig.match_gain = rig.zero_border = false;
    return rig;
}

static double largest(const float *map) {
    double most = 0;
    for (int i = 0; i < PIXELS; i++) most = fmax(most, fabs((double)map[i]));
    return most;
}

static void still_frames_are_the_background(void **state) {
    (void)state;
    static float with[FRAMES][PIXELS], without[FRAMES][PIXELS];
    ptie_rig rig = plain_rig();
    assert_ok(run(&rig, with));
    const double amplitude = largest(with[0]);
    assert_true(amplitude > 0.1);
    rig.still_end = STILL;
    assert_ok(run(&rig, without));
    /* The median of equal maps is that map: nothing is left, to the bit. */
    for (int t = 0; t < STILL; t++) assert_true(largest(without[t]) == 0);
    for (int t = STILL; t < FRAMES; t++)
        for (int i = 0; i < PIXELS; i++) assert_true(without[t][i] == with[t][i] - with[0][i]);
    rig.still_end = FRAMES + 1;
    assert_fails(run(&rig, with), PTIE_EINVAL,
                 "still_frames leave the recording (expected some of 0:6, found 0:7)");
}

static void a_region_without_flow_is_zero(void **state) {
    (void)state;
    static float phase[FRAMES][PIXELS];
    ptie_rig rig = plain_rig();
    rig.still = (ptie_rect){4, 8, 16, 10};
    assert_ok(run(&rig, phase));
    double sum = 0;
    for (int y = 8; y < 18; y++)
        for (int x = 4; x < 20; x++) sum += (double)phase[FRAMES - 1][y * SIDE + x];
    assert_near(sum / 160, 0,
                1e-6 * largest(phase[FRAMES - 1])); /* f32 of the map, eight times over */
    rig.still.width_px = SIDE;
    assert_fails(run(&rig, phase), PTIE_EINVAL,
                 "[flow] still leaves the phase (expected a part of 64 x 64 px");
}

/* The background here is a tilted cosine: a plane takes most of it, Zernike polynomials nearly all.
 */
static void surfaces_take_off_what_is_smooth(void **state) {
    (void)state;
    static float plain[FRAMES][PIXELS], plane[FRAMES][PIXELS], zernike[FRAMES][PIXELS];
    ptie_rig rig = plain_rig();
    assert_ok(run(&rig, plain));
    rig.background = PTIE_BACKGROUND_PLANE;
    assert_ok(run(&rig, plane));
    rig.background = PTIE_BACKGROUND_ZERNIKE;
    assert_ok(run(&rig, zernike));
    assert_true(largest(plane[0]) < 0.6 * largest(plain[0]));
    assert_true(largest(zernike[0]) < 0.15 * largest(plain[0]));
}

static int setup(void **state) {
    (void)state;
    write_plane("plus.npy", -1);
    write_plane("minus.npy", 1);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(still_frames_are_the_background),
        cmocka_unit_test(a_region_without_flow_is_zero),
        cmocka_unit_test(surfaces_take_off_what_is_smooth),
    };
    return cmocka_run_group_tests_name("background", tests, setup, NULL);
}
