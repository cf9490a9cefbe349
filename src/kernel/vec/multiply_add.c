/* SPDX-License-Identifier: BSD-3-Clause */
/* Chains of multiply-adds.  A multiply-add takes four cycles and two start in each, so eight
 * independent chains keep the units busy; twelve leave room for jitter, and with the two constants
 * fit the 16 registers of AVX2.
 */
#include "kernel/vec/vec.h"

enum { CHAINS = 12 };
_Static_assert(PTIE_CHAIN_FLOATS % (CHAINS * VEC_WIDTH) == 0, "whole blocks of chains");

void VEC(multiply_add)(float *values, float factor, float addend, int64_t rounds) {
    const vf f = vf_splat(factor), a = vf_splat(addend);
    for (int first = 0; first < PTIE_CHAIN_FLOATS; first += CHAINS * VEC_WIDTH) {
        vf chain[CHAINS];
        UNROLL (c, CHAINS) chain[c] = vf_load(values + first + c * VEC_WIDTH);
        for (int64_t round = 0; round < rounds; round++)
            UNROLL (c, CHAINS) chain[c] = chain[c] * f + a;
        UNROLL (c, CHAINS) vf_store(values + first + c * VEC_WIDTH, chain[c]);
    }
}
