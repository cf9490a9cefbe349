/* SPDX-License-Identifier: BSD-3-Clause */
/* What every morphology stands on: the frame it fills, its own coordinates, and a painter. */
#ifndef PTIE_FLOW_SCENE_H
#define PTIE_FLOW_SCENE_H

#include "base/elementary.h"
#include "base/random.h"
#include "base/status.h"

typedef struct ptie_scene {
    int32_t width, height; /* px */
    double pixel_m, wavelength_m, time_s;
    uint64_t alignment; /* not 0: flows with the same number share direction and place */
} ptie_scene;

/* Flow coordinates: x runs downstream from the flow's origin, y across it, both in units of the
   frame's shorter side. */
typedef struct ptie_axes {
    float origin_x, origin_y; /* px */
    float cosine, sine;       /* of the flow direction; image rows run downwards */
    float mirror;             /* +1 or -1: handedness */
    float pixel;              /* one px in units */
    float start, end;         /* x where the frame begins and ends along the flow */
} ptie_axes;

typedef enum ptie_heading {
    PTIE_HEADING_ACROSS, /* mostly horizontal, either way */
    PTIE_HEADING_UP,     /* mostly upwards, as hot gas goes */
    PTIE_HEADING_ANY
} ptie_heading;

/* Draws a direction and an origin.  `origin` is where the origin lies along the flow: 0 at the
   frame's upstream end, 1 at its downstream end; `across` is its largest distance from the centre
   line as a share of the frame's half. */
ptie_axes ptie_axes_draw(const ptie_scene *scene, ptie_random *random, ptie_heading heading,
                         double origin_low, double origin_high, double across);

/* Flow coordinates of a random point in the middle `share` of the frame. */
void ptie_place_draw(const ptie_scene *scene, ptie_random *random, const ptie_axes *axes,
                     double share, float *x, float *y);

/* Length of a unit in m. */
double ptie_scene_unit_m(const ptie_scene *scene);
/* A convection speed in units per second: 2 .. 12 m/s, which at 25,000 frames/s and 20 um pixels is
   4 .. 24 px per frame. */
double ptie_speed_draw(const ptie_scene *scene, ptie_random *random);
/* Phase (rad) of a path of one unit where n - 1 exceeds the air's by 1: 2 pi / lambda times the
 * unit. */
double ptie_scene_rad(const ptie_scene *scene);

/* Flows are painted by lines of points, in loops that vectorise. */
#define PTIE_LINE 64
/* value (out): the flow at points of its coordinates, all arrays of PTIE_LINE. */
typedef void (*ptie_line)(const void *flow, float *value, const float *x, const float *y);
/* map = what `line` says, everywhere. */
void ptie_paint(float *map, const ptie_scene *scene, const ptie_axes *axes, ptie_line line,
                const void *flow);

/* map = 0 everywhere. */
void ptie_clear(float *map, const ptie_scene *scene);

/* A Gaussian spot with half-axes (standard deviations) along and across the direction `angle`. */
typedef struct ptie_spot {
    float x, y; /* flow coordinates */
    float along, across, angle, height;
} ptie_spot;
/* Adds a spot, out to 3.5 standard deviations. */
void ptie_splat(float *map, const ptie_scene *scene, const ptie_axes *axes, const ptie_spot *spot);

/* Adds radial(context, r), r in units from the point (x, y), where r < reach. */
typedef float (*ptie_radial_point)(const void *context, float r);
void ptie_stamp(float *map, const ptie_scene *scene, const ptie_axes *axes, float x, float y,
                float reach, ptie_radial_point radial, const void *context);

/* Things that follow each other downstream at a spacing, born upstream from the hash of their
   number: calls for the numbers whose place (number * spacing + shift) lies in start .. end. */
typedef struct ptie_train {
    double spacing, shift; /* units; shift = speed * time */
    int64_t first, last;
} ptie_train;
ptie_train ptie_train_make(double spacing, double shift, double start, double end);
/* Place of car `number`, and its own random numbers. */
double ptie_train_car(const ptie_train *train, int64_t number, uint64_t key, ptie_random *random);

/* 64 random bits, to key something. */
uint64_t ptie_key_draw(ptie_random *random);
/* True with the given chance. */
bool ptie_chance(ptie_random *random, double probability);
/* uniform and log-uniform as float. */
float ptie_draw(ptie_random *random, double low, double high);
float ptie_draw_log(ptie_random *random, double low, double high);

/* exp(-t^2 / 2); 0 beyond |t| = 6, where it is below 1.5e-8. */
PTIE_INLINE float ptie_bell(float t) {
    return fabsf(t) > 6 ? 0 : ptie_expf(-0.5f * t * t);
}

/* 0 -> 1 over t = 0 .. 1, with continuous slope. */
PTIE_INLINE float ptie_smoothstep(float t) {
    const float s = ptie_minf(ptie_maxf(t, 0), 1);
    return s * s * (3 - 2 * s);
}

/* 0 -> 1 around t = 0, as (1 + tanh t) / 2; 0 where that is below 1.5e-8. */
PTIE_INLINE float ptie_rise(float t) {
    return t < -9 ? 0 : 1 / (1 + ptie_expf(-2 * t));
}

#endif
