/* SPDX-License-Identifier: BSD-3-Clause */
/* What leaves a round nozzle, in rad: a core with shock cells or a barrel and Mach disk where the
   pressure demands them, then mixing with the air.  docs/math.md (F7). */
#ifndef PTIE_FLOW_EXHAUST_H
#define PTIE_FLOW_EXHAUST_H

#include "flow/abel.h"
#include "flow/stream.h"

#define PTIE_EXHAUST_MODES 3

typedef struct ptie_exhaust {
    float nozzle, radius; /* of the nozzle and of the ideally expanded jet, units */
    float core;           /* length of the core, units */
    float gas;            /* rad per unit of path through the unmixed, ideally expanded gas */
    float cell_wave[PTIE_EXHAUST_MODES];   /* rad per unit */
    float cell_height[PTIE_EXHAUST_MODES]; /* rad per unit of path */
    float cell_fade[PTIE_EXHAUST_MODES];   /* units */
    float disk, disk_radius;               /* Mach disk, units; disk = 0: none */
    float exit, behind; /* rad per unit of path at the exit and behind the disk */
    float air;          /* rad per unit of path of the air itself */
    ptie_projection disc, cell[PTIE_EXHAUST_MODES]; /* of radius 1 */
} ptie_exhaust;

/* Draws gas, pressure and temperature for a nozzle of radius `nozzle` (units). */
void ptie_exhaust_draw(ptie_exhaust *exhaust, const ptie_scene *scene, ptie_random *random,
                       float nozzle);

/* Phase at distance x from the exit and y from the axis; `parcel` is the same point in the
   turbulent stream that the jet becomes. */
float ptie_exhaust_at(const ptie_exhaust *exhaust, const ptie_parcel *parcel, float x, float y);

#endif
