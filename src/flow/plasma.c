/* SPDX-License-Identifier: BSD-3-Clause */
/* Plasma: a kinked discharge channel with branches, or a laser spark, in a glow.  docs/math.md
 * (F11). */
#include <math.h>

#include "flow/gas.h"
#include "flow/morphology.h"
#include "flow/turbulence.h"

#define MOST_CHANNELS 6
#define CHANNEL_STEPS 256

/* A channel that runs along x: its distance from the axis at equal steps. */
typedef struct channel {
    float start, end, radius, strength;                       /* units */
    float path[CHANNEL_STEPS + 2], middle[CHANNEL_STEPS + 2]; /* the channel; its smoothed course */
} channel;

typedef struct discharge {
    ptie_turbulence turbulence;
    int count;
    channel channels[MOST_CHANNELS];
    float halo, halo_strength; /* radius in channel radii */
    float height; /* 1, or rad of a channel of radius 1 unit: grows with the path through it */
    float depth;  /* 1: height is per unit of path; 0: the same for every channel */
    float flicker;
} discharge;

PTIE_INLINE float channel_at(const discharge *d, const channel *c, float x, float y) {
    if (x <= c->start || x >= c->end) return 0;
    float step = (x - c->start) / (c->end - c->start) * CHANNEL_STEPS;
    int whole = (int)step;
    float part = step - (float)whole, from_middle = y - c->middle[whole];
    if (fabsf(from_middle) > 4 * d->halo * c->radius) return 0;
    float rise = c->path[whole + 1] - c->path[whole], run = (c->end - c->start) / CHANNEL_STEPS;
    float across = y - c->path[whole] - part * rise;
    float r = fabsf(across) * run / sqrtf(run * run + rise * rise) / c->radius;
    float ends = ptie_smoothstep((x - c->start) / (3 * c->radius)) *
                 ptie_smoothstep((c->end - x) / (3 * c->radius));
    float glow = d->halo_strength > 0
                     ? d->halo_strength * ptie_bell(from_middle / (d->halo * c->radius))
                     : 0;
    return ends * c->strength * (ptie_bell(r) + glow) * (d->depth > 0 ? c->radius : 1);
}

PTIE_CLONES static void line(const void *flow, float *value, const float *x, const float *y) {
    const discharge *d = flow;
    float field[PTIE_LINE][PTIE_TURBULENCE_FIELDS];
    bool bright = false;
    for (int i = 0; i < PTIE_LINE; i++) {
        value[i] = 0;
        for (int n = 0; n < d->count; n++) value[i] += channel_at(d, &d->channels[n], x[i], y[i]);
        bright |= value[i] > 0;
    }
    if (!bright) return;
    ptie_turbulence_line(&d->turbulence, field, x, y);
    for (int i = 0; i < PTIE_LINE; i++)
        value[i] *= d->height * ptie_maxf(0.1f, 1 + d->flicker * field[i][3]);
}

/* Mean of the path over an eighth of the channel; the glow follows this. */
static void smooth_course(channel *c) {
    const int reach = CHANNEL_STEPS / 16;
    for (int i = 0; i < CHANNEL_STEPS + 2; i++) {
        float sum = 0;
        for (int k = -reach; k <= reach; k++) {
            int j = i + k < 0 ? 0 : i + k;
            sum += c->path[j > CHANNEL_STEPS + 1 ? CHANNEL_STEPS + 1 : j];
        }
        c->middle[i] = sum / (float)(2 * reach + 1);
    }
}

/* Kinks from the turbulence, pinned at both ends; branches start on the main channel and run away
 * from it. */
static void bend_channel(channel *c, const discharge *d, const channel *main, float kinks,
                         float away, float lane) {
    float base = 0;
    if (main) {
        float step = (c->start - main->start) / (main->end - main->start) * CHANNEL_STEPS;
        base = main->path[(int)step];
    }
    for (int i = 0; i < CHANNEL_STEPS + 2; i++) {
        float t = (float)i / CHANNEL_STEPS, x = c->start + t * (c->end - c->start),
              field[PTIE_TURBULENCE_FIELDS];
        ptie_turbulence_at(&d->turbulence, x, lane, field);
        float pinned =
            main ? ptie_smoothstep(4 * t) : ptie_smoothstep(5 * t) * ptie_smoothstep(5 * (1 - t));
        c->path[i] = base + kinks * pinned * field[0] + away * (x - c->start);
    }
    smooth_course(c);
}

static void draw_channels(discharge *d, ptie_random *random, const ptie_axes *axes) {
    float kinks = ptie_draw_log(random, 0.008, 0.05), radius = ptie_draw_log(random, 0.008, 0.035);
    float from = ptie_draw(random, (double)axes->start - 0.1, 0.3 * (double)axes->start);
    float to = ptie_draw(random, 0.3 * (double)axes->end, (double)axes->end + 0.1);
    d->count = ptie_random_integer(random, 1, MOST_CHANNELS);
    for (int i = 0; i < MOST_CHANNELS; i++) {
        channel *c = &d->channels[i];
        float start = ptie_draw(random, 0.1, 0.8), reach = ptie_draw(random, 0.3, 1);
        float side = ptie_chance(random, 0.5) ? 1 : -1, away = side * ptie_draw(random, 0.2, 0.9);
        float strength = ptie_draw(random, 0.25, 0.7), slim = ptie_draw(random, 0.4, 0.8);
        *c = (channel){.start = from, .end = to, .radius = radius, .strength = 1};
        if (i > 0) {
            c->start = from + start * (to - from);
            c->end = c->start + reach * (to - c->start);
            c->radius *= slim, c->strength = strength;
        }
        bend_channel(c, d, i > 0 ? d->channels : NULL, kinks, i > 0 ? away : 0, (float)i * 0.37f);
    }
}

static ptie_status draw_discharge(float *map, const ptie_scene *scene, ptie_random *random,
                                  const ptie_axes *axes, discharge *d) {
    double size = ptie_random_log_uniform(random, 0.15, 0.6);
    double inner = ptie_random_uniform(random, 0.1, 0.25), speed = ptie_speed_draw(scene, random);
    ptie_turbulence_params params = ptie_turbulence_draw(scene, random, size, inner, 0.5 * speed);
    d->flicker = ptie_draw(random, 0.05, 0.4);
    d->halo = ptie_draw(random, 2.5, 6);
    PTIE_TRY(ptie_turbulence_create(&d->turbulence, &params));
    draw_channels(d, random, axes);
    ptie_paint(map, scene, axes, line, d);
    ptie_turbulence_free(&d->turbulence);
    return PTIE_OK;
}

/* A spark's kernel: a hot spot that swells, drawn out along the beam, and a lobe thrown back. */
static void draw_spark(float *map, const ptie_scene *scene, ptie_random *random,
                       const ptie_axes *axes, float height) {
    double speed = 0.3 * ptie_speed_draw(scene, random);
    double start = ptie_random_uniform(random, 0.03, 0.12);
    double grown = start * pow(1 + 2.5 * fmod(speed * scene->time_s, 0.3) / start, 0.4);
    float round = ptie_draw(random, 0.4, 1), lobe = ptie_draw(random, 0.5, 1.2);
    float tilt = ptie_draw(random, -0.3, 0.3);
    float r = (float)grown, dim = height * (float)(start / grown);
    ptie_spot spots[3] = {{0, 0, r, r * round, tilt, dim},
                          {-r * lobe * 1.6f, tilt * r, 0.6f * r, 0.6f * r, 0, 0.6f * dim},
                          {0, 0, 2.4f * r, 2 * r, tilt, 0.2f * dim}};
    for (int i = 0; i < 3; i++) ptie_splat(map, scene, axes, &spots[i]);
}

static ptie_status parametric(float *map, const ptie_scene *scene, ptie_random *random) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ANY, 0.35, 0.65, 0.3);
    discharge d = {.height = 1, .halo_strength = ptie_draw(random, 0, 0.5)};
    if (ptie_chance(random, 0.75)) return draw_discharge(map, scene, random, &axes, &d);
    ptie_clear(map, scene);
    draw_spark(map, scene, random, &axes, 1);
    return PTIE_OK;
}

/* Free electrons: phi = -r_e lambda * integral of n_e, through a Gaussian channel. */
static ptie_status physical(float *map, const ptie_scene *scene, ptie_random *random) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ANY, 0.35, 0.65, 0.3);
    double electrons = ptie_random_log_uniform(random, 3e22, 3e24); /* per m^3 */
    double column = electrons * ptie_scene_unit_m(scene) * PTIE_GAUSSIAN_DEPTH;
    double rad = ptie_electron_phase(scene->wavelength_m, column);
    discharge d = {.height = (float)rad, .depth = 1, .halo_strength = ptie_draw(random, 0, 0.3)};
    if (ptie_chance(random, 0.75)) return draw_discharge(map, scene, random, &axes, &d);
    ptie_clear(map, scene);
    draw_spark(map, scene, random, &axes, (float)rad * 0.08f);
    return PTIE_OK;
}

const ptie_morphology ptie_flow_plasma = {"plasma", "Plasma", parametric, physical};
