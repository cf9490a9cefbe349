/* SPDX-License-Identifier: BSD-3-Clause */
/* Model files: safetensors with PyTorch's names and layouts, docs/formats.md. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "nn/model.h"

#define MOST_NOTES 1024 /* in a file; ptie writes a handful */

ptie_status ptie_nn_tensors(const ptie_model *model, ptie_tensor_view **tensors,
                            size_t *tensor_count, ptie_note **notes, size_t *note_count) {
    const ptie_graph *graph = &model->graph;
    ptie_tensor_view *views = ptie_alloc((size_t)graph->param_count, sizeof *views);
    ptie_note *all = ptie_alloc(PTIE_MODEL_FACTS + model->note_count, sizeof *all);
    if (!views || !all) {
        ptie_free(views);
        ptie_free(all);
        return PTIE_FAIL(PTIE_ENOMEM, "model: out of memory");
    }
    for (int32_t i = 0; i < graph->param_count; i++) {
        const ptie_param *param = &graph->params[i];
        views[i] = (ptie_tensor_view){
            .name = param->name, .rank = param->rank, .data = model->values + param->offset};
        memcpy(views[i].shape, param->shape, sizeof param->shape);
    }
    for (size_t i = 0; i < PTIE_MODEL_FACTS; i++)
        all[i] = (ptie_note){model->facts[i].key, model->facts[i].value};
    for (size_t i = 0; i < model->note_count; i++) all[PTIE_MODEL_FACTS + i] = model->notes[i];
    *tensors = views;
    *tensor_count = (size_t)graph->param_count;
    *notes = all;
    *note_count = PTIE_MODEL_FACTS + model->note_count;
    return PTIE_OK;
}

ptie_status ptie_nn_save(const ptie_model *model, const char *path, bool overwrite) {
    ptie_tensor_view *tensors;
    ptie_note *notes;
    size_t tensor_count, note_count;
    PTIE_TRY(ptie_nn_tensors(model, &tensors, &tensor_count, &notes, &note_count));
    ptie_status status =
        ptie_safetensors_write(path, tensors, tensor_count, notes, note_count, overwrite);
    ptie_free(tensors);
    ptie_free(notes);
    return status;
}

/* A fact as text; `expected` tells a person what belongs there. */
static ptie_status read_fact(const char **value, const ptie_safetensors *file, const char *key,
                             const char *expected, const char *where) {
    *value = ptie_safetensors_note(file, key);
    if (*value) return PTIE_OK;
    return PTIE_FAIL(PTIE_EFORMAT, "%s: not a ptie model: metadata '%s' is missing (expected %s)",
                     where, key, expected);
}

static ptie_status read_number(double *number, const ptie_safetensors *file, const char *key,
                               const char *where) {
    const char *value;
    PTIE_TRY(read_fact(&value, file, key, "a number", where));
    if (!ptie_parse_quantity(value, PTIE_NUMBER, number)) return PTIE_OK;
    return PTIE_FAIL(PTIE_EFORMAT, "%s: metadata '%s' (expected a number, found '%s')", where, key,
                     value);
}

/* One of two words: false for the first, true for the second. */
static ptie_status read_word(bool *second, const ptie_safetensors *file, const char *key,
                             const char *word0, const char *word1, const char *where) {
    const char *value;
    PTIE_TRY(read_fact(&value, file, key, word0, where));
    *second = strcmp(value, word1) == 0;
    if (*second || strcmp(value, word0) == 0) return PTIE_OK;
    return PTIE_FAIL(PTIE_EUNSUPPORTED, "%s: metadata '%s' (expected '%s' or '%s', found '%s')",
                     where, key, word0, word1, value);
}

/* "unet-8-16-32" */
static ptie_status read_architecture(ptie_model_params *params, const ptie_safetensors *file,
                                     const char *where) {
    const char *value, *rest;
    PTIE_TRY(read_fact(&value, file, "ptie.arch", "unet-8-16-32 or the like", where));
    rest = strncmp(value, "unet", 4) == 0 ? value + 4 : "?";
    for (params->levels = 0; *rest && params->levels < PTIE_MAX_LEVELS; params->levels++) {
        int used = 0;
        if (sscanf(rest, "-%4d%n", &params->width[params->levels], &used) != 1) break;
        rest += used;
    }
    if (*rest == '\0') return PTIE_OK;
    return PTIE_FAIL(PTIE_EUNSUPPORTED,
                     "%s: unknown architecture (expected unet with 2 to %d widths, found '%s')",
                     where, PTIE_MAX_LEVELS, value);
}

static ptie_status read_facts(ptie_model_params *params, const ptie_safetensors *file,
                              const char *where) {
    double in_channels;
    bool linear, other;
    *params = (ptie_model_params){.struct_size = sizeof *params};
    PTIE_TRY(read_architecture(params, file, where));
    PTIE_TRY(read_number(&in_channels, file, "ptie.in_channels", where));
    PTIE_TRY(read_word(&linear, file, "ptie.output", "sigmoid", "linear", where));
    PTIE_TRY(read_number(&params->dropout, file, "ptie.dropout", where));
    PTIE_TRY(read_number(&params->bn_epsilon, file, "ptie.bn_eps", where));
    PTIE_TRY(read_number(&params->bn_momentum, file, "ptie.bn_momentum", where));
    PTIE_TRY(read_word(&other, file, "ptie.normalise", "minmax", "minmax", where));
    params->output = linear ? PTIE_LINEAR : PTIE_SIGMOID;
    params->in_channels = in_channels >= 0 && in_channels <= 1000 ? (int32_t)in_channels : -1;
    return ptie_nn_check(params, PTIE_EFORMAT, where);
}

static void print_shape(char *text, size_t size, int32_t rank, const int64_t *shape) {
    size_t length = (size_t)snprintf(text, size, "[");
    for (int32_t i = 0; i < rank && length < size; i++)
        length += (size_t)snprintf(text + length, size - length, i ? ", %lld" : "%lld",
                                   (long long)shape[i]);
    if (length < size) snprintf(text + length, size - length, "]");
}

static ptie_status check_shape(const ptie_tensor_view *tensor, const ptie_param *param,
                               const ptie_model *model, const char *where) {
    char expected[96], found[96];
    bool same = tensor && tensor->rank == param->rank;
    for (int32_t i = 0; same && i < param->rank; i++) same = tensor->shape[i] == param->shape[i];
    if (same) return PTIE_OK;
    print_shape(expected, sizeof expected, param->rank, param->shape);
    if (tensor)
        print_shape(found, sizeof found, tensor->rank, tensor->shape);
    else
        snprintf(found, sizeof found, "no such tensor");
    return PTIE_FAIL(PTIE_ESIZE, "%s: tensor '%s' does not fit %s (expected %s, found %s)", where,
                     param->name, model->name, expected, found);
}

static ptie_status check_values(const float *values, const ptie_param *param, const char *where) {
    bool variance = strstr(param->name, "running_var") != NULL;
    for (size_t i = 0; i < param->count; i++)
        if (!isfinite(values[i]) || (variance && values[i] < 0))
            return PTIE_FAIL(
                PTIE_EFORMAT, "%s: tensor '%s' is damaged (expected %s, found %g at %zu)", where,
                param->name, variance ? "variances" : "finite numbers", (double)values[i], i);
    return PTIE_OK;
}

/* The file holds what the model needs, so that it may be allocated. */
static ptie_status check_shapes(const ptie_model *model, const ptie_safetensors *file,
                                const char *where) {
    for (int32_t i = 0; i < model->graph.param_count; i++) {
        const ptie_param *param = &model->graph.params[i];
        PTIE_TRY(check_shape(ptie_safetensors_find(file, param->name), param, model, where));
    }
    return PTIE_OK;
}

static ptie_status read_tensors(ptie_model *model, const ptie_safetensors *file,
                                const char *where) {
    PTIE_TRY(check_shapes(model, file, where));
    PTIE_TRY(ptie_model_allocate(model));
    for (int32_t i = 0; i < model->graph.param_count; i++) {
        const ptie_param *param = &model->graph.params[i];
        const ptie_tensor_view *tensor = ptie_safetensors_find(file, param->name);
        PTIE_TRY(check_values(tensor->data, param, where));
        memcpy(model->values + param->offset, tensor->data, param->count * sizeof(float));
    }
    return PTIE_OK;
}

static ptie_status read_notes(ptie_model *model, const ptie_safetensors *file, const char *where) {
    const ptie_note *notes;
    size_t count = ptie_safetensors_notes(file, &notes);
    if (count > MOST_NOTES)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: too many notes (expected at most %d, found %zu)", where,
                         MOST_NOTES, count);
    for (size_t i = 0; i < count; i++)
        if (!ptie_model_fact(model, notes[i].key))
            PTIE_TRY(ptie_nn_set_note(model, notes[i].key, notes[i].value));
    return PTIE_OK;
}

ptie_status ptie_nn_from_safetensors(ptie_model **out, const ptie_safetensors *file,
                                     const char *where) {
    ptie_model_params params;
    ptie_model *model;
    *out = NULL;
    PTIE_TRY(read_facts(&params, file, where));
    PTIE_TRY(ptie_model_outline(&model, &params));
    ptie_status status = read_tensors(model, file, where);
    if (status == PTIE_OK) status = read_notes(model, file, where);
    if (status == PTIE_OK)
        *out = model;
    else
        ptie_nn_free(model);
    return status;
}

ptie_status ptie_nn_load(ptie_model **out, const char *path) {
    ptie_safetensors *file;
    *out = NULL;
    PTIE_TRY(ptie_safetensors_read(&file, path));
    ptie_status status = ptie_nn_from_safetensors(out, file, path);
    ptie_safetensors_free(file);
    return status;
}
