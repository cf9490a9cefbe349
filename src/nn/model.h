/* SPDX-License-Identifier: BSD-3-Clause */
/* What a model is inside. */
#ifndef PTIE_NN_MODEL_H
#define PTIE_NN_MODEL_H

#include "nn/graph.h"
#include "nn/nn.h"

/* Metadata of the file that say what the network is. */
enum { PTIE_MODEL_FACTS = 8 };

typedef struct ptie_fact {
    const char *key;
    char value[72];
} ptie_fact;

struct ptie_model {
    ptie_model_params params;
    ptie_graph graph;
    float *values; /* all parameters, places in graph.params; trainable ones first */
    char name[72]; /* "unet-8-16-32" */
    ptie_fact facts[PTIE_MODEL_FACTS];
    ptie_note *notes; /* the user's, keys and values owned */
    size_t note_count;
};

/* A model without values, and room for them (zeroed): a file is compared with the one before it gets the other. */
ptie_status ptie_model_outline(ptie_model **out, const ptie_model_params *params);
ptie_status ptie_model_allocate(ptie_model *model);

/* Parameter `which` (PTIE_WEIGHT, ...) of the layer or head whose first one is `params`. */
static inline float *ptie_model_values(const ptie_model *model, int32_t params, int32_t which) {
    return model->values + model->graph.params[params + which].offset;
}

/* Writes facts and name from the parameters. */
void ptie_model_describe(ptie_model *model);
/* Value of a fact; NULL if `key` is not one. */
const char *ptie_model_fact(const ptie_model *model, const char *key);

#endif
