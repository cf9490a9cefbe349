/* SPDX-License-Identifier: BSD-3-Clause */
/* Shock fronts: blast waves, bow shocks, and the lattice of shocks in a supersonic stream.
   docs/math.md (F9). */
#include <math.h>

#include "flow/abel.h"
#include "flow/gas.h"
#include "flow/morphology.h"

#define GAMMA 1.4 /* of air */

/* Parametric shapes. */
typedef enum shock_kind { SHOCK_BLAST, SHOCK_BOW, SHOCK_LATTICE, SHOCK_KINDS } shock_kind;

#define MOST_SHOCKS 3
typedef struct shock {
    shock_kind kind;
    int count;
    float x[MOST_SHOCKS], y[MOST_SHOCKS], radius[MOST_SHOCKS], height[MOST_SHOCKS];
    float thickness, tail;  /* of a front; length of what follows it, units */
    float dip;              /* share of Friedlander's negative phase */
    float slope, standoff;  /* bow: of its far flanks; from the origin to its nose, units */
    float half, cell, fade; /* lattice: half-height, length of a cell, fading, units */
} shock;

/* d: distance ahead of the front.  A steep rise, then Friedlander's decay. */
PTIE_INLINE float profile(const shock *s, float d) {
    float t = ptie_maxf(-d, 0) / s->tail;
    float behind = ptie_expf(-t) * ptie_maxf(0, 1 - s->dip * t);
    return d > 0 ? ptie_bell(d / s->thickness) : behind;
}

PTIE_INLINE float bow(const shock *s, float x, float y) {
    float aside = y / s->standoff;
    float front = s->standoff * (s->slope * (sqrtf(1 + aside * aside) - 1) - 1); /* a hyperbola */
    return profile(s, front - x) * ptie_expf(-0.15f * fabsf(aside));
}

/* Oblique shocks thrown back and forth between the stream's boundaries. */
PTIE_INLINE float lattice(const shock *s, float x, float y) {
    float phase = x / s->cell - ptie_floorf(x / s->cell), zigzag = s->half * fabsf(1 - 2 * phase);
    float cosine = s->cell / sqrtf(s->cell * s->cell + 4 * s->half * s->half);
    float d = (fabsf(y) - zigzag) * cosine;
    float inside = ptie_rise((s->half - fabsf(y)) / s->thickness);
    float sheet = ptie_expf(-fabsf(d) / s->thickness * 0.7f);
    float value = inside * (sheet + 0.35f * ptie_rise(d / s->thickness));
    return x < 0 ? 0 : value * ptie_expf(-x / s->fade);
}

PTIE_INLINE float blast_at(const shock *s, int n, float x, float y) {
    float dx = x - s->x[n], dy = y - s->y[n];
    return s->height[n] * profile(s, sqrtf(dx * dx + dy * dy) - s->radius[n]);
}

PTIE_CLONES static void line(const void *flow, float *value, const float *x, const float *y) {
    const shock *s = flow;
    switch (s->kind) {
    case SHOCK_BOW:
        for (int i = 0; i < PTIE_LINE; i++) value[i] = bow(s, x[i], y[i]);
        break;
    case SHOCK_LATTICE:
        for (int i = 0; i < PTIE_LINE; i++) value[i] = lattice(s, x[i], y[i]);
        break;
    default:
        for (int i = 0; i < PTIE_LINE; i++) value[i] = 0;
        for (int n = 0; n < s->count; n++)
            for (int i = 0; i < PTIE_LINE; i++) value[i] += blast_at(s, n, x[i], y[i]);
    }
}

/* Sedov's law from a radius now (`start`) and a front speed now: R = start (1 + 5/2 speed t /
   start)^(2/5). Beyond `most` the next blast is seen, so that a recording never runs empty. */
static double blast_radius(double start, double speed, double most, double time_s) {
    double life = (pow(most / start, 2.5) - 1) * start / (2.5 * speed);
    double since = fmod(time_s, life);
    return start * pow(1 + 2.5 * speed * since / start, 0.4);
}

static void draw_blasts(shock *s, const ptie_scene *scene, ptie_random *random,
                        const ptie_axes *axes) {
    double speed = ptie_speed_draw(scene, random);
    s->count = ptie_random_integer(random, 1, MOST_SHOCKS);
    for (int i = 0; i < MOST_SHOCKS; i++) {
        double start = ptie_random_uniform(random, 0.12, 0.6);
        ptie_place_draw(scene, random, axes, 1, &s->x[i], &s->y[i]);
        s->height[i] = ptie_draw(random, 0.4, 1);
        s->radius[i] = (float)blast_radius(start, speed, 0.75, scene->time_s);
    }
}

/* Standing shocks breathe by a few percent, a few thousand times per second. */
static double beat_draw(const ptie_scene *scene, ptie_random *random) {
    double amplitude = ptie_random_uniform(random, 0.02, 0.1);
    double phase = ptie_random_uniform(random, 0, 6.283185307);
    double rate_hz = ptie_random_log_uniform(random, 500, 5000);
    return amplitude * sin(6.283185307179586 * fmod(rate_hz * scene->time_s, 1) + phase);
}

static ptie_status parametric(float *map, const ptie_scene *scene, ptie_random *random) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ACROSS, 0.05, 0.35, 0.4);
    shock s = {.kind = (shock_kind)ptie_random_integer(random, 0, SHOCK_KINDS - 1)};
    s.thickness = ptie_draw_log(random, 0.005, 0.02);
    s.tail = ptie_draw_log(random, 0.03, 0.4);
    s.dip = ptie_chance(random, 0.5) ? ptie_draw(random, 0, 0.6) : 0;
    s.slope = ptie_draw(random, 0.5, 1.8);
    s.standoff = ptie_draw(random, 0.04, 0.2);
    s.half = ptie_draw(random, 0.04, 0.2);
    s.cell = s.half * ptie_draw(random, 2, 7);
    s.fade = ptie_draw(random, 0.4, 2) * axes.end;
    double beat = beat_draw(scene, random);
    draw_blasts(&s, scene, random, &axes);
    s.standoff *= (float)(1 + beat);
    s.cell *= (float)(1 + beat);
    ptie_paint(map, scene, &axes, line, &s);
    return PTIE_OK;
}

/* Relative density rise inside a blast of radius 1. */
typedef struct blast {
    double jump;  /* rho2 / rho1 - 1 at the front */
    double decay; /* of Friedlander's curve, in radii */
    bool strong;  /* Sedov's: a dense shell around a near vacuum */
} blast;

static double blast_density(double r, const void *context) {
    const blast *b = context;
    if (r > 1) return 0;
    if (b->strong) return (b->jump + 1) * pow(r, 7.5) - 1; /* r^(3 / (gamma - 1)), gamma = 1.4 */
    double t = (1 - r) / b->decay;
    return b->jump * exp(-t) * (1 - t);
}

typedef struct shell {
    ptie_projection projection;
    float radius, rad; /* rad: per unit of path, of the undisturbed air */
} shell;

static float shell_at(const void *context, float r) {
    const shell *s = context;
    return s->rad * s->radius * ptie_projection_at(&s->projection, r / s->radius);
}

static void draw_shells(float *map, const ptie_scene *scene, ptie_random *random,
                        const ptie_axes *axes, double rad) {
    double mach = ptie_random_uniform(random, 1.05, 2.5);
    blast b = {.jump = ptie_shock_density(GAMMA, mach) - 1,
               .decay = ptie_random_uniform(random, 0.15, 0.6)};
    b.strong = ptie_chance(random, 0.25);
    if (b.strong) b.jump = ptie_shock_density(GAMMA, 20) - 1;
    shell s = {.rad = (float)rad};
    shock places = {0};
    ptie_clear(map, scene);
    draw_blasts(&places, scene, random, axes);
    ptie_projection_fill(&s.projection, blast_density, &b, 1);
    for (int i = 0; i < (places.count + 1) / 2; i++) {
        s.radius = places.radius[i];
        ptie_stamp(map, scene, axes, places.x[i], places.y[i], s.radius, shell_at, &s);
    }
}

/* A bow shock, its strength from the local slope. */
typedef struct bow_shock {
    float slope, standoff, tail, mach, rad, edge;
} bow_shock;

static float bow_at(const bow_shock *b, float x, float y) {
    float aside = y / b->standoff, root = sqrtf(1 + aside * aside);
    float d = x - b->standoff * (b->slope * (root - 1) - 1); /* behind the front, downstream */
    if (d < -4 * b->edge) return 0;
    float tangent = b->slope * aside / root; /* dx / dy of the front */
    float normal = b->mach / sqrtf(1 + tangent * tangent);
    if (normal <= 1) return 0;
    float jump = (float)ptie_shock_density(GAMMA, (double)normal) - 1;
    return b->rad * jump * ptie_rise(d / b->edge) * expf(-fmaxf(d, 0) / b->tail);
}

static void bow_line(const void *flow, float *value, const float *x, const float *y) {
    for (int i = 0; i < PTIE_LINE; i++) value[i] = bow_at(flow, x[i], y[i]);
}

static void draw_bow(float *map, const ptie_scene *scene, ptie_random *random,
                     const ptie_axes *axes, double rad, double beat) {
    bow_shock b = {.rad = (float)rad, .edge = 0.7f * axes->pixel};
    b.standoff = ptie_draw(random, 0.05, 0.2);
    b.mach = ptie_draw(random, 1.3, 3);
    b.tail = b.standoff * ptie_draw(random, 1, 6);
    b.slope = sqrtf(b.mach * b.mach - 1); /* far out it is a Mach wave: dx / dy = cot(mu) */
    b.standoff *= (float)(1 + beat);
    ptie_paint(map, scene, axes, bow_line, &b);
}

/* An oblique shock at each side of a wedge, which is opaque. */
typedef struct wedge {
    float shock, surface; /* slopes dy / dx */
    float rad, relief,
        edge; /* rad behind the shock; length over which it weakens; softness; units */
} wedge;

static float wedge_at(const wedge *w, float x, float y) {
    if (x < -w->edge) return 0;
    float aside = fabsf(y), steep = sqrtf(1 + w->shock * w->shock);
    float inside = ptie_rise((w->shock * x - aside) / (w->edge * steep));
    float outside = ptie_rise((aside - w->surface * x) / w->edge);
    return w->rad * inside * outside * w->relief / (w->relief + fmaxf(x, 0));
}

static void wedge_line(const void *flow, float *value, const float *x, const float *y) {
    for (int i = 0; i < PTIE_LINE; i++) value[i] = wedge_at(flow, x[i], y[i]);
}

static void draw_wedge(float *map, const ptie_scene *scene, ptie_random *random,
                       const ptie_axes *axes, double rad, double beat) {
    double mach = ptie_random_uniform(random, 1.5, 3.5), mach_angle = asin(1 / mach);
    double share = ptie_random_uniform(random, 0.2, 0.7) * (1 + beat);
    double beta = mach_angle + share * (1.1 - mach_angle); /* 63 deg: the shock is still attached */
    double jump = ptie_shock_density(GAMMA, mach * sin(beta)) - 1;
    wedge w = {.shock = (float)tan(beta),
               .surface = (float)tan(ptie_oblique_deflection(GAMMA, mach, beta)),
               .rad = (float)(rad * jump),
               .relief = ptie_draw(random, 0.5, 3),
               .edge = 0.7f * axes->pixel};
    ptie_paint(map, scene, axes, wedge_line, &w);
}

static ptie_status physical(float *map, const ptie_scene *scene, ptie_random *random) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ACROSS, 0.15, 0.4, 0.4);
    double path = ptie_scene_rad(scene);
    double rad = path * ptie_ambient_refractivity(), depth = ptie_random_uniform(random, 0.05, 0.4);
    double beat = beat_draw(scene, random), choice = ptie_random_uniform(random, 0, 1);
    if (choice < 0.55)
        draw_shells(map, scene, random, &axes, rad);
    else if (choice < 0.75)
        draw_wedge(map, scene, random, &axes, rad * depth, beat);
    else
        draw_bow(map, scene, random, &axes, rad * depth, beat);
    return PTIE_OK;
}

const ptie_morphology ptie_flow_shock = {"shock", "Shock front", parametric, physical};
