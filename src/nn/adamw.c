/* SPDX-License-Identifier: BSD-3-Clause */
/* AdamW as Keras has it, docs/math.md (L5). */
#include "nn/adamw.h"

#include <math.h>

void ptie_adamw_apply(float *values, float *first, float *second, const float *gradient,
                      size_t count, const ptie_adamw *adamw, uint64_t step) {
    const double t = (double)step;
    const float rate =
        (float)(adamw->learning_rate * sqrt(1 - pow(adamw->beta2, t)) / (1 - pow(adamw->beta1, t)));
    const float keep = (float)(1 - adamw->learning_rate * adamw->weight_decay);
    const float beta1 = (float)adamw->beta1, rest1 = (float)(1 - adamw->beta1);
    const float beta2 = (float)adamw->beta2, rest2 = (float)(1 - adamw->beta2);
    const float epsilon = (float)adamw->epsilon;
    for (size_t i = 0; i < count; i++) {
        float g = gradient[i];
        first[i] = beta1 * first[i] + rest1 * g;
        second[i] = beta2 * second[i] + rest2 * g * g;
        values[i] = keep * values[i] - rate * first[i] / (sqrtf(second[i]) + epsilon);
    }
}
