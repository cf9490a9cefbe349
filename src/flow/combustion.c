/* SPDX-License-Identifier: BSD-3-Clause */
/* Flames and the hot plumes above them: tongues of burnt gas with thin fronts that bulge and roll
   as they rise.  docs/math.md (F5), (F11). */
#include <math.h>

#include "flow/abel.h"
#include "flow/gas.h"
#include "flow/morphology.h"
#include "flow/stream.h"

#define MOST_TONGUES 3

typedef struct tongue {
    float offset, lean;      /* of its foot, in half-widths; sideways per unit of height */
    float size, wave, phase; /* width, in half-widths; bulges: rad per unit, rad */
    float strength;
} tongue;

typedef struct flame {
    ptie_stream stream;
    int count;
    tongue tongues[MOST_TONGUES];
    float bulge;          /* amplitude of the bulges */
    float foot;           /* height over which it sets in, units */
    float tip;            /* height at which the flame closes, units; 0: an open plume */
    float sheet, glow;    /* parametric: thickness of the front, brightness inside */
    float cooling;        /* height over which the plume cools, units */
    float rad;            /* physical: rad per unit of path of the hottest gas */
    ptie_projection disc; /* of radius 1 */
} flame;

/* Half-width of a tongue: bulges steepen upwards into mushrooms, a flame closes at its tip. */
PTIE_INLINE float half_width(const flame *f, const tongue *t, const ptie_parcel *p) {
    float angle = t->wave * p->x - t->phase, up = ptie_smoothstep(p->x / (6 * f->stream.radius));
    float bulging = 1 + f->bulge * up * ptie_sinf(angle + 0.7f * ptie_sinf(angle));
    float taper = 0.6f + 0.4f * ptie_smoothstep(p->x / f->foot);
    float rest = f->tip > 0 ? 1 - p->x / (f->tip * t->strength) : 1;
    return t->size * bulging * taper * sqrtf(ptie_maxf(rest, 0));
}

/* Position across a tongue, in its own half-widths; the half-width goes to *width (units). */
PTIE_INLINE float across(const flame *f, const tongue *t, const ptie_parcel *p, float *width) {
    float half = half_width(f, t, p);
    *width = half * p->width;
    return (p->across - t->offset - t->lean * p->x / p->width) / ptie_maxf(half, 0.02f);
}

/* The front and the inside of a tongue. */
PTIE_INLINE float tongue_at(const flame *f, const tongue *t, const ptie_parcel *p) {
    float width, r = fabsf(across(f, t, p, &width));
    float thin = f->sheet / ptie_maxf(width, 0.2f * f->sheet);
    float inside = f->glow * ptie_rise((1 - r) / thin);
    float front = (1 - f->glow) * ptie_bell((r - 1) / thin);
    return width < 0.1f * f->sheet ? 0 : t->strength * (inside + front);
}

/* What all tongues share: cooling, gusts, the foot. */
PTIE_INLINE float shared_at(const flame *f, float gusts, float gust, float x) {
    return f->cooling / (f->cooling + ptie_maxf(x, 0)) * ptie_maxf(0, 1 + gusts * gust) *
           ptie_smoothstep(x / f->foot);
}

PTIE_CLONES static void bright_line(const void *flow, float *value, const float *x,
                                    const float *y) {
    const flame *f = flow;
    ptie_parcels parcels;
    ptie_stream_line(&f->stream, &parcels, x, y);
    for (int i = 0; i < PTIE_LINE; i++) value[i] = 0;
    for (int n = 0; n < f->count; n++)
        for (int i = 0; i < PTIE_LINE; i++) {
            ptie_parcel p = ptie_parcel_of(&parcels, i);
            value[i] = ptie_maxf(value[i], tongue_at(f, &f->tongues[n], &p));
        }
    for (int i = 0; i < PTIE_LINE; i++) value[i] *= shared_at(f, 0.3f, parcels.gust[i], x[i]);
}

PTIE_CLONES static void hot_line(const void *flow, float *value, const float *x, const float *y) {
    const flame *f = flow;
    ptie_parcels parcels;
    ptie_stream_line(&f->stream, &parcels, x, y);
    for (int i = 0; i < PTIE_LINE; i++) {
        ptie_parcel p = ptie_parcel_of(&parcels, i);
        float path = 0, width;
        for (int n = 0; n < f->count; n++) {
            float r = across(f, &f->tongues[n], &p, &width);
            path += f->tongues[n].strength * width * ptie_projection_at(&f->disc, r);
        }
        value[i] = f->rad * path * shared_at(f, 0.15f, p.gust, x[i]);
    }
}

static void draw_tongues(flame *f, const ptie_scene *scene, ptie_random *random) {
    double rise = f->stream.speed * scene->time_s;
    f->count = ptie_random_integer(random, 1, MOST_TONGUES);
    for (int i = 0; i < MOST_TONGUES; i++) {
        tongue *t = &f->tongues[i];
        bool first = i == 0;
        t->offset = first ? 0 : ptie_draw(random, -1.1, 1.1);
        t->lean = ptie_draw(random, -0.08, 0.08);
        t->size = first ? 1 : ptie_draw(random, 0.35, 0.8);
        t->wave = ptie_draw(random, 0.5, 1.3) / f->stream.radius * 0.7f;
        t->strength = first ? 1 : ptie_draw(random, 0.5, 1);
        double start = ptie_random_uniform(random, 0, 6.283185307);
        t->phase = (float)fmod(start + (double)t->wave * rise, 6.283185307179586);
    }
}

static ptie_status draw_flame(flame *f, const ptie_scene *scene, ptie_random *random,
                              const ptie_axes *axes) {
    ptie_stream_ranges ranges = {0.04, 0.16, 0, 0.12, 0.03, 0.35};
    f->bulge = ptie_draw(random, 0.05, 0.5);
    f->foot = ptie_draw_log(random, 0.03, 0.3);
    f->tip = ptie_chance(random, 0.4) ? ptie_draw(random, 0.4, 1) * axes->end : 0;
    f->sheet = ptie_draw_log(random, 0.006, 0.03);
    f->glow = ptie_draw(random, 0.1, 0.9);
    f->cooling = ptie_draw_log(random, 0.4, 6) * axes->end;
    PTIE_TRY(ptie_stream_draw(&f->stream, scene, random, &ranges, (double)axes->end));
    draw_tongues(f, scene, random);
    return PTIE_OK;
}

static ptie_status parametric(float *map, const ptie_scene *scene, ptie_random *random) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_UP, -0.15, 0.2, 0.35);
    flame f = {0};
    PTIE_TRY(draw_flame(&f, scene, random, &axes));
    ptie_paint(map, scene, &axes, bright_line, &f);
    ptie_stream_free(&f.stream);
    return PTIE_OK;
}

/* Burnt gas at the pressure of the air: rho = rho0 T0 / T. */
static ptie_status physical(float *map, const ptie_scene *scene, ptie_random *random) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_UP, -0.15, 0.2, 0.35);
    flame f = {0};
    double hotter = ptie_random_log_uniform(random, 1.3, 7);
    double edge = ptie_random_log_uniform(random, 0.05, 0.35);
    double path = ptie_scene_rad(scene);
    f.rad = (float)(path * ptie_ambient_refractivity() * (1 / hotter - 1));
    ptie_projection_fill_disc(&f.disc, edge);
    PTIE_TRY(draw_flame(&f, scene, random, &axes));
    ptie_paint(map, scene, &axes, hot_line, &f);
    ptie_stream_free(&f.stream);
    return PTIE_OK;
}

const ptie_morphology ptie_flow_combustion = {"combustion", "Combustion", parametric, physical};
