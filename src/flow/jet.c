/* SPDX-License-Identifier: BSD-3-Clause */
/* Jet plume. */
#include <math.h>

#include "flow/exhaust.h"
#include "flow/morphology.h"

typedef struct jet {
    ptie_stream stream;
    float decay;     /* length over which it fades, units */
    float gusts;     /* fluctuation of its strength */
    float sharpness; /* 0: Gaussian profile; towards 1: flat with steep flanks near the source */
    float core;      /* length of the potential core, units */
    float cell, cells,
        cell_decay;             /* shock cells: length, strength, distance over which they fade */
    float head, head_steepness; /* how far a starting jet has come */
} jet;

PTIE_INLINE float profile(const jet *j, const ptie_parcel *p) {
    float gaussian = ptie_bell(p->across);
    float flat = j->sharpness * (1 - ptie_smoothstep(p->x / j->core));
    return gaussian + flat * (ptie_rise(4 * (1.2f - fabsf(p->across))) - gaussian);
}

PTIE_INLINE float at(const jet *j, const ptie_parcel *p, float x) {
    float value = profile(j, p) * ptie_expf(-p->x / j->decay) * ptie_smoothstep(x / 0.01f);
    value *= ptie_maxf(0, 1 + j->gusts * p->gust);
    value *= 1 + j->cells * ptie_expf(-x / j->cell_decay) * ptie_cosf(x / j->cell) *
                     ptie_bell(1.3f * p->across);
    return value * ptie_rise((j->head - p->x) * j->head_steepness);
}

PTIE_CLONES static void line(const void *flow, float *value, const float *x, const float *y) {
    const jet *j = flow;
    ptie_parcels parcels;
    ptie_stream_line(&j->stream, &parcels, x, y);
    for (int i = 0; i < PTIE_LINE; i++) {
        ptie_parcel p = ptie_parcel_of(&parcels, i);
        value[i] = at(j, &p, x[i]);
    }
}

static ptie_status parametric(float *map, const ptie_scene *scene, ptie_random *random) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ACROSS, -0.15, 0.3, 0.5);
    double length = (double)axes.end;
    ptie_stream_ranges ranges = {0.018, 0.11, 0.02, 0.16, 0.05, 0.5};
    jet j = {0};
    j.decay = ptie_draw(random, 0.25, 1.6) * axes.end;
    j.gusts = ptie_draw(random, 0, 0.35);
    j.sharpness = ptie_draw(random, 0, 1);
    j.core = ptie_draw(random, 0.1, 0.6);
    j.cell = ptie_draw(random, 0.006, 0.03);
    j.cells = ptie_chance(random, 0.3) ? ptie_draw(random, 0.2, 0.6) : 0;
    j.cell_decay = ptie_draw(random, 0.15, 0.6);
    bool starting = ptie_chance(random, 0.25);
    double begun = ptie_random_uniform(random, 0.3, 0.9) * length;
    j.head_steepness = ptie_draw(random, 6, 40);
    PTIE_TRY(ptie_stream_draw(&j.stream, scene, random, &ranges, length));
    j.head = starting ? (float)(begun + 0.5 * j.stream.speed * scene->time_s) : 1e3f;
    ptie_paint(map, scene, &axes, line, &j);
    ptie_stream_free(&j.stream);
    return PTIE_OK;
}

typedef struct gas_jet {
    ptie_stream stream;
    ptie_exhaust exhaust;
} gas_jet;

static void gas_line(const void *flow, float *value, const float *x, const float *y) {
    const gas_jet *j = flow;
    ptie_parcels parcels;
    ptie_stream_line(&j->stream, &parcels, x, y);
    for (int i = 0; i < PTIE_LINE; i++) {
        ptie_parcel p = ptie_parcel_of(&parcels, i);
        value[i] = ptie_exhaust_at(&j->exhaust, &p, x[i], y[i]);
    }
}

static ptie_status physical(float *map, const ptie_scene *scene, ptie_random *random) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ACROSS, -0.05, 0.3, 0.5);
    gas_jet j = {0};
    float nozzle = ptie_draw_log(random, 0.015, 0.06);
    ptie_exhaust_draw(&j.exhaust, scene, random, nozzle);
    double radius = (double)j.exhaust.radius;
    ptie_stream_ranges ranges = {radius, radius, 0.09, 0.15, 0.1, 0.45};
    PTIE_TRY(ptie_stream_draw(&j.stream, scene, random, &ranges, (double)axes.end));
    ptie_paint(map, scene, &axes, gas_line, &j);
    ptie_stream_free(&j.stream);
    return PTIE_OK;
}

const ptie_morphology ptie_flow_jet = {"jet", "Jet plume", parametric, physical};
