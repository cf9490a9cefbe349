/* SPDX-License-Identifier: BSD-3-Clause */
/* A nozzle with parallel flow channels.  The parametric family shows the nozzle's outline; in the
   physical one it is opaque, which is no phase.  docs/math.md (F7). */
#include <math.h>

#include "flow/exhaust.h"
#include "flow/morphology.h"

#define MOST_CHANNELS 7

/* Outlines of real nozzles, over the distance t upstream of the lip. */
typedef enum outline { OUTLINE_TUBE, OUTLINE_CONE, OUTLINE_BELL, OUTLINE_CAP, OUTLINES } outline;

typedef struct body {
    outline outline;
    float lip, slope, length; /* half-height at the exit, growth upstream, length; units */
    float height, hollow;     /* 0 .. 1; how much darker the bore is */
    float edge;               /* softness, units */
} body;

PTIE_INLINE float half_height(const body *b, outline shape, float t) {
    switch (shape) {
    case OUTLINE_CONE: return b->lip + b->slope * t;
    case OUTLINE_BELL: return b->lip + b->slope * t * t / (0.05f + t) * 1.5f;
    case OUTLINE_CAP: return t < 0.06f ? b->lip + 0.3f * t : b->lip + 0.018f + b->slope * 0.08f;
    default: return b->lip;
    }
}

PTIE_INLINE float body_at(const body *b, outline shape, float x, float y) {
    float t = -x, half = half_height(b, shape, ptie_maxf(t, 0)), aside = fabsf(y);
    float ends = ptie_rise(t / b->edge) * ptie_rise((b->length - t) / b->edge);
    float wall = ptie_rise((half - aside) / b->edge);
    float bore = ptie_rise((0.6f * b->lip - aside) / b->edge);
    return b->height * ends * wall * (1 - b->hollow * bore);
}

/* A body whose outline is known when this is compiled. */
PTIE_INLINE void add_outline(const body *b, outline shape, float *value, const float *x,
                             const float *y) {
    for (int i = 0; i < PTIE_LINE; i++) value[i] += body_at(b, shape, x[i], y[i]);
}

PTIE_CLONES static void add_body(const body *b, float *value, const float *x, const float *y) {
    switch (b->outline) {
    case OUTLINE_CONE: add_outline(b, OUTLINE_CONE, value, x, y); break;
    case OUTLINE_BELL: add_outline(b, OUTLINE_BELL, value, x, y); break;
    case OUTLINE_CAP: add_outline(b, OUTLINE_CAP, value, x, y); break;
    default: add_outline(b, OUTLINE_TUBE, value, x, y);
    }
}

typedef struct channel {
    float place, width, spread, strength, decay; /* all in units but strength */
    float cell, beads;                           /* rad per unit and contrast of the shock cells */
} channel;

typedef struct nozzle {
    ptie_stream stream;
    body body;
    int count;
    float divergence; /* of the channels' places, per unit */
    channel channels[MOST_CHANNELS];
} nozzle;

PTIE_INLINE float channel_at(const nozzle *n, const channel *c, const ptie_parcel *p, float x) {
    float along = ptie_maxf(p->x, 0), width = c->width + c->spread * along;
    float d = (p->across * p->width - c->place * (1 + n->divergence * along)) / width;
    float bead = 1 + c->beads * ptie_cosf(c->cell * x) * ptie_expf(-4 * x);
    return c->strength * bead * ptie_bell(d) * ptie_expf(-along / c->decay) * c->width / width;
}

PTIE_CLONES static void line(const void *flow, float *value, const float *x, const float *y) {
    const nozzle *n = flow;
    ptie_parcels parcels;
    ptie_stream_line(&n->stream, &parcels, x, y);
    for (int i = 0; i < PTIE_LINE; i++) value[i] = 0;
    for (int c = 0; c < n->count; c++)
        for (int i = 0; i < PTIE_LINE; i++) {
            ptie_parcel p = ptie_parcel_of(&parcels, i);
            value[i] += channel_at(n, &n->channels[c], &p, ptie_maxf(x[i], 0));
        }
    for (int i = 0; i < PTIE_LINE; i++) value[i] *= ptie_smoothstep(x[i] / (2 * n->body.edge));
    if (n->body.height > 0) add_body(&n->body, value, x, y);
}

static void draw_body(body *b, ptie_random *random, float lip, float pixel) {
    b->outline = (outline)ptie_random_integer(random, 0, OUTLINES - 1);
    b->lip = lip;
    b->slope = ptie_draw(random, 0.15, 0.9);
    b->length = ptie_chance(random, 0.6) ? 9 : ptie_draw(random, 0.08, 0.3);
    b->height = ptie_chance(random, 0.65) ? ptie_draw(random, 0.2, 1) : 0;
    b->hollow = ptie_chance(random, 0.4) ? ptie_draw(random, 0.3, 1) : 0;
    b->edge = 1.2f * pixel;
}

static void draw_channels(nozzle *n, ptie_random *random, const ptie_axes *axes, float lip) {
    n->count = ptie_random_integer(random, 2, MOST_CHANNELS);
    n->divergence = ptie_draw(random, 0, 0.6);
    float pitch = 2 * lip / (float)n->count, fill = ptie_draw(random, 0.12, 0.4);
    float spread = ptie_draw(random, 0, 0.35) * pitch;
    float decay = ptie_draw_log(random, 0.5, 5) * axes->end;
    float uneven = ptie_draw(random, 0, 0.6);
    float beads = ptie_chance(random, 0.3) ? ptie_draw(random, 0.2, 0.6) : 0;
    float cell = ptie_draw(random, 1.5, 4) / pitch;
    for (int i = 0; i < MOST_CHANNELS; i++) {
        channel *c = &n->channels[i];
        float shift = ptie_draw(random, -0.15, 0.15), scale = ptie_draw(random, 0.8, 1.25);
        c->place = pitch * ((float)i - 0.5f * (float)(n->count - 1) + shift);
        c->width = pitch * fill * scale;
        c->spread = spread;
        c->strength = 1 - uneven * ptie_draw(random, 0, 1);
        c->decay = decay * ptie_draw(random, 0.6, 1.4);
        c->cell = cell;
        c->beads = beads;
    }
}

static ptie_status parametric(float *map, const ptie_scene *scene, ptie_random *random) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ACROSS, 0, 0.35, 0.45);
    float lip = ptie_draw_log(random, 0.05, 0.28);
    ptie_stream_ranges ranges = {(double)lip, (double)lip, 0.02, 0.12, 0, 0.25};
    nozzle n = {0};
    draw_body(&n.body, random, lip * 1.1f, axes.pixel);
    draw_channels(&n, random, &axes, lip);
    PTIE_TRY(ptie_stream_draw(&n.stream, scene, random, &ranges, (double)axes.end));
    ptie_paint(map, scene, &axes, line, &n);
    ptie_stream_free(&n.stream);
    return PTIE_OK;
}

/* Equal small jets side by side. */
typedef struct manifold {
    ptie_stream stream;
    ptie_exhaust exhaust;
    int count;
    float pitch, edge;
} manifold;

static float manifold_at(const manifold *m, const ptie_parcel *p, float x, float y) {
    float folded = p->across * p->width, sum = 0;
    for (int i = 0; i < m->count; i++) {
        float place = m->pitch * ((float)i - 0.5f * (float)(m->count - 1));
        ptie_parcel own = *p;
        own.across = (folded - place) / p->width;
        sum += ptie_exhaust_at(&m->exhaust, &own, x, y - place);
    }
    return sum;
}

static void manifold_line(const void *flow, float *value, const float *x, const float *y) {
    const manifold *m = flow;
    ptie_parcels parcels;
    ptie_stream_line(&m->stream, &parcels, x, y);
    for (int i = 0; i < PTIE_LINE; i++) {
        ptie_parcel p = ptie_parcel_of(&parcels, i);
        value[i] = manifold_at(m, &p, x[i], y[i]);
    }
}

static ptie_status physical(float *map, const ptie_scene *scene, ptie_random *random) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ACROSS, 0, 0.3, 0.4);
    manifold m = {.count = ptie_random_integer(random, 2, MOST_CHANNELS)};
    float bore = ptie_draw_log(random, 0.012, 0.035), gap = ptie_draw(random, 2.2, 5);
    ptie_exhaust_draw(&m.exhaust, scene, random, bore);
    m.pitch = gap * fmaxf(m.exhaust.radius, bore);
    double radius = (double)m.exhaust.radius;
    ptie_stream_ranges ranges = {radius, radius, 0.06, 0.13, 0.05, 0.35};
    PTIE_TRY(ptie_stream_draw(&m.stream, scene, random, &ranges, (double)axes.end));
    m.stream.reach += 0.5f * (float)m.count * m.pitch / m.exhaust.radius;
    ptie_paint(map, scene, &axes, manifold_line, &m);
    ptie_stream_free(&m.stream);
    return PTIE_OK;
}

const ptie_morphology ptie_flow_nozzle = {"nozzle", "Nozzle channels", parametric, physical};
