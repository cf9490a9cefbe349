/* SPDX-License-Identifier: BSD-3-Clause */
/* The morphologies: one file and one descriptor each, and the table of all of them. */
#ifndef PTIE_FLOW_MORPHOLOGY_H
#define PTIE_FLOW_MORPHOLOGY_H

#include "flow/scene.h"

/* Draws a flow's parameters from `random`, in an order that does not depend on the time, then its
   phase at the scene's time.  map (out): height x width. */
typedef ptie_status (*ptie_morphology_draw)(float *map, const ptie_scene *scene,
                                            ptie_random *random);

typedef struct ptie_morphology {
    const char *name, *title;
    ptie_morphology_draw parametric; /* any range; normalised by the caller */
    ptie_morphology_draw physical;   /* rad, relative to the undisturbed gas */
} ptie_morphology;

extern const ptie_morphology ptie_flow_jet, ptie_flow_eddies, ptie_flow_front, ptie_flow_pockets,
    ptie_flow_fan, ptie_flow_diffusion, ptie_flow_shock, ptie_flow_combustion, ptie_flow_plasma,
    ptie_flow_random, ptie_flow_nozzle;

/* NULL when `which` is not one of 0 .. PTIE_MORPHOLOGIES-1. */
const ptie_morphology *ptie_morphology_get(int32_t which);

#endif
