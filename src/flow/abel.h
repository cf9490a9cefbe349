/* SPDX-License-Identifier: BSD-3-Clause */
/* Line integrals through axisymmetric and spherical fields.  docs/math.md (F10). */
#ifndef PTIE_FLOW_ABEL_H
#define PTIE_FLOW_ABEL_H

/* f(r) of a radial field. */
typedef double (*ptie_radial)(double radius, const void *context);

/* 2 * integral of f(sqrt(y^2 + t^2)) over t from 0 to where the radius is `reach`, by
   Gauss-Legendre quadrature of order 16 on eight panels: to 1e-9 of the peak for fields that vary
   over reach / 10 or more. */
double ptie_abel(ptie_radial field, const void *context, double y, double reach);

/* The projection at 0 .. reach, tabulated; zero beyond. */
#define PTIE_PROJECTION_STEPS 256
typedef struct ptie_projection {
    float value[PTIE_PROJECTION_STEPS + 2];
    float reach;
} ptie_projection;
void ptie_projection_fill(ptie_projection *projection, ptie_radial field, const void *context,
                          double reach);
float ptie_projection_at(const ptie_projection *projection, float y);

/* A round body with a soft edge: f(r) = (1 - tanh((r - 1) / edge)) / 2. */
void ptie_projection_fill_disc(ptie_projection *projection, double edge);

#endif
