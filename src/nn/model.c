/* SPDX-License-Identifier: BSD-3-Clause */
/* Models: making, copying, describing. */
#include "nn/model.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/random.h"
#include "base/text.h"

static ptie_status check_range(double value, double low, double high, const char *name,
                               ptie_status status, const char *where) {
    if (value >= low && value <= high) return PTIE_OK;
    return PTIE_FAIL(status, "%s: %s is out of range (expected %g..%g, found %g)", where, name, low,
                     high, value);
}

ptie_status ptie_nn_check(const ptie_model_params *params, ptie_status status, const char *where) {
    const double smallest = 1e-12, largest = 1e3; /* of epsilon: any positive number of use */
    PTIE_TRY(check_range(params->levels, 2, PTIE_MAX_LEVELS, "levels", status, where));
    for (int32_t i = 0; i < params->levels; i++)
        PTIE_TRY(check_range(params->width[i], 1, 512, "width", status, where));
    PTIE_TRY(check_range(params->in_channels, 1, 16, "in_channels", status, where));
    PTIE_TRY(check_range(params->output, PTIE_SIGMOID, PTIE_LINEAR, "output", status, where));
    PTIE_TRY(check_range(params->dropout, 0, 0.9, "dropout", status, where));
    PTIE_TRY(check_range(params->bn_epsilon, smallest, largest, "bn_epsilon", status, where));
    return check_range(params->bn_momentum, 0, 1, "bn_momentum", status, where);
}

/* Glorot and Bengio (2010), uniform: what Keras starts from. */
static void draw_weights(ptie_model *model, int32_t which) {
    const ptie_param *param = &model->graph.params[which + PTIE_WEIGHT];
    double area = (double)(param->shape[2] * param->shape[3]);
    double limit = sqrt(6 / (area * (double)(param->shape[0] + param->shape[1])));
    ptie_random random;
    ptie_random_init(&random, model->params.seed, PTIE_STREAM_WEIGHTS, (uint64_t)which);
    for (size_t i = 0; i < param->count; i++)
        model->values[param->offset + i] = (float)ptie_random_uniform(&random, -limit, limit);
}

static void fill(float *values, float value, size_t count) {
    for (size_t i = 0; i < count; i++) values[i] = value;
}

/* Biases, beta and running means stay 0. */
static void set_initial_values(ptie_model *model) {
    const ptie_graph *graph = &model->graph;
    for (int32_t i = 0; i < graph->layer_count; i++) {
        const ptie_layer *layer = &graph->layers[i];
        draw_weights(model, layer->params);
        fill(ptie_model_values(model, layer->params, PTIE_GAMMA), 1, (size_t)layer->out_channels);
        fill(ptie_model_values(model, layer->params, PTIE_VARIANCE), 1,
             (size_t)layer->out_channels);
    }
    draw_weights(model, graph->head);
}

ptie_status ptie_model_outline(ptie_model **out, const ptie_model_params *params) {
    ptie_model *model;
    PTIE_TRY(ptie_alloc_status(&model, 1, sizeof *model, "model"));
    model->params = *params;
    ptie_graph_build(&model->graph, params);
    ptie_model_describe(model);
    *out = model;
    return PTIE_OK;
}

ptie_status ptie_model_allocate(ptie_model *model) {
    return ptie_alloc_status(&model->values, model->graph.values, sizeof(float), "model");
}

ptie_status ptie_nn_create(ptie_model **out, const ptie_model_params *params) {
    ptie_model *model;
    *out = NULL;
    PTIE_TRY(ptie_model_outline(&model, params));
    ptie_status status = ptie_model_allocate(model);
    if (status != PTIE_OK) {
        ptie_nn_free(model);
        return status;
    }
    set_initial_values(model);
    *out = model;
    return PTIE_OK;
}

static void free_note(ptie_note note) {
    ptie_free((void *)(uintptr_t)note.key);
    ptie_free((void *)(uintptr_t)note.value);
}

void ptie_nn_free(ptie_model *model) {
    if (!model) return;
    for (size_t i = 0; i < model->note_count; i++) free_note(model->notes[i]);
    ptie_free(model->notes);
    ptie_free(model->values);
    ptie_free(model);
}

void ptie_nn_copy(ptie_model *to, const ptie_model *from) {
    memcpy(to->values, from->values, from->graph.values * sizeof(float));
}

void ptie_model_describe(ptie_model *model) {
    const ptie_model_params *params = &model->params;
    size_t length = (size_t)snprintf(model->name, sizeof model->name, "unet");
    for (int32_t i = 0; i < params->levels; i++)
        length += (size_t)snprintf(model->name + length, sizeof model->name - length, "-%d",
                                   params->width[i]);
    ptie_fact *fact = model->facts;
#define FACT(name, ...)                                                                            \
    (fact->key = (name), ptie_print(fact->value, sizeof fact->value, __VA_ARGS__), fact++)
    FACT("format", "ptie");
    FACT("ptie.arch", "%s", model->name);
    FACT("ptie.in_channels", "%d", params->in_channels);
    FACT("ptie.output", "%s", params->output == PTIE_SIGMOID ? "sigmoid" : "linear");
    FACT("ptie.dropout", "%.17g", params->dropout);
    FACT("ptie.bn_eps", "%.17g", params->bn_epsilon);
    FACT("ptie.bn_momentum", "%.17g", params->bn_momentum);
    FACT("ptie.normalise", "minmax");
#undef FACT
}

static ptie_note *find_note(const ptie_model *model, const char *key) {
    for (size_t i = 0; i < model->note_count; i++)
        if (strcmp(model->notes[i].key, key) == 0) return &model->notes[i];
    return NULL;
}

const char *ptie_model_fact(const ptie_model *model, const char *key) {
    for (size_t i = 0; i < PTIE_MODEL_FACTS; i++)
        if (strcmp(model->facts[i].key, key) == 0) return model->facts[i].value;
    return NULL;
}

const char *ptie_nn_note(const ptie_model *model, const char *key) {
    const ptie_note *note = find_note(model, key);
    return note ? note->value : ptie_model_fact(model, key);
}

/* Room for one more note; grown by one, since a model has a handful. */
static ptie_status add_note(ptie_model *model, ptie_note note) {
    ptie_note *grown;
    PTIE_TRY(ptie_alloc_status(&grown, model->note_count + 1, sizeof *grown, "note"));
    if (model->note_count) memcpy(grown, model->notes, model->note_count * sizeof *grown);
    grown[model->note_count++] = note;
    ptie_free(model->notes);
    model->notes = grown;
    return PTIE_OK;
}

ptie_status ptie_nn_set_note(ptie_model *model, const char *key, const char *value) {
    if (ptie_model_fact(model, key))
        return PTIE_FAIL(PTIE_EINVAL, "note: '%s' describes the network and cannot be set", key);
    ptie_note note = {ptie_strdup(key), ptie_strdup(value)};
    ptie_status status = PTIE_OK;
    ptie_note *old = find_note(model, key);
    if (!note.key || !note.value)
        status = PTIE_FAIL(PTIE_ENOMEM, "note: out of memory");
    else if (!old)
        status = add_note(model, note);
    if (status != PTIE_OK) {
        free_note(note);
    } else if (old) {
        free_note(*old);
        *old = note;
    }
    return status;
}
