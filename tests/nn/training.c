/* SPDX-License-Identifier: BSD-3-Clause */
/* The training step: derivatives by finite differences for members of the family that the golden
 * values do not cover, and results that do not depend on threads.
 */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/random.h"
#include "nn/loss.h"
#include "nn/model.h"
#include "nn/stepper.h"

static const ptie_loss_weights paper_weights = {0.5, 0.4, 0.1};

static ptie_model_params family(int32_t levels, const int32_t *widths) {
    ptie_model_params params;
    ptie_model_params_init(&params);
    params.levels = levels;
    for (int32_t i = 0; i < levels; i++) params.width[i] = widths[i];
    params.seed = 5;
    return params;
}

/* Smooth clean maps in [0, 1] and noisy inputs. */
static void fill_samples(ptie_stepper *stepper, int32_t batch, int32_t channels, int32_t height,
                         int32_t width) {
    ptie_random random;
    ptie_random_init(&random, 1, PTIE_STREAM_FLOW, 0);
    for (int32_t n = 0; n < batch; n++) {
        float *noisy = ptie_stepper_noisy(stepper, n, false), *clean = ptie_stepper_clean(stepper, n, false);
        for (int32_t i = 0; i < height * width; i++)
            clean[i] =
                (float)(0.5 + 0.4 * sin(0.2 * (i % width) + n) * cos(0.3 * (double)(i / width)));
        for (int32_t i = 0; i < channels * height * width; i++)
            noisy[i] = clean[i % (height * width)] + 0.2f * (float)ptie_random_normal(&random);
    }
}

static double mean_loss(ptie_stepper *stepper, int32_t batch) {
    ptie_loss_parts parts[8];
    double sum = 0;
    assert_ok(ptie_stepper_gradients(stepper, batch, 9, 4, parts, NULL));
    for (int32_t n = 0; n < batch; n++) sum += parts[n].loss;
    return sum / batch;
}

/* Slope of the loss along `direction` (of unit length, `count` values from `first`), by central
   differences, the mean over four steps around h. */
static double slope_along(ptie_stepper *stepper, int32_t batch, float *first,
                          const double *direction, size_t count, double h) {
    static const double steps[] = {0.6, 0.8, 1, 1.25};
    float *start = malloc(count * sizeof *start);
    double slope = 0;
    memcpy(start, first, count * sizeof *start);
    for (int i = 0; i < 8; i++) {
        const double step = h * steps[i / 2], side = i % 2 ? 1 : -1;
        for (size_t k = 0; k < count; k++)
            first[k] = (float)((double)start[k] + side * step * direction[k]);
        slope += side * mean_loss(stepper, batch) / (2 * step) / 4;
    }
    memcpy(first, start, count * sizeof *start);
    free(start);
    return slope;
}

static double normalise(double *direction, size_t count) {
    double length = 0;
    for (size_t k = 0; k < count; k++) length += direction[k] * direction[k];
    length = sqrt(length);
    for (size_t k = 0; k < count; k++) direction[k] /= length;
    return length;
}

/* The slope along a gradient must be the gradient's length.  Larger steps open ReLUs on the way and
   bend the loss, smaller ones drown in its rounding, 1e-7, which step and length divide: the step
   makes that 3 % of one difference for a short gradient, less for a long one.  Off by 9e-3, 1.2e-2
   and 8.1e-2 at worst for long, middling and short gradients, over all tensors, members and kernel
   levels; the bounds are twice that at least. */
static void check_slope(ptie_stepper *stepper, int32_t batch, float *values, const double *gradient,
                        size_t count, const char *name) {
    double *direction = malloc(count * sizeof *direction);
    memcpy(direction, gradient, count * sizeof *direction);
    const double length = normalise(direction, count);
    const double h = length < 3e-2 ? 3e-6 / length : length < 0.5 ? 1e-4 : 3e-5;
    const double slope = slope_along(stepper, batch, values, direction, count, h);
    free(direction);
    const double off = slope / length - 1, bound = length > 0.5 ? 2e-2 : length > 0.1 ? 4e-2 : 0.2;
    if (fabs(off) <= bound) return; /* false for NaN */
    fail_msg("%s: gradient of length %.2e: slope off by %.1e of it, bound %.1e", name, length, off,
             bound);
}

/* Tensor by tensor, and all of them together. */
static void check_slopes(const ptie_model_params *params, int32_t height, int32_t width) {
    enum { BATCH = 2 };
    ptie_engine engine;
    ptie_model *model;
    ptie_stepper *stepper;
    assert_ok(ptie_engine_start(&engine, 2, "auto"));
    assert_ok(ptie_nn_create(&model, params));
    assert_ok(ptie_stepper_create(&stepper, &engine, model, BATCH, width, height, paper_weights));
    fill_samples(stepper, BATCH, params->in_channels, height, width);
    mean_loss(stepper, BATCH);
    const ptie_graph *graph = &model->graph;
    double *gradient = calloc(graph->trainable, sizeof *gradient);
    for (int32_t i = 0; i < graph->param_count; i++) {
        const ptie_param *param = &graph->params[i];
        size_t count;
        const float *own = ptie_stepper_state(stepper, 0, param->name, &count);
        assert_true(param->trainable == (own != NULL));
        for (size_t k = 0; own && k < count; k++) gradient[param->offset + k] = (double)own[k];
    }
    for (int32_t i = 0; i < graph->param_count; i++) {
        const ptie_param *param = &graph->params[i];
        if (param->trainable)
            check_slope(stepper, BATCH, model->values + param->offset, gradient + param->offset,
                        param->count, param->name);
    }
    check_slope(stepper, BATCH, model->values, gradient, graph->trainable, "all");
    free(gradient);
    ptie_stepper_free(stepper);
    ptie_nn_free(model);
    ptie_engine_stop(&engine);
}

static void gradients_are_slopes_of_the_loss(void **state) {
    (void)state;
    ptie_model_params params = family(2, (int32_t[]){3, 5});
    params.dropout = 0;
    check_slopes(&params, 14, 22);
    params = family(4, (int32_t[]){4, 7, 9, 10});
    params.dropout = 0.3; /* the same seed and step draw the same mask */
    params.in_channels = 3;
    check_slopes(&params, 24, 40);
    params = family(3, (int32_t[]){8, 16, 32});
    params.output = PTIE_LINEAR;
    check_slopes(&params, 36, 20);
    params = family(5, (int32_t[]){4, 6, 8, 12, 16}); /* deep */
    check_slopes(&params, 32, 48);
    params = family(3, (int32_t[]){14, 18, 24}); /* not multiples of 4 */
    check_slopes(&params, 24, 28);
}

/* SSIM by its definition (Wang et al. 2004), one window at a time, in double. */
static double loss_by_definition(const double *x, const float *y, int32_t width, int32_t height) {
    double weights[11][11], total = 0, ssim = 0, l1 = 0, wmse = 0;
    for (int i = 0; i < 121; i++) {
        double v = i / 11 - 5, u = i % 11 - 5;
        total += weights[i / 11][i % 11] = exp(-(u * u + v * v) / 4.5);
    }
    for (int32_t top = 0; top + 11 <= height; top++)
        for (int32_t left = 0; left + 11 <= width; left++) {
            double mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
            for (int i = 0; i < 121; i++) {
                double w = weights[i / 11][i % 11] / total;
                int32_t at = (top + i / 11) * width + left + i % 11;
                mx += w * x[at];
                my += w * (double)y[at];
            }
            for (int i = 0; i < 121; i++) {
                double w = weights[i / 11][i % 11] / total;
                int32_t at = (top + i / 11) * width + left + i % 11;
                xx += w * (x[at] - mx) * (x[at] - mx);
                yy += w * ((double)y[at] - my) * ((double)y[at] - my);
                xy += w * (x[at] - mx) * ((double)y[at] - my);
            }
            ssim += (2 * mx * my + 1e-4) * (2 * xy + 9e-4) /
                    ((mx * mx + my * my + 1e-4) * (xx + yy + 9e-4));
        }
    ssim /= (height - 10) * (width - 10);
    for (int32_t i = 0; i < height * width; i++) {
        double d = x[i] - (double)y[i];
        l1 += fabs(d) / (height * width);
        wmse += (1 + 4 * (double)y[i]) * d * d / (height * width);
    }
    return 0.5 * l1 + 0.4 * (1 - ssim) + 0.1 * wmse;
}

static void loss_gradient_is_the_derivative(void **state) {
    (void)state;
    enum { HEIGHT = 17, WIDTH = 23, COUNT = HEIGHT * WIDTH };
    float estimate[COUNT], clean[COUNT], gradient[COUNT];
    double x[COUNT];
    ptie_random random;
    ptie_random_init(&random, 2, PTIE_STREAM_FLOW, 0);
    for (int i = 0; i < COUNT; i++) {
        clean[i] = (float)ptie_random_uniform(&random, 0, 1);
        estimate[i] = clean[i] + (float)ptie_random_uniform(&random, -0.3, 0.3);
        x[i] = (double)estimate[i];
    }
    void *scratch = ptie_scratch_alloc(ptie_loss_scratch(WIDTH, HEIGHT));
    for (int level = 0; level <= (int)ptie_cpu_detect(); level++) {
        ptie_loss_parts parts;
        ptie_loss_evaluate(ptie_kernels_of((ptie_cpu_level)level), &parts, gradient, estimate,
                           clean, WIDTH, HEIGHT, paper_weights, 1, scratch);
        /* Variances come from differences of means of squares: 1e-7 of the squares, against C2 =
         * 9e-4. */
        assert_near(parts.loss, loss_by_definition(x, clean, WIDTH, HEIGHT), 2e-6);
        const double h = 1e-6; /* truncation 1e-12, rounding 1e-10, of gradients around 1e-3 */
        for (int i = 0; i < COUNT; i += 5) {
            x[i] = (double)estimate[i] + h;
            double above = loss_by_definition(x, clean, WIDTH, HEIGHT);
            x[i] = (double)estimate[i] - h;
            double below = loss_by_definition(x, clean, WIDTH, HEIGHT);
            x[i] = (double)estimate[i];
            assert_near((double)gradient[i], (above - below) / (2 * h), 2e-8);
        }
    }
    ptie_scratch_free(scratch);
}

static void equal_images_have_ssim_one_and_no_loss(void **state) {
    (void)state;
    float image[16 * 16];
    for (int i = 0; i < 256; i++) image[i] = (float)(i * 37 % 256) / 255;
    void *scratch = ptie_scratch_alloc(ptie_loss_scratch(16, 16));
    ptie_engine engine;
    ptie_loss_parts parts;
    assert_ok(ptie_engine_start(&engine, 1, "auto"));
    ptie_loss_measure(&engine, &parts, image, image, 16, 16, paper_weights, scratch);
    assert_near(parts.ssim, 1, 1e-6);
    assert_near(parts.loss, 0, 1e-6);
    assert_true(parts.l1 == 0 && parts.mse == 0 && parts.wmse == 0);
    ptie_engine_stop(&engine);
    ptie_scratch_free(scratch);
}

enum { BATCH = 5, SIZE = 24 };

/* Three steps with `threads`; the model's values, all of them, are the result. */
static float *train(int32_t threads, size_t *count) {
    const ptie_adamw adamw = {1e-3, 0.9, 0.999, 1e-7, 0.004};
    ptie_model_params params = family(3, (int32_t[]){5, 8, 12});
    ptie_engine engine;
    ptie_model *model;
    ptie_stepper *stepper;
    ptie_loss_parts parts[BATCH];
    assert_ok(ptie_engine_start(&engine, threads, "auto"));
    assert_ok(ptie_nn_create(&model, &params));
    assert_ok(ptie_stepper_create(&stepper, &engine, model, BATCH, SIZE, SIZE, paper_weights));
    fill_samples(stepper, BATCH, 1, SIZE, SIZE);
    for (uint64_t step = 1; step <= 3; step++) {
        assert_ok(ptie_stepper_gradients(stepper, BATCH, 1, step, parts, NULL));
        ptie_stepper_update(stepper, &adamw, step);
    }
    *count = model->graph.values;
    float *values = malloc(*count * sizeof *values);
    memcpy(values, model->values, *count * sizeof *values);
    ptie_stepper_free(stepper);
    ptie_nn_free(model);
    ptie_engine_stop(&engine);
    return values;
}

static void threads_do_not_change_a_bit(void **state) {
    (void)state;
    size_t count;
    float *one = train(1, &count);
    for (int32_t threads = 2; threads <= 7; threads = threads == 3 ? 7 : threads + 1) {
        float *many = train(threads, &count);
        assert_memory_equal(one, many, count * sizeof *one);
        free(many);
    }
    free(one);
}

/* A batch may be shorter than the stepper's; then it is what a shorter stepper makes of it. */
static void a_short_batch_ignores_the_rest(void **state) {
    (void)state;
    ptie_model_params params = family(2, (int32_t[]){3, 4});
    ptie_engine engine;
    ptie_loss_parts parts[2][BATCH];
    float gradients[2][3 * 9];
    assert_ok(ptie_engine_start(&engine, 2, "auto"));
    for (int run = 0; run < 2; run++) {
        ptie_model *model;
        ptie_stepper *stepper;
        size_t count;
        assert_ok(ptie_nn_create(&model, &params));
        assert_ok(ptie_stepper_create(&stepper, &engine, model, run ? 3 : BATCH, SIZE, SIZE,
                                      paper_weights));
        fill_samples(stepper, run ? 3 : BATCH, 1, SIZE, SIZE);
        assert_ok(ptie_stepper_gradients(stepper, 3, 0, 1, parts[run], NULL));
        memcpy(gradients[run], ptie_stepper_state(stepper, 0, "enc1.conv1.weight", &count),
               sizeof gradients[run]);
        ptie_stepper_free(stepper);
        ptie_nn_free(model);
    }
    assert_memory_equal(parts[0], parts[1], 3 * sizeof parts[0][0]);
    assert_memory_equal(gradients[0], gradients[1], sizeof gradients[0]);
    ptie_engine_stop(&engine);
}

static void sizes_that_do_not_fit_are_named(void **state) {
    (void)state;
    ptie_model_params params = family(3, (int32_t[]){2, 2, 2});
    ptie_engine engine;
    ptie_model *model;
    ptie_stepper *stepper;
    assert_ok(ptie_engine_start(&engine, 1, "auto"));
    assert_ok(ptie_nn_create(&model, &params));
    assert_fails(ptie_stepper_create(&stepper, &engine, model, 1, 30, 32, paper_weights),
                 PTIE_ESIZE, "expected multiples of 4 from 11 on, found 30 x 32");
    assert_null(stepper);
    assert_fails(ptie_stepper_create(&stepper, &engine, model, 1, 8, 32, paper_weights), PTIE_ESIZE,
                 "8 x 32");
    ptie_nn_free(model);
    ptie_engine_stop(&engine);
}

/* On ones: 0 or 1/(1-p), so that the mean stays, with a share p of zeros; other masks for other
   samples and steps. */
static void dropout_masks_a_share_and_keeps_the_mean(void **state) {
    (void)state;
    enum { SIDE = 64, CHANNELS = 8, VALUES = SIDE * SIDE * CHANNELS };
    ptie_model_params params = family(2, (int32_t[]){4, 6});
    ptie_model *model;
    params.dropout = 0.3;
    assert_ok(ptie_nn_create(&model, &params));
    ptie_stepper stepper = {.model = model, .seed = 7, .step = 1};
    ptie_map map = ptie_map_make(CHANNELS, SIDE, SIDE);
    float *block = ptie_alloc(ptie_map_floats(&map), sizeof(float));
    float *ones = ptie_alloc(VALUES, sizeof(float));
    float *mask[3];
    map = ptie_map_in(map, block);
    for (int i = 0; i < VALUES; i++) ones[i] = 1;
    for (int k = 0; k < 3; k++) { /* sample 0, sample 1, sample 0 of the next step */
        mask[k] = ptie_alloc(VALUES, sizeof(float));
        stepper.step = k == 2 ? 2 : 1;
        ptie_map_load(&map, ones);
        ptie_dropout(&stepper, &map, k == 1);
        ptie_map_store(mask[k], &map);
        int zeros = 0;
        for (int i = 0; i < VALUES; i++) {
            assert_true(mask[k][i] == 0 || mask[k][i] == (float)(1 / 0.7));
            zeros += mask[k][i] == 0;
        }
        assert_near((double)zeros / VALUES, 0.3,
                    5 * sqrt(0.3 * 0.7 / VALUES)); /* 5 sigma, binomial */
    }
    assert_memory_not_equal(mask[0], mask[1], VALUES * sizeof(float));
    assert_memory_not_equal(mask[0], mask[2], VALUES * sizeof(float));
    for (int k = 0; k < 3; k++) ptie_free(mask[k]);
    ptie_free(ones);
    ptie_free(block);
    ptie_nn_free(model);
}

static void dropout_depends_on_the_step_only(void **state) {
    (void)state;
    ptie_model_params params = family(2, (int32_t[]){4, 6});
    params.dropout = 0.5;
    ptie_engine engine;
    ptie_model *model;
    ptie_stepper *stepper;
    ptie_loss_parts first[2], again[2], other[2];
    assert_ok(ptie_engine_start(&engine, 2, "auto"));
    assert_ok(ptie_nn_create(&model, &params));
    assert_ok(ptie_stepper_create(&stepper, &engine, model, 2, SIZE, SIZE, paper_weights));
    fill_samples(stepper, 2, 1, SIZE, SIZE);
    assert_ok(ptie_stepper_gradients(stepper, 2, 7, 1, first, NULL));
    assert_ok(ptie_stepper_gradients(stepper, 2, 7, 2, other, NULL));
    assert_ok(ptie_stepper_gradients(stepper, 2, 7, 1, again, NULL));
    assert_memory_equal(first, again, sizeof first);
    assert_true(first[0].loss != other[0].loss && first[1].loss != other[1].loss);
    ptie_stepper_free(stepper);
    ptie_nn_free(model);
    ptie_engine_stop(&engine);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gradients_are_slopes_of_the_loss),
        cmocka_unit_test(loss_gradient_is_the_derivative),
        cmocka_unit_test(equal_images_have_ssim_one_and_no_loss),
        cmocka_unit_test(threads_do_not_change_a_bit),
        cmocka_unit_test(a_short_batch_ignores_the_rest),
        cmocka_unit_test(sizes_that_do_not_fit_are_named),
        cmocka_unit_test(dropout_masks_a_share_and_keeps_the_mean),
        cmocka_unit_test(dropout_depends_on_the_step_only),
    };
    return cmocka_run_group_tests_name("training", tests, NULL, NULL);
}
