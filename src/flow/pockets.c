/* SPDX-License-Identifier: BSD-3-Clause */
/* Air pockets. */
#include "flow/morphology.h"

/* Until its own model lands. */
static ptie_status draw(float *map, const ptie_scene *scene, ptie_random *random) {
    return ptie_flow_jet.parametric(map, scene, random);
}

const ptie_morphology ptie_flow_pockets = {"pockets", "Air pockets", draw, draw};
