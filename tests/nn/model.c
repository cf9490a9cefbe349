/* SPDX-License-Identifier: BSD-3-Clause */
/* Models and model files, through the public API. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include <ptie/model.h>

#include "nn/model.h"

static ptie_model *make(int32_t levels, const int32_t *widths) {
    ptie_model_params params;
    ptie_model *model;
    ptie_model_params_init(&params);
    params.levels = levels;
    for (int32_t i = 0; i < levels; i++) params.width[i] = widths[i];
    assert_ok(ptie_model_create(&model, &params));
    return model;
}

static void the_papers_network_has_29777_parameters(void **state) {
    (void)state;
    ptie_model *model;
    assert_ok(ptie_model_create(&model, NULL));
    assert_int_equal(ptie_model_trainable(model), 29777);
    assert_string_equal(ptie_model_name(model), "unet-8-16-32");
    assert_int_equal(model->graph.values - model->graph.trainable, 320);
    ptie_model_free(model);
    ptie_model_free(NULL);
}

/* Two levels, one width w: 9 w (in + w) + 9 (w w + w w) + 9 (2 w w + w w) weights, 6 norms, head.
 */
static void other_members_have_the_parameters_of_the_formula(void **state) {
    (void)state;
    for (int32_t w = 1; w <= 9; w += 4) {
        ptie_model *model = make(2, (int32_t[]){w, w});
        assert_int_equal(ptie_model_trainable(model),
                         9 * (w * (1 + w) + 2 * w * w + 3 * w * w) + 6 * 2 * w + w + 1);
        ptie_model_free(model);
    }
    ptie_model *deep = make(6, (int32_t[]){1, 2, 3, 4, 5, 6});
    assert_non_null(ptie_graph_find(&deep->graph, "enc5.conv2.weight"));
    assert_non_null(ptie_graph_find(&deep->graph, "dec5.bn1.running_var"));
    assert_null(ptie_graph_find(&deep->graph, "enc6.conv1.weight"));
    const ptie_param *joined = ptie_graph_find(&deep->graph, "dec5.conv1.weight");
    assert_int_equal(joined->shape[0], 5);
    assert_int_equal(joined->shape[1], 6 + 5);
    ptie_model_free(deep);
}

static void initial_weights_are_glorot_uniform(void **state) {
    (void)state;
    ptie_model *model = make(3, (int32_t[]){8, 16, 32});
    const ptie_param *param = ptie_graph_find(&model->graph, "bottleneck.conv2.weight");
    const double limit = sqrt(6.0 / (9 * (32 + 32)));
    double sum = 0, squares = 0, largest = 0;
    for (size_t i = 0; i < param->count; i++) {
        double v = (double)model->values[param->offset + i];
        sum += v, squares += v * v, largest = fmax(largest, fabs(v));
    }
    const double n = (double)param->count;
    assert_true(largest <= limit && largest > 0.99 * limit);
    /* Five standard errors of mean and variance of a uniform distribution. */
    assert_near(sum / n, 0, 5 * limit / sqrt(3 * n));
    assert_near(squares / n, limit * limit / 3, 5 * limit * limit * sqrt(4.0 / 45 / n));
    ptie_model_free(model);
}

static void parameters_out_of_range_are_named(void **state) {
    (void)state;
    ptie_model *model;
    ptie_model_params params;
    ptie_model_params_init(&params);
    params.levels = 7;
    assert_fails(ptie_model_create(&model, &params), PTIE_EINVAL,
                 "levels is out of range (expected 2..6, found 7)");
    assert_null(model);
    ptie_model_params_init(&params);
    params.width[1] = 0;
    assert_fails(ptie_model_create(&model, &params), PTIE_EINVAL,
                 "width is out of range (expected 1..512, found 0)");
    ptie_model_params_init(&params);
    params.bn_epsilon = (double)NAN;
    assert_fails(ptie_model_create(&model, &params), PTIE_EINVAL, "bn_epsilon");
    ptie_model_params_init(&params);
    params.dropout = 1;
    assert_fails(ptie_model_create(&model, &params), PTIE_EINVAL, "dropout");
    params.struct_size = 0;
    assert_fails(ptie_model_create(&model, &params), PTIE_EINVAL, "not initialised");
}

static void a_saved_model_comes_back_whole(void **state) {
    (void)state;
    ptie_model_params params;
    ptie_model *model, *back;
    ptie_model_params_init(&params);
    params = (ptie_model_params){.struct_size = params.struct_size,
                                 .levels = 4,
                                 .width = {3, 4, 5, 6},
                                 .in_channels = 2,
                                 .output = PTIE_LINEAR,
                                 .dropout = 0.25,
                                 .bn_epsilon = 1e-5,
                                 .bn_momentum = 0.9,
                                 .seed = 77};
    assert_ok(ptie_model_create(&model, &params));
    assert_ok(ptie_model_set_note(model, "ptie.trained_on", "preset \"paper\", seed 1"));
    assert_ok(ptie_model_set_note(model, "b", "1"));
    assert_ok(ptie_model_set_note(model, "b", "2"));
    assert_fails(ptie_model_set_note(model, "ptie.arch", "x"), PTIE_EINVAL,
                 "describes the network");
    const char *path = support_temporary("model.safetensors");
    assert_ok(ptie_model_save(model, path, false));
    assert_fails(ptie_model_save(model, path, false), PTIE_EEXIST, "model.safetensors");
    assert_ok(ptie_model_load(&back, path));
    assert_string_equal(ptie_model_name(back), "unet-3-4-5-6");
    assert_string_equal(ptie_model_note(back, "ptie.trained_on"), "preset \"paper\", seed 1");
    assert_string_equal(ptie_model_note(back, "b"), "2");
    assert_string_equal(ptie_model_note(back, "ptie.output"), "linear");
    assert_null(ptie_model_note(back, "c"));
    const ptie_model_params *found = ptie_model_get_params(back);
    assert_int_equal(found->in_channels, 2);
    assert_int_equal(found->output, PTIE_LINEAR);
    assert_true(found->dropout == 0.25 && found->bn_epsilon == 1e-5 && found->bn_momentum == 0.9);
    assert_int_equal(model->graph.values, back->graph.values);
    assert_memory_equal(model->values, back->values, model->graph.values * sizeof(float));

    /* Written again, the same bytes. */
    const char *second = support_temporary("again.safetensors");
    size_t bytes[2];
    assert_ok(ptie_model_save(back, second, false));
    unsigned char *a = support_read(path, &bytes[0]), *b = support_read(second, &bytes[1]);
    assert_int_equal(bytes[0], bytes[1]);
    assert_memory_equal(a, b, bytes[0]);
    free(a), free(b);
    ptie_model_free(model);
    ptie_model_free(back);
}

static void truncated_files_are_refused(void **state) {
    (void)state;
    ptie_model *model = make(2, (int32_t[]){1, 1});
    const char *path = support_temporary("whole.safetensors"),
               *cut = support_temporary("cut.safetensors");
    size_t bytes;
    assert_ok(ptie_model_save(model, path, false));
    unsigned char *data = support_read(path, &bytes);
    for (size_t length = 0; length < bytes; length += length < 64 ? 1 : 61) {
        ptie_model *none;
        support_write(cut, data, length);
        assert_fails(ptie_model_load(&none, cut), PTIE_EFORMAT, "cut.safetensors");
        assert_null(none);
    }
    free(data);
    ptie_model_free(model);
}

/* Saves the tensors of a model, with one of them or one note changed. */
static const char *save_changed(const ptie_model *model, const char *tensor, const int64_t *shape,
                                const char *key, const char *value) {
    ptie_tensor_view *tensors;
    ptie_note *notes;
    size_t tensor_count, note_count;
    const char *path = support_temporary("changed.safetensors");
    assert_ok(ptie_nn_tensors(model, &tensors, &tensor_count, &notes, &note_count));
    for (size_t i = 0; tensor && i < tensor_count; i++) {
        if (strcmp(tensors[i].name, tensor) != 0) continue;
        if (shape)
            memcpy(tensors[i].shape, shape, sizeof tensors[i].shape);
        else
            tensors[i].name = "somebody.else";
    }
    size_t kept = 0;
    for (size_t i = 0; i < note_count; i++) {
        if (key && strcmp(notes[i].key, key) == 0) {
            if (!value) continue;
            notes[i].value = value;
        }
        notes[kept++] = notes[i];
    }
    assert_ok(ptie_safetensors_write(path, tensors, tensor_count, notes, kept, true));
    ptie_scratch_free(tensors);
    ptie_scratch_free(notes);
    return path;
}

static void models_that_do_not_fit_are_explained(void **state) {
    (void)state;
    ptie_model *model = make(2, (int32_t[]){3, 4}), *none;
    static const struct {
        const char *tensor;
        int64_t shape[4];
        const char *key, *value;
        ptie_status status;
        const char *message;
    } cases[] = {
        {"enc1.conv2.weight",
         {3, 1, 3, 9},
         NULL,
         NULL,
         PTIE_ESIZE,
         "tensor 'enc1.conv2.weight' does not fit unet-3-4 (expected [3, 3, 3, 3], found [3, 1, 3, "
         "9])"},
        {"out.bias",
         {0},
         NULL,
         NULL,
         PTIE_ESIZE,
         "'out.bias' does not fit unet-3-4 (expected [1], found no such tensor)"},
        {NULL, {0}, "ptie.arch", "unet-3-5", PTIE_ESIZE, "does not fit unet-3-5"},
        {NULL, {0}, "ptie.arch", "resnet-50", PTIE_EUNSUPPORTED, "found 'resnet-50'"},
        {NULL,
         {0},
         "ptie.arch",
         "unet-1-2-3-4-5-6-7",
         PTIE_EUNSUPPORTED,
         "found 'unet-1-2-3-4-5-6-7'"},
        {NULL, {0}, "ptie.arch", "unet-8", PTIE_EFORMAT, "levels is out of range"},
        {NULL, {0}, "ptie.arch", NULL, PTIE_EFORMAT, "metadata 'ptie.arch' is missing"},
        {NULL, {0}, "ptie.bn_eps", NULL, PTIE_EFORMAT, "metadata 'ptie.bn_eps' is missing"},
        {NULL, {0}, "ptie.bn_eps", "small", PTIE_EFORMAT, "found 'small'"},
        {NULL, {0}, "ptie.bn_eps", "-1", PTIE_EFORMAT, "bn_epsilon is out of range"},
        {NULL, {0}, "ptie.in_channels", "1e30", PTIE_EFORMAT, "in_channels is out of range"},
        {NULL,
         {0},
         "ptie.output",
         "tanh",
         PTIE_EUNSUPPORTED,
         "expected 'sigmoid' or 'linear', found 'tanh'"},
        {NULL, {0}, "ptie.normalise", "zscore", PTIE_EUNSUPPORTED, "found 'zscore'"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const int64_t *shape = cases[i].shape[0] ? cases[i].shape : NULL;
        const char *path =
            save_changed(model, cases[i].tensor, shape, cases[i].key, cases[i].value);
        assert_fails(ptie_model_load(&none, path), cases[i].status, cases[i].message);
        assert_null(none);
    }
    ptie_model_free(model);
}

static void damaged_weights_are_refused(void **state) {
    (void)state;
    ptie_model *model = make(2, (int32_t[]){2, 2}), *none;
    const char *path = support_temporary("damaged.safetensors");
    model->values[ptie_graph_find(&model->graph, "enc1.conv1.weight")->offset + 3] = NAN;
    assert_ok(ptie_model_save(model, path, false));
    assert_fails(ptie_model_load(&none, path), PTIE_EFORMAT,
                 "tensor 'enc1.conv1.weight' is damaged");
    model->values[ptie_graph_find(&model->graph, "enc1.conv1.weight")->offset + 3] = 0;
    model->values[ptie_graph_find(&model->graph, "dec1.bn2.running_var")->offset] = -1;
    assert_ok(ptie_model_save(model, path, true));
    assert_fails(ptie_model_load(&none, path), PTIE_EFORMAT, "expected variances, found -1 at 0");
    assert_fails(ptie_model_load(&none, support_temporary("none.safetensors")), PTIE_EIO,
                 "none.safetensors");
    assert_fails(ptie_model_load(&none, NULL), PTIE_EINVAL, "path is missing");
    ptie_model_free(model);
}

static void contexts_take_threads_and_levels(void **state) {
    (void)state;
    ptie_ctx_params params;
    ptie_ctx *ctx;
    ptie_ctx_params_init(&params);
    params.threads = 3;
    params.cpu = "scalar";
    assert_ok(ptie_ctx_create(&ctx, &params));
    assert_int_equal(ptie_ctx_threads(ctx), 3);
    assert_string_equal(ptie_ctx_cpu(ctx), "scalar");
    ptie_ctx_free(ctx);
    ptie_ctx_free(NULL);
    assert_ok(ptie_ctx_create(&ctx, NULL));
    assert_true(ptie_ctx_threads(ctx) >= 1);
    ptie_ctx_free(ctx);
    params.cpu = "mmx";
    assert_fails(ptie_ctx_create(&ctx, &params), PTIE_ENAME, "mmx");
    assert_null(ctx);
    params.cpu = "auto";
    params.threads = -1;
    assert_fails(ptie_ctx_create(&ctx, &params), PTIE_EINVAL, "found -1");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_papers_network_has_29777_parameters),
        cmocka_unit_test(other_members_have_the_parameters_of_the_formula),
        cmocka_unit_test(initial_weights_are_glorot_uniform),
        cmocka_unit_test(parameters_out_of_range_are_named),
        cmocka_unit_test(a_saved_model_comes_back_whole),
        cmocka_unit_test(truncated_files_are_refused),
        cmocka_unit_test(models_that_do_not_fit_are_explained),
        cmocka_unit_test(damaged_weights_are_refused),
        cmocka_unit_test(contexts_take_threads_and_levels),
    };
    return cmocka_run_group_tests_name("model", tests, NULL, NULL);
}
