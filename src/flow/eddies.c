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

static float envelope_at(const void *flow, float x, float y) {
    const envelope *e = flow;
    float width = e->radius + e->spread * fmaxf(x, 0);
    if (fabsf(y) > 4 * width) return 0;
    return e->base * ptie_bell(y / width) * expf(-fmaxf(x, 0) / e->decay) *
           ptie_smoothstep(x / e->radius + 1);
}

static envelope envelope_draw(ptie_random *random, const ptie_axes *axes) {
    return (envelope){.radius = ptie_draw(random, 0.04, 0.14),
                      .spread = ptie_draw(random, 0.03, 0.2),
                      .decay = ptie_draw_log(random, 0.5, 4) * axes->end,
                      .base = 1};
}

/* Gaussian eddies that travel and grow downstream; some are holes. */
static ptie_status parametric(float *map, const ptie_scene *scene, ptie_random *random) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ACROSS, -0.25, 0.2, 0.4);
    envelope e = envelope_draw(random, &axes);
    float size = ptie_draw_log(random, 0.15, 0.5), growth = ptie_draw(random, 0.2, 1);
    double holes = ptie_random_uniform(random, 0, 0.35),
           density = ptie_random_log_uniform(random, 1.2, 5);
    float base = ptie_draw(random, 0.05, 0.5), stretch = ptie_draw(random, 1, 2.5);
    double speed = ptie_speed_draw(scene, random);
    uint64_t key = ptie_key_draw(random);
    e.base = base;
    ptie_paint(map, scene, &axes, envelope_at, &e);
    e.base = 1;
    /* `density` eddies side by side in each stretch of their own size. */
    double spacing = (double)(size * e.radius) / density;
    ptie_train train =
        ptie_train_make(spacing, speed * scene->time_s, (double)-e.radius, (double)axes.end + 0.1);
    for (int64_t n = train.first; n <= train.last; n++) {
        ptie_random own;
        double x = ptie_train_car(&train, n, key, &own);
        double lane = ptie_random_normal(&own) * 0.8;
        bool hole = ptie_chance(&own, holes);
        float tall = ptie_draw(&own, 0.3, 1), slim = ptie_draw(&own, 1, (double)stretch);
        float scale = ptie_draw_log(&own, 0.6, 1.6), angle = ptie_draw(&own, -1.6, 1.6);
        /* Larger eddies are rarer further downstream, where each takes the place of several. */
        float wide = 1 + growth * e.spread / e.radius * fmaxf((float)x, 0);
        if (ptie_random_uniform(&own, 0, 1) * (double)wide > 1) continue;
        float width = e.radius + e.spread * fmaxf((float)x, 0), y = (float)lane * width;
        float sigma = size * e.radius * wide * scale;
        float height = envelope_at(&e, (float)x, y) * (hole ? -0.5f : 1) * tall;
        ptie_spot spot = {(float)x, y, sigma * slim, sigma, angle, height};
        ptie_splat(map, scene, &axes, &spot);
    }
    for (size_t i = 0; i < (size_t)scene->width * (size_t)scene->height; i++)
        map[i] = fmaxf(map[i], 0);
    return PTIE_OK;
}

/* Warm or foreign gas, mixed by von Karman turbulence within the plume. */
typedef struct mixing {
    ptie_stream stream;
    float height; /* rad per unit of path */
    float decay, stirring, end;
} mixing;

static float mixing_at(const void *flow, float x, float y) {
    const mixing *m = flow;
    float behind = x + 2 * m->stream.radius;
    if (behind <= 0) return 0;
    ptie_parcel p = ptie_stream_at(&m->stream, x, y);
    if (fabsf(p.across) > 4.5f) return 0;
    float inside = ptie_bell(p.across) * ptie_smoothstep(behind / (2 * m->stream.radius));
    float diluted = m->decay / (m->decay + fmaxf(p.x, 0));
    float field[PTIE_TURBULENCE_FIELDS];
    ptie_turbulence_at(&m->stream.turbulence, x + 3, y + 3, field);
    return m->height * inside * diluted * p.width * expf(m->stirring * field[3]);
}

static ptie_status physical(float *map, const ptie_scene *scene, ptie_random *random) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ACROSS, -0.25, 0.15, 0.4);
    ptie_stream_ranges ranges = {0.04, 0.12, 0.05, 0.2, 0.2, 0.5};
    mixing m = {.decay = ptie_draw(random, 0.2, 1.5) * axes.end,
                .stirring = ptie_draw(random, 0.2, 0.7)};
    double path = ptie_scene_wavenumber(scene) * ptie_scene_unit_m(scene),
           air = ptie_ambient_refractivity();
    bool warm = ptie_chance(random, 0.6);
    double heated = PTIE_AMBIENT_K / ptie_random_uniform(random, 330, 900);
    double share = ptie_random_uniform(random, 0.15, 1); /* of another gas */
    const ptie_gas *gas =
        ptie_gas_get(ptie_chance(random, 0.5) ? PTIE_HELIUM : PTIE_CARBON_DIOXIDE);
    double other = ptie_gas_refractivity(gas, PTIE_AMBIENT_PA, PTIE_AMBIENT_K) - air;
    m.height = (float)(2.5066 * path * (warm ? air * (heated - 1) : other * share));
    PTIE_TRY(ptie_stream_draw(&m.stream, scene, random, &ranges, (double)axes.end));
    ptie_paint(map, scene, &axes, mixing_at, &m);
    ptie_stream_free(&m.stream);
    return PTIE_OK;
}

const ptie_morphology ptie_flow_eddies = {"eddies", "Turbulent eddies", parametric, physical};
