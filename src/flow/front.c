/* SPDX-License-Identifier: BSD-3-Clause */
/* Density fronts: corrugated steps, thin sheets, and the nose of a gravity current, moving
 * downstream. */
#include <math.h>

#include "flow/gas.h"
#include "flow/morphology.h"
#include "flow/turbulence.h"

#define MOST_FRONTS 8

typedef enum front_kind { FRONT_STEP, FRONT_SHEET, FRONT_NOSE, FRONT_KINDS } front_kind;

typedef struct front {
    ptie_turbulence turbulence;
    front_kind kind;
    int count;
    float place[MOST_FRONTS], height[MOST_FRONTS];
    float thickness, tail;     /* of the front, and of what fades behind it, units */
    float wrinkles, bend;      /* units; 1/units */
    float side, side_softness; /* half-width of the fronts, units */
} front;

/* d: distance ahead of the front. */
PTIE_INLINE float shape(const front *f, front_kind kind, float d, float y) {
    float sharp = d / f->thickness;
    if (kind == FRONT_SHEET) return ptie_bell(sharp);
    float fading = ptie_expf(ptie_minf(d, 0) / f->tail);
    if (kind == FRONT_STEP) return fading * ptie_rise(-sharp);
    float behind = ptie_maxf(-d, 0); /* a rounded nose, then a slab */
    float half = f->side * sqrtf(behind / (f->side + behind)) - 3 * ptie_maxf(d, 0);
    return fading * ptie_rise((half - fabsf(y)) / f->thickness);
}

/* One kind of front, known when this is compiled. */
PTIE_INLINE void add_fronts(const front *f, front_kind kind, float *value, const float *ahead,
                            const float *aside) {
    for (int n = 0; n < f->count; n++)
        for (int i = 0; i < PTIE_LINE; i++)
            value[i] += f->height[n] * shape(f, kind, ahead[i] - f->place[n], aside[i]);
}

PTIE_CLONES static void line(const void *flow, float *value, const float *x, const float *y) {
    const front *f = flow;
    float field[PTIE_LINE][PTIE_TURBULENCE_FIELDS], ahead[PTIE_LINE], aside[PTIE_LINE];
    ptie_turbulence_line(&f->turbulence, field, x, y);
    for (int i = 0; i < PTIE_LINE; i++) {
        ahead[i] = x[i] - f->wrinkles * field[i][0] + f->bend * y[i] * y[i];
        aside[i] = y[i] + f->wrinkles * field[i][1];
        value[i] = 0;
    }
    switch (f->kind) {
    case FRONT_STEP: add_fronts(f, FRONT_STEP, value, ahead, aside); break;
    case FRONT_SHEET: add_fronts(f, FRONT_SHEET, value, ahead, aside); break;
    default: add_fronts(f, FRONT_NOSE, value, ahead, aside); return; /* it has sides of its own */
    }
    for (int i = 0; i < PTIE_LINE; i++)
        value[i] *= ptie_rise((f->side - fabsf(aside[i])) / f->side_softness);
}

static void place_fronts(front *f, const ptie_axes *axes, double spacing, double way,
                         uint64_t key) {
    ptie_train train = ptie_train_make(spacing, way, (double)axes->start - 0.1,
                                       (double)(axes->end + 3 * f->thickness));
    for (int64_t n = train.first; n <= train.last && f->count < MOST_FRONTS; n++) {
        ptie_random own;
        double x = ptie_train_car(&train, n, key, &own);
        f->place[f->count] = (float)(x + ptie_random_uniform(&own, -0.15, 0.15) * spacing);
        f->height[f->count++] = ptie_draw(&own, 0.4, 1);
    }
}

static ptie_status draw(float *map, const ptie_scene *scene, ptie_random *random, float height) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ANY, 0.4, 0.6, 0.35);
    front f = {.kind = (front_kind)ptie_random_integer(random, 0, FRONT_KINDS - 1)};
    f.thickness = ptie_draw_log(random, 0.008, 0.05);
    f.tail = ptie_draw_log(random, 0.08, 0.8);
    f.bend = ptie_draw(random, -0.5, 1);
    f.side = f.kind == FRONT_NOSE ? ptie_draw(random, 0.06, 0.25) : ptie_draw(random, 0.12, 0.7);
    f.side_softness = ptie_draw(random, 0.02, 0.1);
    double spacing = ptie_random_uniform(random, f.kind == FRONT_SHEET ? 0.12 : 0.4, 0.8);
    double speed = ptie_speed_draw(scene, random);
    double size = ptie_random_log_uniform(random, 0.2, 1);
    f.wrinkles = (float)size * ptie_draw_log(random, 0.015, 0.12);
    uint64_t key = ptie_key_draw(random);
    ptie_turbulence_params wrinkling = ptie_turbulence_draw(scene, random, size, 0.15, speed);
    place_fronts(&f, &axes, spacing, speed * scene->time_s, key);
    for (int i = 0; i < f.count; i++) f.height[i] *= height;
    PTIE_TRY(ptie_turbulence_create(&f.turbulence, &wrinkling));
    ptie_paint(map, scene, &axes, line, &f);
    ptie_turbulence_free(&f.turbulence);
    return PTIE_OK;
}

static ptie_status parametric(float *map, const ptie_scene *scene, ptie_random *random) {
    return draw(map, scene, random, 1);
}

/* A layer of warm air, or of another gas, seen through its depth. */
static ptie_status physical(float *map, const ptie_scene *scene, ptie_random *random) {
    static const ptie_gas_kind kinds[] = {PTIE_HELIUM, PTIE_CARBON_DIOXIDE, PTIE_ARGON,
                                          PTIE_METHANE};
    double depth = ptie_random_uniform(random, 0.1, 0.6);
    double warm_k = ptie_random_uniform(random, 310, 1200);
    const ptie_gas *gas = ptie_gas_get(kinds[ptie_random_integer(random, 0, 3)]);
    if (ptie_chance(random, 0.6)) gas = ptie_gas_get(PTIE_AIR);
    double temperature = gas == ptie_gas_get(PTIE_AIR) ? warm_k : PTIE_AMBIENT_K;
    double step =
        ptie_gas_refractivity(gas, PTIE_AMBIENT_PA, temperature) - ptie_ambient_refractivity();
    double path = ptie_scene_rad(scene) * depth;
    return draw(map, scene, random, (float)(path * step));
}

const ptie_morphology ptie_flow_front = {"front", "Density front", parametric, physical};
