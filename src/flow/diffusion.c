/* SPDX-License-Identifier: BSD-3-Clause */
/* Gas diffusion: an ever wider Gaussian, as a plume or as puffs.  docs/math.md (F5), (F13). */
#include "flow/diffusion.h"

#include <math.h>

#include "flow/gas.h"
#include "flow/morphology.h"
#include "flow/stream.h"

typedef struct plume {
    ptie_stream stream;
    ptie_diffusion diffusion;
    float height; /* of a path of one unit: 1, or rad */
} plume;

/* Diffusion widens with the square root of the distance, unlike the stream's linear spread. */
PTIE_CLONES static void line(const void *flow, float *value, const float *x, const float *y) {
    const plume *p = flow;
    const ptie_diffusion diffusion = p->diffusion;
    ptie_parcels parcels;
    ptie_stream_line(&p->stream, &parcels, x, y);
    for (int i = 0; i < PTIE_LINE; i++) {
        float growth = ptie_diffusion_growth(&diffusion, parcels.x[i]);
        float r = parcels.across[i] * parcels.width[i] / (diffusion.start * growth);
        float begun = ptie_smoothstep(x[i] / diffusion.lag + 0.5f);
        value[i] = p->height * ptie_plume_depth(&diffusion, growth) * ptie_bell(r) * begun;
    }
}

static ptie_status draw_plume(float *map, const ptie_scene *scene, ptie_random *random,
                              float height) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ACROSS, -0.1, 0.35, 0.4);
    ptie_stream_ranges ranges = {0.015, 0.08, 0, 0, 0, 0.25};
    plume p = {.height = height};
    p.diffusion.lag = ptie_draw_log(random, 0.02, 0.3) * axes.end;
    PTIE_TRY(ptie_stream_draw(&p.stream, scene, random, &ranges, (double)axes.end));
    p.diffusion.start = p.stream.radius;
    p.stream.reach = 5 * ptie_diffusion_growth(&p.diffusion, axes.end);
    ptie_paint(map, scene, &axes, line, &p);
    ptie_stream_free(&p.stream);
    return PTIE_OK;
}

/* Puffs released one after the other, a unit before the frame at the latest. */
static ptie_status draw_puffs(float *map, const ptie_scene *scene, ptie_random *random,
                              float height) {
    ptie_axes axes = ptie_axes_draw(scene, random, PTIE_HEADING_ANY, 0.0, 0.2, 0.3);
    ptie_diffusion diffusion = {.start = ptie_draw(random, 0.02, 0.06)};
    float widening = ptie_draw(random, 0.05, 0.2); /* standard deviation two units on */
    double aside = ptie_random_uniform(random, 0, 0.25);
    double speed = 0.4 * ptie_speed_draw(scene, random);
    double spacing = ptie_random_uniform(random, 0.25, 0.7);
    float roundness = ptie_draw(random, 0.5, 1);
    uint64_t key = ptie_key_draw(random);
    diffusion.lag = 2 * diffusion.start * diffusion.start / (widening * widening);
    ptie_train train = ptie_train_make(spacing, speed * scene->time_s, (double)axes.start - 1,
                                       (double)axes.end + 0.5);
    for (int64_t n = train.first; n <= train.last; n++) {
        ptie_random own;
        float x = (float)ptie_train_car(&train, n, key, &own);
        float growth = ptie_diffusion_growth(&diffusion, x - axes.start + 1);
        float sigma = diffusion.start * growth, tall = ptie_draw(&own, 0.4, 1);
        float y = (float)(aside * ptie_random_normal(&own)), angle = ptie_draw(&own, 0, 3.1416);
        ptie_spot spot = {x,     y,
                          sigma, sigma * roundness,
                          angle, height * tall * ptie_puff_depth(&diffusion, growth)};
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
