/* SPDX-License-Identifier: BSD-3-Clause */
#include <ptie/model.h>

#include "api/context.h"
#include "api/params.h"
#include "nn/model.h"

void ptie_model_params_init(ptie_model_params *params) {
    *params = (ptie_model_params){
        .struct_size = sizeof *params,
        .levels = 3,
        .width = {8, 16, 32},
        .in_channels = 1,
        .output = PTIE_SIGMOID,
        .dropout = 0.1,
        .bn_epsilon = 1e-3,
        .bn_momentum = 0.99,
    };
}

ptie_status ptie_model_create(ptie_model **out, const ptie_model_params *params) {
    static const char where[] = "ptie_model_create";
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    *out = NULL;
    ptie_model_params own;
    ptie_model_params_init(&own);
    if (params) PTIE_TRY(ptie_params_read(&own, sizeof own, params, where));
    PTIE_TRY(ptie_nn_check(&own, PTIE_EINVAL, where));
    return ptie_nn_create(out, &own);
}

ptie_status ptie_model_load(ptie_model **out, const char *path) {
    static const char where[] = "ptie_model_load";
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    *out = NULL;
    PTIE_TRY(ptie_check_pointer(path, where, "path"));
    return ptie_nn_load(out, path);
}

ptie_status ptie_model_save(const ptie_model *model, const char *path, bool overwrite) {
    static const char where[] = "ptie_model_save";
    PTIE_TRY(ptie_check_pointer(model, where, "model"));
    PTIE_TRY(ptie_check_pointer(path, where, "path"));
    return ptie_nn_save(model, path, overwrite);
}

void ptie_model_free(ptie_model *model) {
    ptie_nn_free(model);
}

const ptie_model_params *ptie_model_get_params(const ptie_model *model) {
    return &model->params;
}

size_t ptie_model_trainable(const ptie_model *model) {
    return model->graph.trainable;
}

const char *ptie_model_name(const ptie_model *model) {
    return model->name;
}

const char *ptie_model_note(const ptie_model *model, const char *key) {
    return ptie_nn_note(model, key);
}

ptie_status ptie_model_set_note(ptie_model *model, const char *key, const char *value) {
    static const char where[] = "ptie_model_set_note";
    PTIE_TRY(ptie_check_pointer(model, where, "model"));
    PTIE_TRY(ptie_check_pointer(key, where, "key"));
    PTIE_TRY(ptie_check_pointer(value, where, "value"));
    return ptie_nn_set_note(model, key, value);
}

void ptie_denoiser_params_init(ptie_denoiser_params *params) {
    *params = (ptie_denoiser_params){.struct_size = sizeof *params};
}

ptie_status ptie_denoiser_create(ptie_denoiser **out, ptie_ctx *ctx, const ptie_model *model,
                                 int32_t width_px, int32_t height_px,
                                 const ptie_denoiser_params *params) {
    static const char where[] = "ptie_denoiser_create";
    enum { LARGEST = 32768 };
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    *out = NULL;
    PTIE_TRY(ptie_check_pointer(ctx, where, "ctx"));
    PTIE_TRY(ptie_check_pointer(model, where, "model"));
    PTIE_TRY(ptie_check_integer(width_px, 1, LARGEST, where, "width_px"));
    PTIE_TRY(ptie_check_integer(height_px, 1, LARGEST, where, "height_px"));
    ptie_denoiser_params own;
    ptie_denoiser_params_init(&own);
    if (params) PTIE_TRY(ptie_params_read(&own, sizeof own, params, where));
    return ptie_nn_denoiser(out, &ctx->engine, model, width_px, height_px, &own);
}

void ptie_denoiser_free(ptie_denoiser *denoiser) {
    ptie_nn_denoiser_free(denoiser);
}

size_t ptie_denoiser_scratch_bytes(const ptie_denoiser *denoiser) {
    return ptie_nn_denoiser_scratch(denoiser);
}

static ptie_status check_run(const ptie_denoiser *denoiser, const float *clean, const float *noisy,
                             const void *scratch, const char *where) {
    PTIE_TRY(ptie_check_pointer(denoiser, where, "denoiser"));
    PTIE_TRY(ptie_check_pointer(clean, where, "clean"));
    PTIE_TRY(ptie_check_pointer(noisy, where, "noisy"));
    return ptie_check_pointer(scratch, where, "scratch");
}

ptie_status ptie_denoiser_run(const ptie_denoiser *denoiser, float *clean, const float *noisy,
                              void *scratch) {
    PTIE_TRY(check_run(denoiser, clean, noisy, scratch, "ptie_denoiser_run"));
    return ptie_nn_denoise(denoiser, clean, noisy, scratch);
}

ptie_status ptie_denoiser_run_rad(const ptie_denoiser *denoiser, float *clean_rad,
                                  const float *noisy_rad, int32_t polarity, void *scratch) {
    static const char where[] = "ptie_denoiser_run_rad";
    PTIE_TRY(check_run(denoiser, clean_rad, noisy_rad, scratch, where));
    PTIE_TRY(ptie_check_integer(polarity, -1, 1, where, "polarity"));
    return ptie_nn_denoise_rad(denoiser, clean_rad, noisy_rad, polarity, scratch);
}
