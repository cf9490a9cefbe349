/* SPDX-License-Identifier: BSD-3-Clause */
/* Random phase objects: islands cut out of a random field, overlapping smooth bodies, and von
   Karman phase screens.  docs/math.md (F4). */
#include <math.h>

#include "flow/morphology.h"
#include "flow/turbulence.h"

typedef struct island {
    ptie_turbulence turbulence;
    float level, edge;      /* of the field that becomes an island; softness of its shore */
    float relief;           /* share of the field's own relief on the islands */
    float ground;           /* height of the disc they stand on */
    float radius, softness; /* of the window, units */
    float tall;             /* 1, or rad per unit of the field */
} island;

PTIE_CLONES static void island_line(const void *flow, float *value, const float *x,
                                    const float *y) {
    const island *o = flow;
    float field[PTIE_LINE][PTIE_TURBULENCE_FIELDS];
    ptie_turbulence_line(&o->turbulence, field, x, y);
    for (int i = 0; i < PTIE_LINE; i++) {
        float r = sqrtf(x[i] * x[i] + y[i] * y[i]);
        float shore = ptie_smoothstep((field[i][0] - o->level) / o->edge);
        value[i] = ptie_rise((o->radius - r) / o->softness) *
                   (o->ground + shore * ptie_maxf(0, 1 + o->relief * field[i][1]));
    }
}

static void screen_line(const void *flow, float *value, const float *x, const float *y) {
    const island *o = flow;
    float field[PTIE_LINE][PTIE_TURBULENCE_FIELDS];
    ptie_turbulence_line(&o->turbulence, field, x, y);
    for (int i = 0; i < PTIE_LINE; i++) value[i] = o->tall * field[i][0];
}

static ptie_status draw_field(island *o, const ptie_scene *scene, ptie_random *random, double low,
                              double high) {
    double outer = ptie_random_log_uniform(random, low, high);
    double inner = ptie_random_log_uniform(random, 0.04, 0.3);
    double speed = ptie_speed_draw(scene, random);
    ptie_turbulence_params params = ptie_turbulence_draw(scene, random, outer, inner, speed);
    return ptie_turbulence_create(&o->turbulence, &params);
}

/* Ellipses of all sizes that drift about. */
static void draw_bodies(float *map, const ptie_scene *scene, ptie_random *random,
                        const ptie_axes *axes) {
    int32_t count = ptie_random_integer(random, 2, 10);
    double speed = 0.5 * ptie_speed_draw(scene, random);
    ptie_clear(map, scene);
    for (int32_t i = 0; i < count; i++) {
        ptie_spot spot;
        ptie_place_draw(scene, random, axes, 0.9, &spot.x, &spot.y);
        double way = ptie_random_uniform(random, 0.4, 1) * speed * scene->time_s;
        double span = (double)(axes->end - axes->start) + 0.2; /* then it comes in again */
        spot.x = axes->start + (float)fmod((double)(spot.x - axes->start) + way, span);
        spot.along = ptie_draw_log(random, 0.02, 0.2);
        spot.across = spot.along * ptie_draw_log(random, 0.35, 1);
        spot.angle = ptie_draw(random, 0, 3.1416);
        spot.height = ptie_draw(random, 0.3, 1);
        ptie_splat(map, scene, axes, &spot);
    }
}

static ptie_status parametric(float *map, const ptie_scene *scene, ptie_random *random) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ANY, 0.35, 0.65, 0.3);
    island o = {.level = ptie_draw(random, -0.3, 0.8)};
    o.edge = ptie_draw_log(random, 0.1, 2.5);
    o.relief = ptie_draw(random, 0, 0.4);
    o.ground = ptie_draw(random, 0.01, 0.15);
    o.radius = ptie_draw(random, 0.25, 0.8);
    o.softness = ptie_draw(random, 0.05, 0.25);
    if (ptie_chance(random, 0.35)) {
        draw_bodies(map, scene, random, &axes);
        return PTIE_OK;
    }
    PTIE_TRY(draw_field(&o, scene, random, 0.25, 1));
    ptie_paint(map, scene, &axes, island_line, &o);
    ptie_turbulence_free(&o.turbulence);
    return PTIE_OK;
}

/* A turbulent layer across the beam: r0 from a tenth of the frame to all of it. */
static ptie_status physical(float *map, const ptie_scene *scene, ptie_random *random) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ANY, 0.35, 0.65, 0.3);
    double r0 = ptie_random_log_uniform(random, 0.1, 1);
    island o = {0};
    PTIE_TRY(draw_field(&o, scene, random, 0.3, 2));
    o.tall = o.turbulence.screen_rad * (float)pow(r0, -5.0 / 6);
    ptie_paint(map, scene, &axes, screen_line, &o);
    ptie_turbulence_free(&o.turbulence);
    return PTIE_OK;
}

const ptie_morphology ptie_flow_random = {"random", "Random phase object", parametric, physical};
