/* SPDX-License-Identifier: BSD-3-Clause */
/* Chains of multiply-adds: what the peak rate of a processor is measured with. */
#include <string.h>

#include "kernel/scalar/scalar.h"

void ptie_multiply_add_scalar(float *values, float factor, float addend, int64_t rounds) {
    enum { CHAINS = 32 };
    for (int first = 0; first < PTIE_CHAIN_FLOATS; first += CHAINS) {
        float chain[CHAINS];
        memcpy(chain, values + first, sizeof chain);
        for (int64_t round = 0; round < rounds; round++)
            for (int i = 0; i < CHAINS; i++) chain[i] = chain[i] * factor + addend;
        memcpy(values + first, chain, sizeof chain);
    }
}
