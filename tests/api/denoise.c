/* SPDX-License-Identifier: BSD-3-Clause */
/* Recordings of phase through a model: frame by frame what the denoiser does, whatever the threads.
 */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include <ptie/run.h>

enum { WIDTH = 40, HEIGHT = 24, FRAMES = 7, PIXELS = WIDTH * HEIGHT };

static float phase[FRAMES][PIXELS];

static const char *write_frames(int frames) {
    const char *path = support_temporary("phase.npy");
    ptie_recording_info info = {.width_px = WIDTH, .height_px = HEIGHT, .frames = frames};
    ptie_writer *writer;
    for (int t = 0; t < FRAMES; t++)
        for (int i = 0; i < PIXELS; i++)
            phase[t][i] = (float)(sin(0.3 * (i % WIDTH) + t) * exp(-0.01 * (i / WIDTH)) - 0.2);
    assert_ok(ptie_writer_create(&writer, path, "phase", &info, true));
    for (int t = 0; t < frames; t++) assert_ok(ptie_writer_append(writer, phase[t]));
    assert_ok(ptie_writer_close(writer));
    return path;
}

static const char *write_phase(void) {
    return write_frames(FRAMES);
}

static ptie_model *small_model(void) {
    ptie_model_params params;
    ptie_model *model;
    ptie_model_params_init(&params);
    params.levels = 2;
    params.width[0] = params.width[1] = 3;
    assert_ok(ptie_model_create(&model, &params));
    return model;
}

static ptie_ctx *context(int32_t threads) {
    ptie_ctx_params params;
    ptie_ctx *ctx;
    ptie_ctx_params_init(&params);
    params.threads = threads;
    assert_ok(ptie_ctx_create(&ctx, &params));
    return ctx;
}

static ptie_denoise_params request(const ptie_model *model, const char *input, const char *output) {
    ptie_denoise_params params;
    ptie_denoise_params_init(&params);
    params.model = model;
    params.input = input;
    params.output = output;
    return params;
}

static void frames_are_those_of_the_denoiser(void **state) {
    (void)state;
    ptie_model *model = small_model();
    const char *input = write_phase();
    static float expected[PIXELS], found[PIXELS];
    for (int32_t threads = 1; threads <= 3; threads += 2) {
        const char *output = support_temporary(threads == 1 ? "one.tif" : "three.h5");
        ptie_ctx *ctx = context(threads);
        ptie_denoise_params params = request(model, input, output);
        params.polarity = -1;
        assert_ok(ptie_denoise(ctx, &params, (ptie_progress){0}));

        ptie_denoiser *denoiser;
        ptie_recording *recording;
        assert_ok(ptie_denoiser_create(&denoiser, ctx, model, WIDTH, HEIGHT, NULL));
        void *scratch = ptie_scratch_alloc(ptie_denoiser_scratch_bytes(denoiser));
        assert_ok(ptie_recording_open(&recording, output));
        assert_int_equal(ptie_recording_get_info(recording)->frames, FRAMES);
        assert_string_equal(ptie_recording_get_info(recording)->unit, "rad");
        for (int t = 0; t < FRAMES; t++) {
            assert_ok(ptie_denoiser_run_rad(denoiser, expected, phase[t], -1, scratch));
            assert_ok(ptie_recording_read(recording, t, found));
            assert_memory_equal(found, expected, sizeof found);
        }
        ptie_recording_close(recording);
        ptie_scratch_free(scratch);
        ptie_denoiser_free(denoiser);
        ptie_ctx_free(ctx);
    }
    ptie_model_free(model);
}

/* Which takes all threads, and may be fast. */
static void a_single_frame_is_that_of_the_denoiser(void **state) {
    (void)state;
    ptie_model *model = small_model();
    const char *input = write_frames(1), *output = support_temporary("single.npy");
    static float expected[PIXELS], found[PIXELS];
    for (int fast = 0; fast < 2; fast++) {
        ptie_ctx *ctx = context(3);
        ptie_denoise_params params = request(model, input, output);
        params.polarity = 1;
        params.fast = fast;
        params.overwrite = true;
        assert_ok(ptie_denoise(ctx, &params, (ptie_progress){0}));

        ptie_denoiser *denoiser;
        ptie_recording *recording;
        ptie_denoiser_params how;
        ptie_denoiser_params_init(&how);
        how.fast = fast;
        assert_ok(ptie_denoiser_create(&denoiser, ctx, model, WIDTH, HEIGHT, &how));
        void *scratch = ptie_scratch_alloc(ptie_denoiser_scratch_bytes(denoiser));
        assert_ok(ptie_denoiser_run_rad(denoiser, expected, phase[0], 1, scratch));
        assert_ok(ptie_recording_open(&recording, output));
        assert_ok(ptie_recording_read(recording, 0, found));
        assert_memory_equal(found, expected, sizeof found);
        ptie_recording_close(recording);
        ptie_scratch_free(scratch);
        ptie_denoiser_free(denoiser);
        ptie_ctx_free(ctx);
    }
    ptie_model_free(model);
}

static int stop_after_two(void *user, uint64_t done, uint64_t total, const char *note) {
    (void)user, (void)total, (void)note;
    return done >= 2;
}

static void failures_leave_no_file(void **state) {
    (void)state;
    ptie_model *model = small_model();
    ptie_ctx *ctx = context(1);
    const char *output = support_temporary("never.h5");
    ptie_denoise_params params = request(model, write_phase(), output);
    assert_fails(ptie_denoise(ctx, &params, (ptie_progress){stop_after_two, NULL}), PTIE_ECANCELLED,
                 "cancelled");
    params.polarity = 2;
    assert_fails(ptie_denoise(ctx, &params, (ptie_progress){0}), PTIE_EINVAL, "polarity");
    params = request(model, support_temporary("nothere.npy"), output);
    assert_fails(ptie_denoise(ctx, &params, (ptie_progress){0}), PTIE_EIO, "nothere.npy");
    params = request(NULL, "phase.npy", output);
    assert_fails(ptie_denoise(ctx, &params, (ptie_progress){0}), PTIE_EINVAL, "model");
    assert_false(support_exists(output));
    ptie_ctx_free(ctx);
    ptie_model_free(model);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_are_those_of_the_denoiser),
        cmocka_unit_test(a_single_frame_is_that_of_the_denoiser),
        cmocka_unit_test(failures_leave_no_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
