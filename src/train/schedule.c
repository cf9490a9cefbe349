/* SPDX-License-Identifier: BSD-3-Clause */
/* What a step's number decides: its learning rate, and its place in the order of samples. */
#include <math.h>

#include "base/random.h"
#include "train/train.h"

#define PI 3.14159265358979323846

double ptie_learning_rate(const ptie_train_params *params, uint64_t steps_per_epoch,
                          uint64_t step) {
    const uint64_t epoch = step / steps_per_epoch;
    const double cosine = 0.5 * (1 + cos(PI * (double)epoch / params->epochs));
    const double warmup_steps = params->warmup_epochs * (double)steps_per_epoch;
    const double warmup = (double)(step + 1) < warmup_steps ? (double)(step + 1) / warmup_steps : 1;
    return params->learning_rate * cosine * warmup;
}

/* Fisher-Yates. */
void ptie_epoch_order(uint32_t *order, uint32_t count, uint64_t seed, uint64_t epoch) {
    ptie_random random;
    ptie_random_init(&random, seed, PTIE_STREAM_ORDER, epoch);
    for (uint32_t i = 0; i < count; i++) order[i] = i;
    for (uint32_t i = count; i > 1; i--) {
        const uint32_t j = (uint32_t)ptie_random_integer(&random, 0, (int32_t)(i - 1));
        const uint32_t other = order[j];
        order[j] = order[i - 1];
        order[i - 1] = other;
    }
}
