/* SPDX-License-Identifier: BSD-3-Clause */
/* Expansion fans: a cone that widens from a point; Prandtl-Meyer flow around a corner. docs/math.md
 * (F8). */
#include <math.h>

#include "flow/gas.h"
#include "flow/morphology.h"
#include "flow/turbulence.h"

typedef struct cone {
    ptie_turbulence turbulence;
    float opening, centre; /* half-angle and axis, rad */
    float flatness;        /* 0: Gaussian across, 1: flat with steep flanks */
    float source, reach;   /* radius of the source, length over which it fades, units */
    float rays, ray_count,
        twin; /* contrast of rays; their number per rad; strength of a second cone */
    float streaks;
} cone;

PTIE_INLINE float lobe(const cone *c, float angle) {
    float t = fabsf(angle) / c->opening;
    return ptie_bell(t * 1.2f) * (1 - c->flatness) + c->flatness * ptie_rise(6 * (1 - t));
}

PTIE_INLINE float cone_at(const cone *c, float r, float angle, float waver, float streak) {
    float value = ptie_maxf(lobe(c, angle - c->centre), c->twin * lobe(c, angle + c->centre));
    value *= ptie_maxf(0, 1 + c->rays * ptie_cosf(c->ray_count * angle + 0.6f * waver) +
                              c->streaks * streak);
    return value * ptie_expf(-r / c->reach) * c->source / (c->source + r) *
           ptie_smoothstep(r / (0.12f * c->source));
}

PTIE_CLONES static void cone_line(const void *flow, float *value, const float *x, const float *y) {
    const cone *c = flow;
    float field[PTIE_LINE][PTIE_TURBULENCE_FIELDS];
    float r[PTIE_LINE], angle[PTIE_LINE], half_angle[PTIE_LINE];
    for (int i = 0; i < PTIE_LINE; i++) {
        r[i] = sqrtf(x[i] * x[i] + y[i] * y[i]);
        angle[i] = ptie_anglef(y[i], x[i]);
        half_angle[i] = angle[i] * 0.5f;
    }
    ptie_turbulence_line(&c->turbulence, field, r, half_angle);
    for (int i = 0; i < PTIE_LINE; i++)
        value[i] = cone_at(c, r[i], angle[i], field[i][1], field[i][0]);
}

static ptie_status streaks_create(ptie_turbulence *out, const ptie_scene *scene,
                                  ptie_random *random) {
    double size = ptie_random_log_uniform(random, 0.15, 0.6);
    double speed = ptie_speed_draw(scene, random);
    ptie_turbulence_params params = ptie_turbulence_draw(scene, random, size, 0.15, speed);
    return ptie_turbulence_create(out, &params);
}

static ptie_status parametric(float *map, const ptie_scene *scene, ptie_random *random) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ACROSS, -0.1, 0.35, 0.5);
    cone c = {.opening = ptie_draw_log(random, 0.12, 0.7)};
    c.flatness = ptie_draw(random, 0, 1);
    c.source = ptie_draw_log(random, 0.12, 0.9);
    c.reach = ptie_draw_log(random, 0.4, 3) * axes.end;
    c.rays = ptie_chance(random, 0.6) ? ptie_draw(random, 0.1, 0.5) : 0;
    c.ray_count = ptie_draw(random, 8, 30);
    c.streaks = ptie_draw(random, 0, 0.35);
    bool twin = ptie_chance(random, 0.3);
    c.centre = twin ? c.opening * ptie_draw(random, 1, 1.6) : 0;
    c.twin = twin ? ptie_draw(random, 0.4, 1) : 0;
    PTIE_TRY(streaks_create(&c.turbulence, scene, random));
    ptie_paint(map, scene, &axes, cone_line, &c);
    ptie_turbulence_free(&c.turbulence);
    return PTIE_OK;
}

/* Supersonic flow along a wall that turns away at the origin; the gas is at y > 0 and behind the
 * corner. */
#define RAYS 256
typedef struct corner {
    ptie_turbulence turbulence;
    float phase[RAYS + 1];   /* of rays first .. last, relative to the oncoming flow, rad */
    float first, last, turn; /* angles, rad: first > last; the wall behind lies at -turn */
    float edge;              /* softness of the wall, units */
    float reach, streaks;
} corner;

/* The Mach number grows through the fan; a ray lies at the local Mach angle to the local flow. */
static void fill_rays(corner *c, double gamma, double mach, double turn, double rad) {
    enum { STEPS = 4 * RAYS };
    double start = ptie_prandtl_meyer(gamma, mach), before = ptie_isentropic_density(gamma, mach);
    double end = ptie_prandtl_meyer_mach(gamma, start + turn), ray = asin(1 / mach);
    double first = ray, last = asin(1 / end) - turn;
    int filled = 0;
    for (int step = 0; step <= STEPS; step++) {
        double local = mach + (end - mach) * step / STEPS;
        ray = asin(1 / local) - (ptie_prandtl_meyer(gamma, local) - start);
        float phase = (float)(rad * (ptie_isentropic_density(gamma, local) / before - 1));
        while (filled <= RAYS && first + (last - first) * filled / RAYS >= ray)
            c->phase[filled++] = phase;
    }
    while (filled <= RAYS)
        c->phase[filled++] = (float)(rad * (ptie_isentropic_density(gamma, end) / before - 1));
    c->first = (float)first;
    c->last = (float)last;
    c->turn = (float)turn;
}

static float corner_at(const corner *c, float x, float y, float streak) {
    float angle = atan2f(y, x);
    float behind = x < 0 && y < 0 ? y : x * sinf(c->turn) + y * cosf(c->turn);
    float wall = ptie_rise((x < 0 ? y : behind) / c->edge);
    float t = (c->first - angle) / (c->first - c->last) * RAYS;
    if (t <= 0 || wall < 1e-4f || angle < -1.5f) return 0;
    int whole = t < RAYS ? (int)t : RAYS - 1;
    float part = ptie_minf(t - (float)whole, 1);
    float phase = c->phase[whole] + part * (c->phase[whole + 1] - c->phase[whole]);
    float far = expf(-(x * x + y * y) / (c->reach * c->reach)); /* the wall's far end relieves it */
    return phase * wall * far * (1 + c->streaks * streak);
}

static void corner_line(const void *flow, float *value, const float *x, const float *y) {
    const corner *c = flow;
    float field[PTIE_LINE][PTIE_TURBULENCE_FIELDS];
    ptie_turbulence_line(&c->turbulence, field, x, y);
    for (int i = 0; i < PTIE_LINE; i++) value[i] = corner_at(c, x[i], y[i], field[i][0]);
}

static ptie_status physical(float *map, const ptie_scene *scene, ptie_random *random) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ACROSS, 0.05, 0.4, 0.5);
    double mach = ptie_random_uniform(random, 1.2, 3), turn = ptie_random_uniform(random, 0.1, 0.5);
    double pressure = ptie_random_uniform(random, 0.2, 1);
    double depth = ptie_random_uniform(random, 0.2, 0.8);
    corner c = {.edge = 1.5f * axes.pixel, .streaks = ptie_draw(random, 0.03, 0.12)};
    c.reach = ptie_draw(random, 0.5, 1.2) * axes.end;
    double path = ptie_scene_rad(scene) * depth;
    fill_rays(&c, 1.4, mach, turn, path * pressure * ptie_ambient_refractivity());
    PTIE_TRY(streaks_create(&c.turbulence, scene, random));
    ptie_paint(map, scene, &axes, corner_line, &c);
    ptie_turbulence_free(&c.turbulence);
    return PTIE_OK;
}

const ptie_morphology ptie_flow_fan = {"fan", "Expansion fan", parametric, physical};
