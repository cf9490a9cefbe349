/* SPDX-License-Identifier: BSD-3-Clause */
/* Inference through the public API: any size, any scratch, radians. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include <ptie/model.h>

#include "base/random.h"
#include "nn/model.h"

typedef struct fixture {
    ptie_ctx *ctx;
    ptie_model *model;
} fixture;

static fixture open_fixture(int32_t levels) {
    ptie_model_params params;
    fixture f;
    ptie_model_params_init(&params);
    params.levels = levels;
    for (int32_t i = 0; i < levels; i++) params.width[i] = 4 + i;
    assert_ok(ptie_ctx_create(&f.ctx, NULL));
    assert_ok(ptie_model_create(&f.model, &params));
    return f;
}

static void close_fixture(fixture *f) {
    ptie_model_free(f->model);
    ptie_ctx_free(f->ctx);
}

static float *random_image(int32_t count, double low, double high) {
    float *image = malloc((size_t)count * sizeof *image);
    ptie_random random;
    ptie_random_init(&random, 8, PTIE_STREAM_FLOW, (uint64_t)count);
    for (int32_t i = 0; i < count; i++) image[i] = (float)ptie_random_uniform(&random, low, high);
    return image;
}

/* Runs with scratch memory full of NaN: nothing may be taken over from it. */
static float *denoise(const fixture *f, const float *noisy, int32_t width, int32_t height) {
    ptie_denoiser *denoiser;
    assert_ok(ptie_denoiser_create(&denoiser, f->ctx, f->model, width, height));
    size_t bytes = ptie_denoiser_scratch_bytes(denoiser);
    void *scratch = ptie_scratch_alloc(bytes);
    memset(scratch, 0xff, bytes);
    float *clean = malloc((size_t)(width * height) * sizeof *clean);
    assert_ok(ptie_denoiser_run(denoiser, clean, noisy, scratch));
    ptie_scratch_free(scratch);
    ptie_denoiser_free(denoiser);
    return clean;
}

static int32_t mirrored(int32_t i, int32_t n) {
    while (i < 0 || i >= n) i = n == 1 ? 0 : i < 0 ? -i : 2 * (n - 1) - i;
    return i;
}

/* A frame of any size gives what its continuation by reflection gives, cropped. */
static void check_size(const fixture *f, int32_t width, int32_t height) {
    const int32_t unit = 1 << (ptie_model_get_params(f->model)->levels - 1);
    const int32_t full_width = (width + unit - 1) / unit * unit,
                  full_height = (height + unit - 1) / unit * unit;
    float *noisy = random_image(width * height, 0, 1);
    float *padded = malloc((size_t)(full_width * full_height) * sizeof *padded);
    for (int32_t i = 0; i < full_width * full_height; i++)
        padded[i] =
            noisy[mirrored(i / full_width, height) * width + mirrored(i % full_width, width)];
    float *clean = denoise(f, noisy, width, height),
          *full = denoise(f, padded, full_width, full_height);
    for (int32_t i = 0; i < width * height; i++) {
        float expected = full[i / width * full_width + i % width];
        assert_memory_equal(&clean[i], &expected, sizeof expected);
        assert_true(clean[i] >= 0 && clean[i] <= 1); /* also refuses NaN */
    }
    free(noisy), free(padded), free(clean), free(full);
}

static void any_size_is_reflected_and_cropped(void **state) {
    (void)state;
    fixture f = open_fixture(4);
    for (int32_t width = 1; width <= 19; width++)
        for (int32_t height = 1; height <= 10; height += 3) check_size(&f, width, height);
    check_size(&f, 131, 65);
    close_fixture(&f);
}

static void runs_do_not_know_each_other(void **state) {
    (void)state;
    enum { WIDTH = 37, HEIGHT = 22, COUNT = WIDTH * HEIGHT };
    fixture f = open_fixture(3);
    float *a = random_image(COUNT, 0, 1), *b = random_image(COUNT + 1, 0, 1);
    float *first = denoise(&f, a, WIDTH, HEIGHT), *second = denoise(&f, b, WIDTH, HEIGHT);
    ptie_denoiser *denoiser;
    assert_ok(ptie_denoiser_create(&denoiser, f.ctx, f.model, WIDTH, HEIGHT));
    void *scratch = ptie_scratch_alloc(ptie_denoiser_scratch_bytes(denoiser));
    float clean[COUNT];
    assert_ok(ptie_denoiser_run(denoiser, clean, b, scratch)); /* the other order, one scratch */
    assert_memory_equal(clean, second, sizeof clean);
    assert_ok(ptie_denoiser_run(denoiser, clean, a, scratch));
    assert_memory_equal(clean, first, sizeof clean);
    memcpy(clean, a, sizeof clean); /* in place */
    assert_ok(ptie_denoiser_run(denoiser, clean, clean, scratch));
    assert_memory_equal(clean, first, sizeof clean);

    a[5] = NAN;
    assert_fails(ptie_denoiser_run(denoiser, clean, a, scratch), PTIE_ENUMERIC, "noisy");
    assert_fails(ptie_denoiser_run_rad(denoiser, clean, a, 1, scratch), PTIE_ENUMERIC, "noisy_rad");
    assert_fails(ptie_denoiser_run(denoiser, clean, b, NULL), PTIE_EINVAL, "scratch is missing");
    assert_fails(ptie_denoiser_run_rad(denoiser, clean, b, 2, scratch), PTIE_EINVAL, "polarity");
    ptie_scratch_free(scratch);
    ptie_denoiser_free(denoiser);
    free(a), free(b), free(first), free(second);
    close_fixture(&f);
}

/* A network that hands its input through: deltas along the skip of the first level. */
static ptie_model *make_identity(void) {
    ptie_model_params params;
    ptie_model *model;
    ptie_model_params_init(&params);
    params = (ptie_model_params){.struct_size = params.struct_size,
                                 .levels = 2,
                                 .width = {1, 1},
                                 .in_channels = 1,
                                 .output = PTIE_LINEAR,
                                 .bn_epsilon = 1e-3,
                                 .bn_momentum = 0.99};
    assert_ok(ptie_model_create(&model, &params));
    const ptie_graph *graph = &model->graph;
    static const char *const stages[] = {"enc1", "dec1"};
    for (int32_t i = 0; i < graph->param_count; i++) {
        const ptie_param *param = &graph->params[i];
        if (strstr(param->name, "running_var")) model->values[param->offset] = (float)(1 - 1e-3);
        if (strstr(param->name, "conv") || strstr(param->name, "out"))
            memset(model->values + param->offset, 0, param->count * sizeof(float));
    }
    for (int stage = 0; stage < 2; stage++)
        for (int number = 1; number <= 2; number++) {
            char name[40];
            snprintf(name, sizeof name, "%s.conv%d.weight", stages[stage], number);
            const ptie_param *param = ptie_graph_find(graph, name);
            model->values[param->offset + 9 * (size_t)(param->shape[1] - 1) + 4] =
                1; /* centre, last input */
        }
    model->values[ptie_graph_find(graph, "out.weight")->offset] = 1;
    return model;
}

enum { SIZE = 40, COUNT = SIZE * SIZE };

static void denoise_frame(const ptie_model *model, float *clean, const float *noisy, int32_t width,
                          int32_t height, int32_t polarity) {
    ptie_ctx *ctx;
    ptie_denoiser *denoiser;
    assert_ok(ptie_ctx_create(&ctx, NULL));
    assert_ok(ptie_denoiser_create(&denoiser, ctx, model, width, height));
    void *scratch = ptie_scratch_alloc(ptie_denoiser_scratch_bytes(denoiser));
    assert_ok(ptie_denoiser_run_rad(denoiser, clean, noisy, polarity, scratch));
    ptie_scratch_free(scratch);
    ptie_denoiser_free(denoiser);
    ptie_ctx_free(ctx);
}

static void denoise_rad(const ptie_model *model, float *clean, const float *noisy,
                        int32_t polarity) {
    denoise_frame(model, clean, noisy, SIZE, SIZE, polarity);
}

/* A jet of 5 rad over a background of `level`, 40 % of the frame. */
static void make_jet(float *phase, float level, float sign) {
    for (int i = 0; i < COUNT; i++) {
        int y = i / SIZE, x = i % SIZE;
        bool inside = y >= 12 && y < 28;
        phase[i] =
            level + sign * (inside ? 5 * sinf((float)(y - 12) * 0.2f) * (1 + 0.01f * (float)x) : 0);
    }
}

/* What a network changes nothing of comes back in rad, with the background at 0.  The level is
   found to 1/4096 of the range (here 7), single precision adds 1e-6 of it. */
static void radians_come_back_through_the_identity(void **state) {
    (void)state;
    ptie_model *model = make_identity();
    float noisy[COUNT], clean[COUNT], expected[COUNT];
    for (int sign = -1; sign <= 1; sign += 2) {
        make_jet(noisy, -3, (float)sign);
        make_jet(expected, 0, (float)sign);
        for (int asked = 0; asked <= 1; asked++) { /* told, and found by the skewness */
            denoise_rad(model, clean, noisy, asked ? sign : 0);
            for (int i = 0; i < COUNT; i++)
                assert_near((double)clean[i], (double)expected[i], 7 * (1 / 4096.0 + 2e-6));
        }
        denoise_rad(model, noisy, noisy, sign); /* in place */
        assert_memory_equal(noisy, clean, sizeof clean);
    }
    ptie_model_free(model);
}

/* A single column or row has slopes along itself. */
static void lines_of_pixels_come_back(void **state) {
    (void)state;
    ptie_model *model = make_identity();
    float noisy[COUNT], line[SIZE], clean[SIZE];
    make_jet(noisy, -3, 1);
    for (int i = 0; i < SIZE; i++) line[i] = noisy[i * SIZE];
    for (int column = 0; column <= 1; column++) {
        denoise_frame(model, clean, line, column ? 1 : SIZE, column ? SIZE : 1, 1);
        for (int i = 0; i < SIZE; i++)
            assert_near((double)clean[i], (double)line[i] + 3, 7 * (1 / 4096.0 + 2e-6));
    }
    ptie_model_free(model);
}

/* Of any network: a gain and an offset of the input are a gain of the output. */
static void gain_and_offset_pass_through(void **state) {
    (void)state;
    fixture f = open_fixture(3);
    float *noisy = random_image(COUNT, -1, 2), scaled[COUNT], clean[COUNT], again[COUNT];
    denoise_rad(f.model, clean, noisy, 1);
    for (int i = 0; i < COUNT; i++) scaled[i] = 4 * noisy[i] + 8;
    denoise_rad(f.model, again, scaled, 1);
    for (int i = 0; i < COUNT; i++) again[i] /= 4;
    /* The input of the network is rounded differently: 1e-7 of it, which the fit of the gain keeps.
     */
    assert_near(support_relative_error(again, clean, COUNT), 0, 1e-4);
    for (int i = 0; i < COUNT; i++) scaled[i] = -noisy[i];
    denoise_rad(f.model, again, scaled, -1);
    for (int i = 0; i < COUNT; i++) again[i] = -again[i];
    assert_memory_equal(again, clean, sizeof clean); /* turning over is exact */
    free(noisy);
    close_fixture(&f);
}

static void a_constant_map_has_no_flow(void **state) {
    (void)state;
    fixture f = open_fixture(2);
    float noisy[COUNT], clean[COUNT];
    for (int i = 0; i < COUNT; i++) noisy[i] = 7;
    denoise_rad(f.model, clean, noisy, 0);
    for (int i = 0; i < COUNT; i++) assert_true(clean[i] == 0);
    close_fixture(&f);
}

static void wrong_requests_are_refused(void **state) {
    (void)state;
    fixture f = open_fixture(2);
    ptie_denoiser *denoiser;
    ptie_model_params params;
    ptie_model *stereo;
    assert_fails(ptie_denoiser_create(&denoiser, f.ctx, f.model, 0, 5), PTIE_EINVAL, "width_px");
    assert_null(denoiser);
    assert_fails(ptie_denoiser_create(&denoiser, f.ctx, f.model, 5, 40000), PTIE_EINVAL,
                 "height_px");
    assert_fails(ptie_denoiser_create(&denoiser, f.ctx, NULL, 5, 5), PTIE_EINVAL,
                 "model is missing");
    ptie_model_params_init(&params);
    params.in_channels = 2;
    assert_ok(ptie_model_create(&stereo, &params));
    assert_fails(ptie_denoiser_create(&denoiser, f.ctx, stereo, 5, 5), PTIE_ESIZE,
                 "expected 1 channel, found 2");
    ptie_model_free(stereo);
    ptie_denoiser_free(NULL);
    close_fixture(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_size_is_reflected_and_cropped),
        cmocka_unit_test(runs_do_not_know_each_other),
        cmocka_unit_test(radians_come_back_through_the_identity),
        cmocka_unit_test(lines_of_pixels_come_back),
        cmocka_unit_test(gain_and_offset_pass_through),
        cmocka_unit_test(a_constant_map_has_no_flow),
        cmocka_unit_test(wrong_requests_are_refused),
    };
    return cmocka_run_group_tests_name("denoiser", tests, NULL, NULL);
}
