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
static float shape(const front *f, float d, float y) {
    float sharp = d / f->thickness;
    if (f->kind == FRONT_SHEET) return ptie_bell(sharp);
    if (sharp > 5 || d < -10 * f->tail) return 0;
    float fading = expf(fminf(d, 0) / f->tail);
    if (f->kind == FRONT_STEP) return fading * ptie_rise(-sharp);
    float half =
        d < 0 ? f->side * sqrtf(-d / (f->side - d)) : -3 * d; /* a rounded nose, then a slab */
    return fading * ptie_rise((half - fabsf(y)) / f->thickness);
}

static float at(const void *flow, float x, float y) {
    const front *f = flow;
    float field[PTIE_TURBULENCE_FIELDS], sum = 0;
    ptie_turbulence_at(&f->turbulence, x, y, field);
    float ahead = x - f->wrinkles * field[0] + f->bend * y * y, aside = y + f->wrinkles * field[1];
    float window =
        f->kind == FRONT_NOSE ? 1 : ptie_rise((f->side - fabsf(aside)) / f->side_softness);
    if (window < 1e-4f) return 0;
    for (int i = 0; i < f->count; i++) sum += f->height[i] * shape(f, ahead - f->place[i], aside);
    return sum * window;
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
    ptie_paint(map, scene, &axes, at, &f);
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
