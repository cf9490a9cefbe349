/* SPDX-License-Identifier: BSD-3-Clause */
/* Clean phase of synthetic flows.  Paper sections 2.1 and 2.4; docs/math.md (F1)-(F12).
 *
 * Two families share every morphology: the paper's parametric shapes in [0, 1], and physical models
 * (Gladstone-Dale, shocks, flames, plasmas) in rad.  A map is a pure function of its parameters:
 * the same bits in any order, on any thread.
 */
#ifndef PTIE_FLOW_H
#define PTIE_FLOW_H

#include <ptie/status.h>

typedef enum ptie_family {
    PTIE_PARAMETRIC = 0, /* the paper's: dimensionless, [0, 1] */
    PTIE_PHYSICAL = 1    /* rad, either sign, relative to the undisturbed gas */
} ptie_family;

typedef struct ptie_flow_params {
    uint32_t struct_size;        /* set by ptie_flow_params_init */
    int32_t width_px, height_px; /* 16..32768 each, default 256 */
    double pixel_m;              /* pixel pitch at the object, 1e-9..1, default 20e-6 */
    double wavelength_m;         /* 1e-12..1e-2, default 532e-9; physical family only */
    ptie_family family;
    const char *morphology;      /* a name of ptie_morphology_name, or "mix": composed as a data set is */
    uint64_t seed, index;        /* which flow; default 0, 0 */
    double time_s;               /* 0..1e6, since the first frame; the flow moves, its identity stays */
} ptie_flow_params;

PTIE_API void ptie_flow_params_init(ptie_flow_params *params);

/* The morphologies: "jet", "eddies", "front", "pockets", "fan", "diffusion", "shock", "combustion",
   "plasma", "random", "nozzle".  name is NULL from `count` on; title is for people ("Jet plume"). */
PTIE_API int32_t ptie_morphology_count(void);
PTIE_API const char *ptie_morphology_name(int32_t which);
PTIE_API const char *ptie_morphology_title(int32_t which);

/* phase (out): height x width, row-major; [0, 1] for PTIE_PARAMETRIC, rad for PTIE_PHYSICAL.
   Allocates and frees its own scratch.  Thread-safe.
   Errors: PTIE_EINVAL, PTIE_ENAME (morphology), PTIE_ENOMEM. */
PTIE_API PTIE_NODISCARD ptie_status ptie_flow_render(float *phase, const ptie_flow_params *params);

#endif
