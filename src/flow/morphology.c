/* SPDX-License-Identifier: BSD-3-Clause */
#include "flow/morphology.h"

#include "flow/flow.h"

static const ptie_morphology *const table[PTIE_MORPHOLOGIES] = {
    &ptie_flow_jet,    &ptie_flow_eddies,    &ptie_flow_front,  &ptie_flow_pockets,
    &ptie_flow_fan,    &ptie_flow_diffusion, &ptie_flow_shock,  &ptie_flow_combustion,
    &ptie_flow_plasma, &ptie_flow_random,    &ptie_flow_nozzle,
};

const ptie_morphology *ptie_morphology_get(int32_t which) {
    return which >= 0 && which < PTIE_MORPHOLOGIES ? table[which] : NULL;
}
