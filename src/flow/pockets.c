/* SPDX-License-Identifier: BSD-3-Clause */
/* Air pockets, one after the other along the axis of a jet; vortices in the physical family. */
#include <math.h>

#include "flow/abel.h"
#include "flow/gas.h"
#include "flow/morphology.h"

/* The faint jet that carries the pockets. */
typedef struct carrier {
    float radius, spread, decay, height;
} carrier;

PTIE_CLONES static void carrier_line(const void *flow, float *value, const float *x,
                                     const float *y) {
    const carrier *c = flow;
    for (int i = 0; i < PTIE_LINE; i++) {
        float down = ptie_maxf(x[i], 0), width = c->radius + c->spread * down;
        value[i] = c->height * ptie_bell(y[i] / width) * ptie_expf(-down / c->decay) *
                   ptie_smoothstep(x[i] / 0.05f + 1);
    }
}

/* How the pockets of a row look. */
typedef struct row {
    float size, growth, slimness, zigzag, decay; /* size and zigzag in units at the source */
    float hollow; /* 0: filled; towards 1: rings, as vortex rings are seen from the side */
    double spacing, jitter, speed, start, end;
    uint64_t key;
} row;

static row row_draw(const ptie_scene *scene, ptie_random *random, const ptie_axes *axes) {
    row r = {.size = ptie_draw_log(random, 0.015, 0.06)};
    r.slimness = ptie_draw(random, 0.6, 1.5);
    r.zigzag = ptie_chance(random, 0.4) ? r.size * ptie_draw(random, 0.5, 2) : 0;
    r.decay = ptie_draw_log(random, 0.5, 4) * axes->end;
    r.hollow = ptie_chance(random, 0.4) ? ptie_draw(random, 0.3, 0.8) : 0;
    r.spacing = (double)r.size * ptie_random_uniform(random, 3, 7);
    r.growth =
        ptie_draw(random, 0, 1) * ((float)r.spacing / 2.8f - r.size) / axes->end; /* stay apart */
    r.jitter = ptie_random_uniform(random, 0, 0.12) * r.spacing;
    r.speed = ptie_speed_draw(scene, random);
    r.key = ptie_key_draw(random);
    r.start = (double)-r.size;
    r.end = (double)(axes->end + 0.2f);
    return r;
}

typedef struct pocket {
    float x, y, size, strength; /* strength: 0 .. 1, and the alternating side it lies on is in y */
} pocket;

static pocket pocket_at(const row *r, const ptie_train *train, int64_t number) {
    ptie_random own;
    double x = ptie_train_car(train, number, r->key, &own);
    x += r->jitter * ptie_random_normal(&own);
    float scale = ptie_draw(&own, 0.8, 1.2), strength = ptie_draw(&own, 0.6, 1);
    float down = fmaxf((float)x, 0), side = number % 2 ? 1 : -1;
    float grown = r->size + r->growth * down, birth = ptie_smoothstep((float)x / r->size + 1);
    return (pocket){(float)x, side * r->zigzag * grown / r->size, grown * scale,
                    strength * birth * expf(-down / r->decay)};
}

static ptie_train train_of(const row *r, const ptie_scene *scene) {
    return ptie_train_make(r->spacing, r->speed * scene->time_s, r->start, r->end);
}

static ptie_status parametric(float *map, const ptie_scene *scene, ptie_random *random) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ACROSS, -0.15, 0.3, 0.5);
    row r = row_draw(scene, random, &axes);
    carrier c = {
        .radius = r.size * ptie_draw(random, 0.6, 1.5), .spread = r.growth, .decay = r.decay};
    c.height = ptie_draw(random, 0.05, 0.4);
    ptie_paint(map, scene, &axes, carrier_line, &c);
    ptie_train train = train_of(&r, scene);
    for (int64_t n = train.first; n <= train.last; n++) {
        pocket p = pocket_at(&r, &train, n);
        ptie_spot spot = {p.x, p.y, p.size * r.slimness, p.size, 0, p.strength};
        ptie_splat(map, scene, &axes, &spot);
        if (r.hollow <= 0) continue;
        spot.along *= 0.55f, spot.across *= 0.55f, spot.height *= -r.hollow;
        ptie_splat(map, scene, &axes, &spot);
    }
    return PTIE_OK;
}

/* (F12) Density of a Lamb-Oseen vortex of core radius 1 whose centre lacks `deficit` of the pressure:
   dp/dr = rho v^2 / r with v ~ (1 - exp(-r^2)) / r, then isentropic. */
#define VORTEX_STEPS 256
#define VORTEX_REACH 6.0
typedef struct vortex {
    float density[VORTEX_STEPS + 2]; /* rho / rho_inf - 1 at r = reach * i / steps */
    float core, height;
} vortex;

static void fill_vortex(vortex *v, double deficit) {
    double suction[VORTEX_STEPS + 2], step = VORTEX_REACH / VORTEX_STEPS;
    /* Outside the reach v = 1 / r, whose suction is 1 / (2 r^2). */
    suction[VORTEX_STEPS + 1] = 0.5 / (VORTEX_REACH * VORTEX_REACH);
    for (int i = VORTEX_STEPS; i >= 0; i--) {
        double r = (i + 0.5) * step, speed = (1 - exp(-r * r)) / r;
        suction[i] = suction[i + 1] + speed * speed / r * step;
    }
    for (int i = 0; i < VORTEX_STEPS + 2; i++) {
        double share =
            (suction[i] - suction[VORTEX_STEPS + 1]) / (suction[0] - suction[VORTEX_STEPS + 1]);
        v->density[i] = (float)(pow(1 - deficit * share, 1 / 1.4) - 1);
    }
}

static float vortex_at(const void *context, float r) {
    const vortex *v = context;
    float step = r / v->core * (float)(VORTEX_STEPS / VORTEX_REACH);
    int whole = (int)step;
    if (whole >= VORTEX_STEPS) return 0;
    return v->height * (v->density[whole] +
                        (step - (float)whole) * (v->density[whole + 1] - v->density[whole]));
}

/* A bubble of other or warm gas, round in depth too. */
typedef struct bubble {
    ptie_projection disc;
    float radius, height;
} bubble;

static float bubble_at(const void *context, float r) {
    const bubble *b = context;
    return b->height * b->radius * ptie_projection_at(&b->disc, r / b->radius);
}

static void stamp_pockets(float *map, const ptie_scene *scene, const ptie_axes *axes, const row *r,
                          vortex *v, bubble *b) {
    ptie_train train = train_of(r, scene);
    float vortex_height = v->height, bubble_height = b->height;
    for (int64_t n = train.first; n <= train.last; n++) {
        pocket p = pocket_at(r, &train, n);
        v->core = p.size, v->height = vortex_height * p.strength;
        b->radius = p.size * 1.2f, b->height = bubble_height * p.strength;
        if (vortex_height != 0)
            ptie_stamp(map, scene, axes, p.x, p.y, p.size * (float)VORTEX_REACH, vortex_at, v);
        else
            ptie_stamp(map, scene, axes, p.x, p.y, b->radius * b->disc.reach, bubble_at, b);
    }
}

static ptie_status physical(float *map, const ptie_scene *scene, ptie_random *random) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ACROSS, -0.15, 0.3, 0.5);
    row r = row_draw(scene, random, &axes);
    double air = ptie_ambient_refractivity();
    double path = ptie_scene_rad(scene);
    double depth = ptie_random_uniform(random, 0.2, 1);
    double deficit = ptie_random_uniform(random, 0.03, 0.3);
    double edge = ptie_random_uniform(random, 0.08, 0.3);
    double warm = PTIE_AMBIENT_K / ptie_random_uniform(random, 330, 1000);
    double other =
        ptie_gas_refractivity(ptie_gas_get(PTIE_CARBON_DIOXIDE), PTIE_AMBIENT_PA, PTIE_AMBIENT_K);
    bool vortices = ptie_chance(random, 0.5), hot = ptie_chance(random, 0.7);
    vortex v = {.height = vortices ? (float)(path * depth * air) : 0};
    bubble b = {.height = (float)(path * (hot ? air * (warm - 1) : other - air))};
    fill_vortex(&v, deficit);
    ptie_projection_fill_disc(&b.disc, edge);
    ptie_clear(map, scene);
    stamp_pockets(map, scene, &axes, &r, &v, &b);
    return PTIE_OK;
}

const ptie_morphology ptie_flow_pockets = {"pockets", "Air pockets", parametric, physical};
