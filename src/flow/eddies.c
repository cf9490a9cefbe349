/* SPDX-License-Identifier: BSD-3-Clause */
/* Turbulent eddies inside a plume.  docs/math.md (F4), (F5). */
#include <math.h>

#include "flow/gas.h"
#include "flow/morphology.h"
#include "flow/stream.h"

/* The plume that holds the eddies. */
typedef struct envelope {
    float radius, spread, decay, base;
} envelope;

PTIE_INLINE float envelope_at(const envelope *e, float x, float y) {
    float down = ptie_maxf(x, 0), width = e->radius + e->spread * down;
    return e->base * ptie_bell(y / width) * ptie_expf(-down / e->decay) *
           ptie_smoothstep(x / e->radius + 1);
}

PTIE_CLONES static void envelope_line(const void *flow, float *value, const float *x,
                                      const float *y) {
    for (int i = 0; i < PTIE_LINE; i++) value[i] = envelope_at(flow, x[i], y[i]);
}

/* How the eddies in it look. */
typedef struct crowd {
    float size, growth, stretch; /* in plume radii; with the plume; largest ratio of axes */
    double holes, density;       /* share of them that lack gas; eddies per length of their size */
    double speed;
    uint64_t key;
} crowd;

static crowd crowd_draw(const ptie_scene *scene, ptie_random *random) {
    crowd c = {.size = ptie_draw_log(random, 0.15, 0.5)};
    c.growth = ptie_draw(random, 0.2, 1);
    c.stretch = ptie_draw(random, 1, 2.5);
    c.holes = ptie_random_uniform(random, 0, 0.35);
    c.density = ptie_random_log_uniform(random, 1.2, 5);
    c.speed = ptie_speed_draw(scene, random);
    c.key = ptie_key_draw(random);
    return c;
}

/* One eddy at x; false when a larger one has taken its place. */
static bool eddy_draw(ptie_spot *spot, ptie_random *own, const crowd *c, const envelope *e,
                      float x) {
    float lane = (float)ptie_random_normal(own) * 0.8f;
    float sign = ptie_chance(own, c->holes) ? -0.5f : 1, tall = ptie_draw(own, 0.3, 1);
    float slim = ptie_draw(own, 1, (double)c->stretch), scale = ptie_draw_log(own, 0.6, 1.6);
    float angle = ptie_draw(own, -1.6, 1.6), chance = ptie_draw(own, 0, 1);
    float down = fmaxf(x, 0), grown = 1 + c->growth * e->spread / e->radius * down;
    float y = lane * (e->radius + e->spread * down), sigma = c->size * e->radius * grown * scale;
    *spot = (ptie_spot){x, y, sigma * slim, sigma, angle, sign * tall * envelope_at(e, x, y)};
    return chance * grown < 1;
}

/* Gaussian eddies that travel and grow downstream in a fainter plume. */
static ptie_status parametric(float *map, const ptie_scene *scene, ptie_random *random) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ACROSS, -0.25, 0.2, 0.4);
    envelope e = {.radius = ptie_draw(random, 0.04, 0.14)};
    e.spread = ptie_draw(random, 0.03, 0.2);
    e.decay = ptie_draw_log(random, 0.5, 4) * axes.end;
    e.base = ptie_draw(random, 0.05, 0.5);
    crowd c = crowd_draw(scene, random);
    ptie_paint(map, scene, &axes, envelope_line, &e);
    e.base = 1;
    double spacing = (double)(c.size * e.radius) / c.density;
    ptie_train train = ptie_train_make(spacing, c.speed * scene->time_s, (double)-e.radius,
                                       (double)axes.end + 0.1);
    for (int64_t n = train.first; n <= train.last; n++) {
        ptie_random own;
        ptie_spot spot;
        double x = ptie_train_car(&train, n, c.key, &own);
        if (eddy_draw(&spot, &own, &c, &e, (float)x)) ptie_splat(map, scene, &axes, &spot);
    }
    for (size_t i = 0; i < (size_t)scene->width * (size_t)scene->height; i++)
        map[i] = fmaxf(map[i], 0); /* a hole is empty at most */
    return PTIE_OK;
}

/* Warm or foreign gas, mixed by von Karman turbulence within the plume. */
typedef struct mixing {
    ptie_stream stream;
    float height; /* rad per unit of path */
    float decay, stirring;
} mixing;

PTIE_CLONES static void mixing_line(const void *flow, float *value, const float *x,
                                    const float *y) {
    const mixing *m = flow;
    ptie_parcels parcels;
    float field[PTIE_LINE][PTIE_TURBULENCE_FIELDS], aside_x[PTIE_LINE], aside_y[PTIE_LINE];
    for (int i = 0; i < PTIE_LINE; i++) aside_x[i] = x[i] + 3, aside_y[i] = y[i] + 3;
    ptie_stream_line(&m->stream, &parcels, x, y);
    ptie_turbulence_line(&m->stream.turbulence, field, aside_x, aside_y);
    for (int i = 0; i < PTIE_LINE; i++) {
        ptie_parcel p = ptie_parcel_of(&parcels, i);
        float begun = ptie_smoothstep((x[i] + 2 * m->stream.radius) / (2 * m->stream.radius));
        float diluted = m->decay / (m->decay + ptie_maxf(p.x, 0));
        value[i] = m->height * ptie_bell(p.across) * begun * diluted * p.width *
                   ptie_expf(m->stirring * field[i][3]);
    }
}

static ptie_status physical(float *map, const ptie_scene *scene, ptie_random *random) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ACROSS, -0.25, 0.15, 0.4);
    ptie_stream_ranges ranges = {0.04, 0.12, 0.05, 0.2, 0.2, 0.5};
    mixing m = {.decay = ptie_draw(random, 0.2, 1.5) * axes.end};
    m.stirring = ptie_draw(random, 0.2, 0.7);
    double path = ptie_scene_rad(scene);
    double air = ptie_ambient_refractivity();
    bool warm = ptie_chance(random, 0.6);
    double heated = PTIE_AMBIENT_K / ptie_random_uniform(random, 330, 900);
    double share = ptie_random_uniform(random, 0.15, 1); /* of another gas */
    const ptie_gas *gas =
        ptie_gas_get(ptie_chance(random, 0.5) ? PTIE_HELIUM : PTIE_CARBON_DIOXIDE);
    double other = ptie_gas_refractivity(gas, PTIE_AMBIENT_PA, PTIE_AMBIENT_K) - air;
    m.height = (float)(PTIE_GAUSSIAN_DEPTH * path * (warm ? air * (heated - 1) : other * share));
    PTIE_TRY(ptie_stream_draw(&m.stream, scene, random, &ranges, (double)axes.end));
    ptie_paint(map, scene, &axes, mixing_line, &m);
    ptie_stream_free(&m.stream);
    return PTIE_OK;
}

const ptie_morphology ptie_flow_eddies = {"eddies", "Turbulent eddies", parametric, physical};
