/* SPDX-License-Identifier: BSD-3-Clause */
/* Flows inside the library: one morphology, and the composition a data set is made of. */
#ifndef PTIE_FLOW_FLOW_H
#define PTIE_FLOW_FLOW_H

#include <ptie/flow.h>

#include "base/ini.h"

#define PTIE_MORPHOLOGIES 11

/* How the maps of a data set are composed (paper section 2.1: structures are combined with spatial
   gradients, smoothed, normalised).  Part of a preset. */
typedef struct ptie_flow_mix {
    ptie_family family;
    double weight[PTIE_MORPHOLOGIES]; /* chance of each morphology, relative */
    ptie_range components;            /* how many morphologies are combined, 1 .. 4 */
    ptie_range smoothing_px;          /* standard deviation of the final Gaussian, px */
    ptie_range gradient;              /* height of an added linear ramp, share of the map's range */
} ptie_flow_mix;

/* The mix of a built-in preset. */
ptie_flow_mix ptie_flow_mix_paper(void);
ptie_flow_mix ptie_flow_mix_realistic(void);

/* Renders `params` (morphology is ignored) as a composition; *morphologies gets a bit per member. */
ptie_status ptie_flow_compose(float *phase, const ptie_flow_mix *mix, const ptie_flow_params *params,
                              uint32_t *morphologies);

/* Renders one morphology by number. */
ptie_status ptie_flow_single(float *phase, int32_t morphology, const ptie_flow_params *params);

#endif
