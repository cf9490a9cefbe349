/* SPDX-License-Identifier: BSD-3-Clause */
/* Turbulence: four independent random fields of von Karman's spectrum on a periodic tile,
   interpolated smoothly, carried downstream, and changing as they go.  docs/math.md (F4). */
#ifndef PTIE_FLOW_TURBULENCE_H
#define PTIE_FLOW_TURBULENCE_H

#include "flow/scene.h"

#define PTIE_TURBULENCE_FIELDS 4

typedef struct ptie_turbulence_params {
    uint64_t key;        /* names the realisation */
    double period;       /* side of the tile, units */
    double outer, inner; /* outer and inner scale L0, l0, units; 0 < inner < outer */
    double drift;        /* way travelled downstream, units */
    double turns;  /* turns of an eddy of outer size since the start; finer ones turn faster */
    int32_t cells; /* per side; a power of two, 16 .. 4096.  More cells add finer eddies and keep
                      the coarse ones */
} ptie_turbulence_params;

typedef struct ptie_turbulence {
    float *values; /* (cells, cells + 3, fields), B-spline coefficients */
    int32_t cells;
    float cells_per_unit, drift; /* drift in cells */
    float screen_rad;            /* standard deviation of a phase screen with r0 = 1 unit */
} ptie_turbulence;

ptie_status ptie_turbulence_create(ptie_turbulence *out, const ptie_turbulence_params *params);
void ptie_turbulence_free(ptie_turbulence *turbulence); /* a zeroed one is fine */

/* Zero-mean fields of variance 1 at a point, or at a line of points. */
void ptie_turbulence_at(const ptie_turbulence *turbulence, float x, float y,
                        float fields[PTIE_TURBULENCE_FIELDS]);
void ptie_turbulence_line(const ptie_turbulence *turbulence,
                          float fields[PTIE_LINE][PTIE_TURBULENCE_FIELDS], const float *x,
                          const float *y);

/* A realisation as the scene's time finds it, drifting at `speed` (units per second) and turning
   over as it goes.  `inner` is a share of `outer`; the tile is as large as the frame or twice the
   outer scale, in cells of about four px. */
ptie_turbulence_params ptie_turbulence_draw(const ptie_scene *scene, ptie_random *random,
                                            double outer, double inner, double speed);

/* Power spectral density of von Karman's phase, rad^2 per (cycle/unit)^2, for r0 = 1 unit. */
double ptie_von_karman(double frequency, double outer, double inner);

#endif
