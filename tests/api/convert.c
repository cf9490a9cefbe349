/* SPDX-License-Identifier: BSD-3-Clause */
/* Recordings as other recordings: what is kept, compression whatever the threads, stops and refusals. */
#include "support/files.h"

#include <math.h>
#include <stdlib.h>

#include <ptie/convert.h>

enum { W = 40, H = 24, FRAMES = 7, PIXELS = W * H };

/* 12-bit counts, never two frames alike. */
static float count_at(int t, int i) {
    return (float)(((unsigned)i * 2654435761u >> 7) % 4000 + (unsigned)t);
}

/* A camera's recording; `sample` "u12": counts, "f32": thousandths of them. */
static const char *write_recording(const char *name, const char *sample) {
    const char *path = support_temporary(name);
    float frame[PIXELS];
    ptie_writer *writer;
    ptie_recording_info info = {.width_px = W,
                                .height_px = H,
                                .frames = FRAMES,
                                .unit = "counts",
                                .frame_rate_hz = 1000,
                                .pixel_m = 1e-5,
                                .camera = "a camera",
                                .date = "today",
                                .exposure_s = 1e-6,
                                .bit_depth = 12,
                                .black_level = 64,
                                .roi_x_px = 3,
                                .roi_y_px = 8};
    snprintf(info.sample, sizeof info.sample, "%s", sample);
    assert_ok(ptie_writer_create(&writer, path, "raw", &info, true));
    for (int t = 0; t < FRAMES; t++) {
        for (int i = 0; i < PIXELS; i++)
            frame[i] = sample[0] == 'f' ? count_at(t, i) / 1000 : count_at(t, i);
        assert_ok(ptie_writer_append(writer, frame));
    }
    assert_ok(ptie_writer_close(writer));
    return path;
}

static ptie_ctx *context(int32_t threads) {
    ptie_ctx_params params;
    ptie_ctx *ctx;
    ptie_ctx_params_init(&params);
    params.threads = threads;
    assert_ok(ptie_ctx_create(&ctx, &params));
    return ctx;
}

static ptie_convert_params request(const char *input, const char *output) {
    ptie_convert_params params;
    ptie_convert_params_init(&params);
    params.input = input;
    params.output = output;
    return params;
}

static ptie_status convert(const ptie_convert_params *params) {
    ptie_ctx *ctx = context(1);
    ptie_status status = ptie_convert(ctx, params, (ptie_progress){0});
    ptie_ctx_free(ctx);
    return status;
}

/* A crop moves the corner on the sensor, and with it the phase of a mosaic. */
static void what_the_camera_said_is_kept(void **state) {
    (void)state;
    const char *path = support_temporary("kept.h5");
    ptie_convert_params params = request(write_recording("raw.h5", "u12"), path);
    ptie_recording *recording;
    float frame[PIXELS];
    params.frames = (ptie_frame_range){1, 6, 2};
    params.roi = (ptie_rect){5, 2, 10, 20};
    params.compress = true;
    assert_ok(convert(&params));
    assert_ok(ptie_recording_open(&recording, path));
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    assert_string_equal(info->dataset, "/entry/data/raw");
    assert_string_equal(info->sample, "u16");
    assert_string_equal(info->unit, "counts");
    assert_string_equal(info->camera, "a camera");
    assert_string_equal(info->date, "today");
    assert_int_equal(info->bit_depth, 12);
    assert_int_equal(info->roi_x_px, 8);
    assert_int_equal(info->roi_y_px, 10);
    assert_int_equal(info->first_frame, 1);
    assert_int_equal(info->frame_step, 2);
    assert_true(info->exposure_s == 1e-6 && info->black_level == 64 && info->white_level == 0);
    assert_near(info->frame_rate_hz, 500, 500 * 0x1p-50);
    assert_near(info->pixel_m, 1e-5, 0);
    for (int t = 0; t < 3; t++) {
        assert_ok(ptie_recording_read(recording, t, frame));
        for (int y = 0; y < 20; y++)
            for (int x = 0; x < 10; x++)
                assert_true(frame[10 * y + x] == count_at(1 + 2 * t, W * (y + 2) + x + 5));
    }
    ptie_recording_close(recording);
}

/* Threads and blocks of frames (7 frames on 3 threads) leave no trace in the file; HDF5 unpacks what we pack. */
static void compression_does_not_depend_on_threads(void **state) {
    (void)state;
    static const char *const samples[] = {"u12", "f32"};
    for (int k = 0; k < 2; k++) {
        const char *input = write_recording("in.npy", samples[k]), *path = support_temporary("packed.h5");
        ptie_convert_params params = request(input, path);
        unsigned char *first = NULL;
        size_t bytes, first_bytes = 0;
        params.compress = true;
        params.overwrite = true;
        for (int32_t threads = 1; threads <= 3; threads++) {
            ptie_ctx *ctx = context(threads);
            assert_ok(ptie_convert(ctx, &params, (ptie_progress){0}));
            ptie_ctx_free(ctx);
            unsigned char *data = support_read(path, &bytes);
            if (!first) first = data, first_bytes = bytes;
            assert_int_equal(bytes, first_bytes);
            assert_memory_equal(data, first, bytes);
            if (data != first) free(data);
        }
        free(first);
        support_python("import h5py, numpy as np, sys\n"
                       "d = h5py.File(sys.argv[1])['entry/data/data']\n"
                       "assert d.compression == 'gzip' and d.compression_opts == 1 and d.shuffle\n"
                       "assert d.chunks == (1, 24, 40)\n"
                       "a = np.load(sys.argv[1].replace('packed.h5', 'in.npy'))\n"
                       "assert d.dtype == a.dtype and (d[()] == a).all()\n",
                       path);
    }
}

/* The tool for full disks keeps `path` alone. */
static char large_input[1100];

static ptie_status convert_packed(const char *path) {
    ptie_convert_params params = request(large_input, path);
    params.compress = true;
    params.overwrite = true;
    return convert(&params);
}

static void a_full_disk_is_reported(void **state) {
    (void)state;
    snprintf(large_input, sizeof large_input, "%s", write_recording("in.npy", "f32"));
    const char *path = support_temporary("full.h5");
    support_check_full_disk(path, convert_packed);
}

static int stop_after_two(void *user, uint64_t done, uint64_t total, const char *note) {
    (void)user, (void)total, (void)note;
    return done == 2;
}

static void a_stopped_conversion_leaves_nothing(void **state) {
    (void)state;
    static const char *const outputs[] = {"s.h5", "s.tif", "s.npy", "s.mat", "s.y4m", "s.mraw", "s_%d.png"};
    const char *input = write_recording("in.npy", "u12");
    ptie_ctx *ctx = context(2);
    for (size_t i = 0; i < 7; i++) {
        const char *path = support_temporary(outputs[i]);
        ptie_convert_params params = request(input, path);
        params.compress = true;
        assert_fails(ptie_convert(ctx, &params, (ptie_progress){stop_after_two, NULL}), PTIE_ECANCELLED, "");
        support_assert_nothing_left(i == 6 ? support_temporary("s_0.png") : path);
    }
    ptie_ctx_free(ctx);
}

/* A frame that cannot be read in the middle: NaN. */
static void a_failed_conversion_leaves_nothing(void **state) {
    (void)state;
    size_t bytes;
    const char *input = write_recording("in.npy", "f32"), *path = support_temporary("failed.h5");
    unsigned char *data = support_read(input, &bytes);
    const float hole = (float)NAN;
    memcpy(data + 128 + (4 * PIXELS + 45) * sizeof hole, &hole, sizeof hole);
    support_write(input, data, bytes);
    free(data);
    const ptie_convert_params params = request(input, path);
    assert_fails(convert(&params), PTIE_ENUMERIC, "in.npy: frame 4");
    support_assert_nothing_left(path);
}

static void arguments_are_checked(void **state) {
    (void)state;
    const char *path = support_temporary("out.h5");
    const ptie_convert_params good = request(write_recording("in.npy", "u12"), path);
    ptie_convert_params bad = good;
    assert_fails(ptie_convert(NULL, &good, (ptie_progress){0}), PTIE_EINVAL, "ctx");
    bad.input = NULL;
    assert_fails(convert(&bad), PTIE_EINVAL, "input");
    bad = good, bad.output = NULL;
    assert_fails(convert(&bad), PTIE_EINVAL, "output");
    bad = good, bad.output = good.input;
    assert_fails(convert(&bad), PTIE_EINVAL, "would be written over");
    bad = good, bad.name = "a/b";
    assert_fails(convert(&bad), PTIE_EINVAL, "name");
    bad = good, bad.frames.step = 0;
    assert_fails(convert(&bad), PTIE_EINVAL, "frames.step");
    bad = good, bad.frames.first = FRAMES;
    assert_fails(convert(&bad), PTIE_EINVAL, "expected 0..6, found 7");
    bad = good, bad.frames.end = FRAMES + 1;
    assert_fails(convert(&bad), PTIE_EINVAL, "expected 1..7, found 8");
    bad = good, bad.roi = (ptie_rect){W - 1, 0, 2, 1};
    assert_fails(convert(&bad), PTIE_EINVAL, "found 39,0,2,1");
    bad = good, bad.roi = (ptie_rect){0, 0, 0, 1};
    assert_fails(convert(&bad), PTIE_EINVAL, "found 0,0,0,1");
    bad = good, bad.low = 1;
    assert_fails(convert(&bad), PTIE_EINVAL, "high");
    bad = good, bad.played_hz = 0;
    assert_fails(convert(&bad), PTIE_EINVAL, "played_hz");
    bad = good, bad.colours = (ptie_colormap)3;
    assert_fails(convert(&bad), PTIE_EINVAL, "colours");
    support_assert_nothing_left(path);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_the_camera_said_is_kept),
        cmocka_unit_test(compression_does_not_depend_on_threads),
        cmocka_unit_test(a_full_disk_is_reported),
        cmocka_unit_test(a_stopped_conversion_leaves_nothing),
        cmocka_unit_test(a_failed_conversion_leaves_nothing),
        cmocka_unit_test(arguments_are_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
