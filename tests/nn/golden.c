/* SPDX-License-Identifier: BSD-3-Clause */
/* The network, its gradients, the loss and the optimiser against PyTorch in double precision
 * (tests/golden/make_network.py), at every kernel level of this machine.  Beside each bound stands
 * the worst relative or absolute error measured over the levels; the margin is five- to sevenfold.
 */
#include "support/support.h"

#include <math.h>

#include "nn/adamw.h"
#include "nn/loss.h"
#include "nn/model.h"

enum { BATCH = 2, HEIGHT = 36, WIDTH = 44, PIXELS = HEIGHT * WIDTH };

static const ptie_loss_weights paper_weights = {0.5, 0.4, 0.1};

typedef struct golden {
    ptie_safetensors *file;
    ptie_engine engine;
    ptie_model *model;
    ptie_stepper *stepper;
} golden;

static const float *tensor(const golden *g, const char *name) {
    const ptie_tensor_view *view = ptie_safetensors_find(g->file, name);
    if (!view) fail_msg("no tensor %s", name);
    return view->data;
}

static void open_golden(golden *g, ptie_cpu_level level) {
    assert_ok(ptie_safetensors_read(&g->file, support_source("tests/golden/network.safetensors")));
    assert_ok(ptie_engine_start(&g->engine, 2, ptie_cpu_name(level)));
    assert_ok(ptie_nn_from_safetensors(&g->model, g->file, "golden"));
    assert_ok(ptie_stepper_create(&g->stepper, &g->engine, g->model, BATCH, WIDTH, HEIGHT,
                                  paper_weights));
    for (int32_t n = 0; n < BATCH; n++) {
        memcpy(ptie_stepper_noisy(g->stepper, n, false), tensor(g, "noisy") + n * PIXELS,
               PIXELS * sizeof(float));
        memcpy(ptie_stepper_clean(g->stepper, n, false), tensor(g, "clean") + n * PIXELS,
               PIXELS * sizeof(float));
    }
}

static void close_golden(golden *g) {
    ptie_stepper_free(g->stepper);
    ptie_nn_free(g->model);
    ptie_engine_stop(&g->engine);
    ptie_safetensors_free(g->file);
}

static void at_every_level(void (*check)(golden *)) {
    for (int level = 0; level <= (int)ptie_cpu_detect(); level++) {
        golden g;
        open_golden(&g, (ptie_cpu_level)level);
        check(&g);
        close_golden(&g);
    }
}

static void check_inference(golden *g) {
    ptie_denoiser *denoiser;
    float clean[PIXELS];
    assert_ok(ptie_nn_denoiser(&denoiser, &g->engine, g->model, WIDTH, HEIGHT, NULL));
    void *scratch = ptie_scratch_alloc(ptie_nn_denoiser_scratch(denoiser));
    for (int32_t n = 0; n < BATCH; n++) {
        assert_ok(ptie_nn_denoise(denoiser, clean, tensor(g, "noisy") + n * PIXELS, scratch));
        /* Measured 3.3e-7. */
        assert_near(support_relative_error(clean, tensor(g, "inference") + n * PIXELS, PIXELS), 0,
                    2e-6);
    }
    ptie_scratch_free(scratch);
    ptie_nn_denoiser_free(denoiser);
}

static void inference_matches_pytorch(void **state) {
    (void)state;
    at_every_level(check_inference);
}

static void check_first_step(golden *g) {
    ptie_loss_parts parts[BATCH];
    assert_ok(ptie_stepper_gradients(g->stepper, BATCH, 0, 1, parts, NULL));
    for (int32_t n = 0; n < BATCH; n++) {
        const float *expected = tensor(g, "parts") + 5 * n;
        const double found[5] = {parts[n].loss, parts[n].l1, parts[n].ssim, parts[n].wmse,
                                 parts[n].mse};
        for (int i = 0; i < 5; i++)
            assert_near(found[i], (double)expected[i], 5e-7); /* measured 9e-8 */
    }
    const ptie_graph *graph = &g->model->graph;
    for (int32_t i = 0; i < graph->param_count; i++) {
        const ptie_param *param = &graph->params[i];
        char name[64];
        size_t count = param->count;
        snprintf(name, sizeof name, param->trainable ? "gradient.%s" : "after.%s", param->name);
        const float *found = param->trainable
                                 ? ptie_stepper_state(g->stepper, 0, param->name, &count)
                                 : g->model->values + param->offset;
        double error = support_relative_error(found, tensor(g, name), count);
        /* Required 1e-4; measured 4e-6 at worst. */
        if (!(error <= 1e-5)) fail_msg("%s: relative error %g", name, error);
    }
}

static void every_gradient_matches_pytorch(void **state) {
    (void)state;
    at_every_level(check_first_step);
}

static void check_ten_steps(golden *g) {
    const ptie_adamw adamw = {1e-3, 0.9, 0.999, 1e-7, 0.004};
    ptie_loss_parts parts[BATCH];
    for (uint64_t step = 1; step <= 10; step++) {
        assert_ok(ptie_stepper_gradients(g->stepper, BATCH, 0, step, parts, NULL));
        ptie_stepper_update(g->stepper, &adamw, step);
        double loss = (parts[0].loss + parts[1].loss) / 2;
        double expected = (double)tensor(g, "step_losses")[step - 1];
        assert_near(loss, expected, 5e-6 * expected); /* required 1e-4, measured 1.3e-6 */
    }
}

static void ten_training_steps_match_pytorch(void **state) {
    (void)state;
    at_every_level(check_ten_steps);
}

static void check_ssim(golden *g) {
    const ptie_loss_weights only_ssim = {0, 1, 0};
    void *scratch = ptie_scratch_alloc(ptie_loss_scratch(WIDTH, HEIGHT));
    float gradient[PIXELS];
    for (int32_t n = 0; n < BATCH; n++) {
        const size_t offset = (size_t)n * PIXELS;
        ptie_loss_parts parts;
        /* The loss has 1 - SSIM: scale -1 gives the gradient of SSIM. */
        ptie_loss_evaluate(g->engine.kernels, &parts, gradient, tensor(g, "noisy") + offset,
                           tensor(g, "clean") + offset, WIDTH, HEIGHT, only_ssim, -1, scratch);
        assert_near(parts.ssim, (double)tensor(g, "ssim")[n], 3e-7); /* measured 6e-8 */
        assert_near(support_relative_error(gradient, tensor(g, "ssim_gradient") + offset, PIXELS),
                    0, 5e-6); /* measured 9e-7 */
    }
    ptie_scratch_free(scratch);
}

static void ssim_and_its_gradient_match_pytorch(void **state) {
    (void)state;
    at_every_level(check_ssim);
}

static void check_adamw(golden *g) {
    enum { COUNT = 5, STEPS = 3 };
    const ptie_adamw adamw = {1e-2, 0.9, 0.999, 1e-7, 0.1};
    float values[COUNT], first[COUNT] = {0}, second[COUNT] = {0};
    memcpy(values, tensor(g, "adamw_start"), sizeof values);
    for (uint64_t step = 1; step <= STEPS; step++)
        ptie_adamw_apply(values, first, second, tensor(g, "adamw_gradients") + COUNT * (step - 1),
                         COUNT, &adamw, step);
    /* A step moves a value by about the learning rate; each is rounded a few times: 10 * 2^-24 *
       |v|.  Measured 1.2e-7 in place of 6e-7. */
    for (int i = 0; i < COUNT; i++)
        assert_near((double)values[i], (double)tensor(g, "adamw_end")[i],
                    6e-7 * (fabs((double)values[i]) + 0.03));
}

static void three_steps_of_adamw_match_keras_rule(void **state) {
    (void)state;
    golden g;
    open_golden(&g, PTIE_CPU_SCALAR);
    check_adamw(&g);
    close_golden(&g);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(inference_matches_pytorch),
        cmocka_unit_test(every_gradient_matches_pytorch),
        cmocka_unit_test(ten_training_steps_match_pytorch),
        cmocka_unit_test(ssim_and_its_gradient_match_pytorch),
        cmocka_unit_test(three_steps_of_adamw_match_keras_rule),
    };
    return cmocka_run_group_tests_name("golden", tests, NULL, NULL);
}
