/* SPDX-License-Identifier: BSD-3-Clause */
#include "flow/abel.h"

#include <math.h>

#define PANELS 8
#define ORDER 16

/* Positive nodes and weights of the 16-point Gauss-Legendre rule (Abramowitz & Stegun, table 25.4).
 */
static const double nodes[ORDER / 2][2] = {
    {0.0950125098376374402, 0.1894506104550684963}, {0.2816035507792589132, 0.1826034150449235889},
    {0.4580167776572273863, 0.1691565193950025382}, {0.6178762444026437484, 0.1495959888165767321},
    {0.7554044083550030339, 0.1246289712555338720}, {0.8656312023878317439, 0.0951585116824927848},
    {0.9445750230732325761, 0.0622535239386478929}, {0.9894009349916499326, 0.0271524594117540949},
};

double ptie_abel(ptie_radial field, const void *context, double y, double reach) {
    if (fabs(y) >= reach) return 0;
    double half = sqrt(reach * reach - y * y) / PANELS / 2, sum = 0;
    for (int panel = 0; panel < PANELS; panel++) {
        double middle = (2 * panel + 1) * half;
        for (int i = 0; i < ORDER / 2; i++)
            for (int side = -1; side <= 1; side += 2) {
                double t = middle + side * nodes[i][0] * half;
                sum += nodes[i][1] * field(sqrt(y * y + t * t), context);
            }
    }
    return 2 * half * sum;
}

void ptie_projection_fill(ptie_projection *projection, ptie_radial field, const void *context,
                          double reach) {
    projection->reach = (float)reach;
    for (int i = 0; i < PTIE_PROJECTION_STEPS + 2; i++)
        projection->value[i] =
            (float)ptie_abel(field, context, reach * i / PTIE_PROJECTION_STEPS, reach);
}

float ptie_projection_at(const ptie_projection *projection, float y) {
    float step = fabsf(y) / projection->reach * PTIE_PROJECTION_STEPS;
    if (!(step < PTIE_PROJECTION_STEPS)) return 0;
    int whole = (int)step;
    const float *value = projection->value + whole;
    return value[0] + (step - (float)whole) * (value[1] - value[0]);
}

static double soft_disc(double radius, const void *context) {
    const double *edge = context;
    return 0.5 * (1 - tanh((radius - 1) / *edge));
}

void ptie_projection_fill_disc(ptie_projection *projection, double edge) {
    ptie_projection_fill(projection, soft_disc, &edge, 1 + 6 * edge); /* 6e-6 left */
}
