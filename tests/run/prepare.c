/* SPDX-License-Identifier: BSD-3-Clause */
/* Planes after every step, against what the recordings were made of. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include <ptie/prepare.h>
#include <ptie/recording.h>

#include "rig/prepare.h"

enum { WIDTH = 64, HEIGHT = 48, PIXELS = WIDTH * HEIGHT, W = WIDTH / 2, H = HEIGHT / 2 };

/* Light without flow, its change by the flow, and the dark level: all different from pixel to
 * pixel. */
static double still_light(int y, int x) {
    return 1000 + 200 * cos(0.3 * x) + 100 * sin(0.2 * y);
}

static double flow(int y, int x) {
    return 1 + 0.1 * cos(0.11 * x) * cos(0.07 * y);
}

static double dark_level(int y, int x) {
    return 64 + (7 * x + 3 * y) % 5;
}

static void write_frames(const char *name, const float *frames, int count, int width, int height) {
    ptie_writer *writer;
    const ptie_recording_info info = {.width_px = width, .height_px = height, .frames = count};
    assert_ok(ptie_writer_create(&writer, support_temporary(name), "intensity", &info, true));
    for (int t = 0; t < count; t++)
        assert_ok(ptie_writer_append(writer, frames + (ptrdiff_t)t * width * height));
    assert_ok(ptie_writer_close(writer));
}

/* Two frames each, whose mean is the level. */
static void write_stills(void) {
    static float dark[2][PIXELS], still[2][PIXELS];
    for (int i = 0; i < PIXELS; i++) {
        const double d = dark_level(i / WIDTH, i % WIDTH),
                     s = d + still_light(i / WIDTH, i % WIDTH);
        dark[0][i] = (float)(d - 1), dark[1][i] = (float)(d + 1);
        still[0][i] = (float)(s - 1), still[1][i] = (float)(s + 1);
    }
    write_frames("dark.npy", dark[0], 2, WIDTH, HEIGHT);
    write_frames("still.npy", still[0], 2, WIDTH, HEIGHT);
}

static void write_flow(void) {
    static float frames[3][PIXELS];
    for (int t = 0; t < 3; t++)
        for (int i = 0; i < PIXELS; i++) {
            const int y = i / WIDTH, x = i % WIDTH;
            frames[t][i] = (float)(dark_level(y, x) + still_light(y, x) * flow(y, x) + t);
        }
    write_frames("flow.npy", frames[0], 3, WIDTH, HEIGHT);
}

static ptie_rig rig_of(ptie_layout layout) {
    ptie_rig rig;
    ptie_rig_init(&rig);
    rig.pixel_m = 20e-6;
    rig.layout = layout;
    rig.demosaic = PTIE_DEMOSAIC_NONE;
    rig.angle_deg[1] = 45, rig.angle_deg[2] = 135, rig.angle_deg[3] = 90;
    rig.plane[PTIE_PLUS].mix[0] = 1;
    rig.plane[PTIE_MINUS]
        .mix[layout == PTIE_LAYOUT_MOSAIC || layout == PTIE_LAYOUT_QUADRANTS ? 3 : 1] = 1;
    rig.flat_field = rig.match_gain = false;
    return rig;
}

static ptie_status prepare(const ptie_rig *rig, ptie_step until) {
    static char output[256], input[256];
    ptie_ctx *ctx;
    ptie_prepare_params params;
    ptie_prepare_params_init(&params);
    snprintf(input, sizeof input, "%s", support_temporary("flow.npy"));
    snprintf(output, sizeof output, "%s", support_temporary("planes.h5"));
    params.rig = rig;
    params.recording = input;
    params.output = output;
    params.until = until;
    params.overwrite = true;
    assert_ok(ptie_ctx_create(&ctx, NULL));
    ptie_status status = ptie_prepare_planes(ctx, &params, (ptie_progress){0});
    ptie_ctx_free(ctx);
    return status;
}

/* Frame t of one map of planes.h5. */
static void read_map(float *map, const char *name, int t, int width, int height) {
    char path[320];
    ptie_recording *recording;
    snprintf(path, sizeof path, "%s:/entry/data/%s", support_temporary("planes.h5"), name);
    assert_ok(ptie_recording_open(&recording, path));
    assert_int_equal(ptie_recording_get_info(recording)->width_px, width);
    assert_int_equal(ptie_recording_get_info(recording)->height_px, height);
    assert_int_equal(ptie_recording_get_info(recording)->frames, 3);
    assert_ok(ptie_recording_read(recording, t, map));
    ptie_recording_close(recording);
}

/* Where channel c of a layout has its pixel (y, x). */
static void on_sensor(ptie_layout layout, int c, int y, int x, int *sensor_y, int *sensor_x) {
    switch (layout) {
    case PTIE_LAYOUT_MOSAIC: *sensor_y = 2 * y + c / 2, *sensor_x = 2 * x + c % 2; return;
    case PTIE_LAYOUT_SIDE_BY_SIDE: *sensor_y = y, *sensor_x = x + c * W; return;
    case PTIE_LAYOUT_TOP_BOTTOM: *sensor_y = y + c * H, *sensor_x = x; return;
    default: *sensor_y = y + c / 2 * H, *sensor_x = x + c % 2 * W; return;
    }
}

static void every_layout_is_split_and_mixed(void **state) {
    (void)state;
    static const struct {
        ptie_layout layout;
        int width, height, last;
        const char *first_name, *last_name;
    } cases[] = {{PTIE_LAYOUT_MOSAIC, W, H, 3, "0", "90"},
                 {PTIE_LAYOUT_SIDE_BY_SIDE, W, HEIGHT, 1, "left", "right"},
                 {PTIE_LAYOUT_TOP_BOTTOM, WIDTH, H, 1, "top", "bottom"},
                 {PTIE_LAYOUT_QUADRANTS, W, H, 3, "tl", "br"}};
    static float map[4][PIXELS], dark[PIXELS];
    for (size_t k = 0; k < 4; k++) {
        const int width = cases[k].width, height = cases[k].height, last = cases[k].last;
        ptie_rig rig = rig_of(cases[k].layout);
        rig.plane[PTIE_MINUS].mix[0] = -0.25;
        snprintf(rig.dark, sizeof rig.dark, "%s", support_temporary("dark.npy"));
        assert_ok(prepare(&rig, PTIE_STEP_DARK));
        read_map(dark, "image", 1, WIDTH, HEIGHT);
        assert_ok(prepare(&rig, PTIE_STEP_SPLIT));
        read_map(map[0], cases[k].first_name, 1, width, height);
        read_map(map[1], cases[k].last_name, 1, width, height);
        assert_ok(prepare(&rig, PTIE_STEP_MIX));
        read_map(map[2], "plus", 1, width, height);
        read_map(map[3], "minus", 1, width, height);
        for (int i = 0; i < width * height; i++) {
            int y, x;
            on_sensor(cases[k].layout, last, i / width, i % width, &y, &x);
            /* Counts of up to 1500 in f32: 6e-5 each, of the frame and of the dark. */
            assert_near((double)dark[y * WIDTH + x], still_light(y, x) * flow(y, x) + 1, 2e-4);
            assert_true(map[1][i] == dark[y * WIDTH + x]);
            assert_true(map[3][i] == map[1][i] - 0.25F * map[0][i]);
            assert_true(map[2][i] == map[0][i]);
        }
    }
}

static double mean_of(const float *map, int count) {
    double sum = 0;
    for (int i = 0; i < count; i++) sum += (double)map[i];
    return sum / count;
}

static void flat_fields_and_gains(void **state) {
    (void)state;
    static float plus[PIXELS], minus[PIXELS], again[PIXELS];
    ptie_rig rig = rig_of(PTIE_LAYOUT_TOP_BOTTOM);
    snprintf(rig.dark, sizeof rig.dark, "%s", support_temporary("dark.npy"));
    snprintf(rig.reference, sizeof rig.reference, "%s", support_temporary("still.npy"));
    rig.flat_field = true;
    rig.plane[PTIE_MINUS].gain = 1.5;
    assert_ok(prepare(&rig, PTIE_STEP_FLAT));
    read_map(plus, "plus", 0, WIDTH, H);
    read_map(minus, "minus", 0, WIDTH, H);
    /* Frame over reference times the reference's mean: the light's structure is gone. */
    double mean[2] = {0};
    for (int i = 0; i < PIXELS; i++)
        mean[i / WIDTH / H] += still_light(i / WIDTH, i % WIDTH) / (WIDTH * H);
    for (int i = 0; i < WIDTH * H; i++) {
        assert_near((double)plus[i], flow(i / WIDTH, i % WIDTH) * mean[0], 1e-3);
        assert_near((double)minus[i], flow(i / WIDTH + H, i % WIDTH) * mean[1], 1e-3);
    }
    assert_ok(prepare(&rig, PTIE_STEP_GAIN));
    read_map(again, "minus", 0, WIDTH, H);
    for (int i = 0; i < WIDTH * H; i++) assert_true(again[i] == 1.5F * minus[i]);
    rig.match_gain = true;
    assert_ok(prepare(&rig, PTIE_STEP_GAIN));
    read_map(plus, "plus", 2, WIDTH, H);
    read_map(minus, "minus", 2, WIDTH, H);
    assert_near(mean_of(plus, WIDTH * H) / mean_of(minus, WIDTH * H), 1, 1e-6);
}

/* A plane that lies 3 pixels to the right and 2 up is found there: whole pixels are not
 * interpolated. */
static void registration_moves_planes_to_the_grid(void **state) {
    (void)state;
    enum { DX = 3, DY = -2 };
    static float sensor[3][PIXELS], minus[PIXELS];
    for (int t = 0; t < 3; t++)
        for (int i = 0; i < PIXELS; i++) {
            const int y = i / WIDTH, x = i % WIDTH;
            sensor[t][i] = (float)(x < W ? flow(y, x) : flow(y - DY, x - W - DX));
        }
    write_frames("flow.npy", sensor[0], 3, WIDTH, HEIGHT);
    ptie_rig rig = rig_of(PTIE_LAYOUT_SIDE_BY_SIDE);
    rig.plane[PTIE_MINUS].shift_x_px = DX;
    rig.plane[PTIE_MINUS].shift_y_px = DY;
    assert_ok(prepare(&rig, PTIE_STEP_REGISTRATION));
    read_map(minus, "minus", 0, W, HEIGHT);
    for (int y = -DY; y < HEIGHT; y++)
        for (int x = 0; x < W - DX; x++)
            assert_near((double)minus[y * W + x], flow(y, x),
                        2e-6); /* rounding of the splines' filter, near 1 */
    write_flow();
}

static void masks_fill_and_bin(void **state) {
    (void)state;
    static float opaque[PIXELS], plus[PIXELS], minus[PIXELS];
    ptie_rig rig = rig_of(PTIE_LAYOUT_SIDE_BY_SIDE);
    for (int i = 0; i < W * HEIGHT; i++) opaque[i] = i % W < 5 && i / W < 10 ? 0 : 1;
    write_frames("mask.npy", opaque, 1, W, HEIGHT);
    snprintf(rig.mask, sizeof rig.mask, "%s", support_temporary("mask.npy"));
    rig.binning = 2;
    rig.match_gain = true;
    assert_ok(prepare(&rig, PTIE_STEP_MASK));
    read_map(plus, "plus", 0, W / 2, HEIGHT / 2);
    read_map(minus, "minus", 0, W / 2, HEIGHT / 2);
    for (int y = 0; y < 5; y++)
        for (int x = 0; x < 2; x++) {
            /* Light from around, not the opaque pixels' own. */
            assert_true(plus[y * (W / 2) + x] > 500 && plus[y * (W / 2) + x] < 2000);
            assert_true(isfinite(minus[y * (W / 2) + x]));
        }
    ptie_source *source;
    ptie_prepare *plan;
    char recording[256];
    snprintf(recording, sizeof recording, "%s", support_temporary("flow.npy"));
    assert_ok(ptie_source_open(&source, &(ptie_run_params){.rig = &rig, .recording = recording}));
    assert_ok(ptie_prepare_create(&plan, source, &rig));
    const uint8_t *mask = ptie_prepare_mask(plan);
    for (int y = 0; y < HEIGHT / 2; y++) /* a bin with an opaque pixel is opaque */
        for (int x = 0; x < W / 2; x++) assert_int_equal(mask[y * (W / 2) + x], !(x < 3 && y < 5));
    assert_null(ptie_prepare_seen(plan));
    ptie_prepare_free(plan);
    ptie_source_close(source);
}

/* One plane comes with its reference, at the same step. */
static void one_plane_brings_its_reference(void **state) {
    (void)state;
    static float plus[PIXELS], zero[PIXELS];
    ptie_rig rig = rig_of(PTIE_LAYOUT_MOSAIC);
    rig.one_plane = true;
    rig.plane[PTIE_MINUS].used = false;
    assert_fails(prepare(&rig, PTIE_STEP_MASK), PTIE_EINVAL, "no-flow reference is missing");
    snprintf(rig.dark, sizeof rig.dark, "%s", support_temporary("dark.npy"));
    snprintf(rig.reference, sizeof rig.reference, "%s", support_temporary("still.npy"));
    assert_ok(prepare(&rig, PTIE_STEP_MASK));
    read_map(plus, "plus", 0, W, H);
    read_map(zero, "zero", 0, W, H);
    for (int i = 0; i < W * H; i++) {
        const int y = 2 * (i / W), x = 2 * (i % W);
        assert_near((double)zero[i], still_light(y, x), 2e-4);
        assert_near((double)plus[i], still_light(y, x) * flow(y, x), 2e-4);
    }
}

static void what_does_not_fit_is_refused(void **state) {
    (void)state;
    static const float small[16] = {1};
    ptie_rig rig = rig_of(PTIE_LAYOUT_TOP_BOTTOM);
    write_frames("small.npy", small, 1, 4, 4);
    snprintf(rig.dark, sizeof rig.dark, "%s", support_temporary("small.npy"));
    assert_fails(prepare(&rig, PTIE_STEP_MASK), PTIE_ESIZE,
                 "small.npy: frame size differs from ");
    rig.dark[0] = 0;
    snprintf(rig.mask, sizeof rig.mask, "%s", support_temporary("small.npy"));
    assert_fails(prepare(&rig, PTIE_STEP_MASK), PTIE_ESIZE,
                 "small.npy: mask differs from the planes in size");
    snprintf(rig.mask, sizeof rig.mask, "%s", support_temporary("none.npy"));
    assert_fails(prepare(&rig, PTIE_STEP_MASK), PTIE_EIO, "none.npy");
    rig.mask[0] = 0;
    rig.binning = 40;
    assert_fails(prepare(&rig, PTIE_STEP_MASK), PTIE_ESIZE, "frame too small to bin 40 x 40");
}

static int setup(void **state) {
    (void)state;
    write_stills();
    write_flow();
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_layout_is_split_and_mixed),
        cmocka_unit_test(flat_fields_and_gains),
        cmocka_unit_test(registration_moves_planes_to_the_grid),
        cmocka_unit_test(masks_fill_and_bin),
        cmocka_unit_test(one_plane_brings_its_reference),
        cmocka_unit_test(what_does_not_fit_is_refused),
    };
    return cmocka_run_group_tests_name("prepare", tests, setup, NULL);
}
