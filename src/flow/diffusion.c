/* SPDX-License-Identifier: BSD-3-Clause */
/* Gas diffusion: an ever wider Gaussian, as a plume or as puffs.  docs/math.md (F5), (F7). */
#include <math.h>

#include "flow/gas.h"
#include "flow/morphology.h"
#include "flow/stream.h"

typedef struct plume {
    ptie_stream stream;
    float height; /* at the source: 1, or rad per unit of path */
    float fade;   /* power of the dilution: 1 in a plane, 2 in space */
    float lag;    /* virtual origin: width^2 = radius^2 + 2 D x, as x / lag */
} plume;

/* Diffusion widens with the square root of the distance, unlike the stream's linear spread. */
PTIE_CLONES static void line(const void *flow, float *value, const float *x, const float *y) {
    const plume *p = flow;
    ptie_parcels parcels;
    ptie_stream_line(&p->stream, &parcels, x, y);
    for (int i = 0; i < PTIE_LINE; i++) {
        ptie_parcel parcel = ptie_parcel_of(&parcels, i);
        float growth = sqrtf(1 + ptie_maxf(parcel.x, 0) / p->lag);
        float r = parcel.across * parcel.width / (p->stream.radius * growth);
        float begun = ptie_smoothstep((x[i] + 0.5f * p->lag) / p->lag);
        value[i] = p->height * ptie_bell(r) * begun / (p->fade > 1 ? growth * growth : growth);
    }
}

static ptie_status draw_plume(float *map, const ptie_scene *scene, ptie_random *random,
                              float height) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ACROSS, -0.1, 0.35, 0.4);
    ptie_stream_ranges ranges = {0.015, 0.08, 0, 0, 0, 0.25};
    plume p = {.height = height, .fade = (float)ptie_random_integer(random, 1, 2)};
    p.lag = ptie_draw_log(random, 0.02, 0.3) * axes.end;
    PTIE_TRY(ptie_stream_draw(&p.stream, scene, random, &ranges, (double)axes.end));
    p.height *= p.stream.radius;
    p.stream.reach = 5 * sqrtf(1 + axes.end / p.lag);
    ptie_paint(map, scene, &axes, line, &p);
    ptie_stream_free(&p.stream);
    return PTIE_OK;
}

/* Puffs released one after the other: sigma^2 = sigma0^2 + 2 D t, height by what the puff holds. */
static ptie_status draw_puffs(float *map, const ptie_scene *scene, ptie_random *random,
                              float height) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ANY, 0.0, 0.2, 0.3);
    double start = ptie_random_uniform(random, 0.02, 0.06);
    double widening = ptie_random_uniform(random, 0.05, 0.2);
    double aside = ptie_random_uniform(random, 0, 0.25);
    double speed = 0.4 * ptie_speed_draw(scene, random);
    double spacing = ptie_random_uniform(random, 0.25, 0.7);
    double roundness = ptie_random_uniform(random, 0.5, 1);
    uint64_t key = ptie_key_draw(random);
    ptie_train train = ptie_train_make(spacing, speed * scene->time_s, (double)axes.start - 1,
                                       (double)axes.end + 0.5);
    for (int64_t n = train.first; n <= train.last; n++) {
        ptie_random own;
        double x = ptie_train_car(&train, n, key, &own);
        double age = x - (double)axes.start + 1;
        double sigma = sqrt(start * start + widening * widening * age * age / 4);
        float tall = ptie_draw(&own, 0.4, 1), y = (float)(aside * ptie_random_normal(&own));
        float angle = ptie_draw(&own, 0, 3.1416);
        ptie_spot spot = {(float)x,     y,
                          (float)sigma, (float)(sigma * roundness),
                          angle,        height * tall * (float)(start * start / sigma)};
        ptie_splat(map, scene, &axes, &spot);
    }
    return PTIE_OK;
}

static ptie_status draw(float *map, const ptie_scene *scene, ptie_random *random, float height) {
    if (ptie_chance(random, 0.65)) return draw_plume(map, scene, random, height);
    ptie_clear(map, scene);
    return draw_puffs(map, scene, random, height);
}

static ptie_status parametric(float *map, const ptie_scene *scene, ptie_random *random) {
    return draw(map, scene, random, 1);
}

/* Another gas at the pressure and temperature of the air. */
static ptie_status physical(float *map, const ptie_scene *scene, ptie_random *random) {
    static const ptie_gas_kind kinds[] = {PTIE_HELIUM, PTIE_CARBON_DIOXIDE, PTIE_METHANE,
                                          PTIE_HYDROGEN};
    const ptie_gas *gas = ptie_gas_get(kinds[ptie_random_integer(random, 0, 3)]);
    double step =
        ptie_gas_refractivity(gas, PTIE_AMBIENT_PA, PTIE_AMBIENT_K) - ptie_ambient_refractivity();
    double path = ptie_scene_rad(scene);
    return draw(map, scene, random, (float)(PTIE_GAUSSIAN_DEPTH * path * step));
}

const ptie_morphology ptie_flow_diffusion = {"diffusion", "Gas diffusion", parametric, physical};
