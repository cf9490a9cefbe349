/* SPDX-License-Identifier: BSD-3-Clause */
/* One morphology, and several of them combined with gradients and smoothing.  docs/math.md
 * (F1)-(F3). */
#include "flow/flow.h"

#include <math.h>

#include "base/image.h"
#include "base/memory.h"
#include "flow/blur.h"
#include "flow/morphology.h"

static ptie_scene scene_of(const ptie_flow_params *params) {
    return (ptie_scene){.width = params->width_px,
                        .height = params->height_px,
                        .pixel_m = params->pixel_m,
                        .wavelength_m = params->wavelength_m,
                        .time_s = params->time_s};
}

/* Scales to [0, 1].  A map without contrast (everything left the frame) becomes a ramp, so that no
   sample is constant. */
PTIE_CLONES static void normalise(float *map, const ptie_scene *scene) {
    size_t width = (size_t)scene->width, count = width * (size_t)scene->height;
    ptie_extent e = ptie_image_extent(map, count);
    float range = e.high - e.low;
    if (!(range > 1e-6f))
        for (size_t i = 0; i < count; i++) map[i] = (float)(i % width) / (float)(width - 1);
    else
        for (size_t i = 0; i < count; i++) map[i] = (map[i] - e.low) / range;
}

static ptie_status render(float *map, int32_t which, ptie_family family, const ptie_scene *scene,
                          ptie_random *random) {
    const ptie_morphology *morphology = ptie_morphology_get(which);
    if (family == PTIE_PHYSICAL) return morphology->physical(map, scene, random);
    PTIE_TRY(morphology->parametric(map, scene, random));
    normalise(map, scene);
    return PTIE_OK;
}

ptie_status ptie_flow_single(float *phase, int32_t morphology, const ptie_flow_params *params) {
    ptie_scene scene = scene_of(params);
    ptie_random random;
    /* The high bits of the seed separate the morphologies, so that they do not share their axes. */
    ptie_random_init(&random, params->seed ^ (uint64_t)(morphology + 1) << 56, PTIE_STREAM_FLOW,
                     params->index);
    return render(phase, morphology, params->family, &scene, &random);
}

/* How a member joins the ones before it. */
typedef enum blend { BLEND_SUM, BLEND_MAXIMUM, BLEND_ENVELOPE, BLENDS } blend;

typedef struct member {
    int32_t morphology;
    float height;
    blend blend;
    uint64_t key;
    bool aligned; /* lies along the same axis as the others that do */
} member;

static int32_t pick(const double *weight, ptie_random *random) {
    double total = 0;
    for (int32_t i = 0; i < PTIE_MORPHOLOGIES; i++) total += weight[i];
    double left = ptie_random_uniform(random, 0, total);
    for (int32_t i = 0; i < PTIE_MORPHOLOGIES - 1; i++) {
        if (left < weight[i]) return i;
        left -= weight[i];
    }
    return PTIE_MORPHOLOGIES - 1;
}

/* Phases of gases one behind the other add up; the parametric shapes combine in any way. */
static member member_draw(const ptie_flow_mix *mix, ptie_random *random) {
    member m = {.morphology = pick(mix->weight, random), .height = 1, .blend = BLEND_SUM};
    float height = ptie_draw(random, 0.35, 1);
    int32_t chosen = ptie_random_integer(random, 0, BLENDS - 1);
    m.key = ptie_key_draw(random);
    m.aligned = ptie_chance(random, 0.6);
    if (mix->family == PTIE_PARAMETRIC) m.height = height, m.blend = (blend)chosen;
    return m;
}

PTIE_CLONES static void join(float *map, const float *other, size_t count, const member *m) {
    const float height = m->height;
    switch (m->blend) {
    case BLEND_MAXIMUM:
        for (size_t i = 0; i < count; i++) map[i] = ptie_maxf(map[i], height * other[i]);
        break;
    case BLEND_ENVELOPE:
        for (size_t i = 0; i < count; i++)
            map[i] = map[i] * (0.25f + height * other[i]) + 0.25f * (height * other[i]);
        break;
    default:
        for (size_t i = 0; i < count; i++) map[i] += height * other[i];
    }
}

PTIE_CLONES static void add_ramp(float *map, const ptie_scene *scene, double share, double angle) {
    ptie_extent e =
        ptie_image_extent(map, (size_t)scene->width * (size_t)scene->height);
    double side = fabs(cos(angle)) * scene->width + fabs(sin(angle)) * scene->height;
    double slope = share * (double)(e.high - e.low) / side;
    float slope_x = (float)(slope * cos(angle)), slope_y = (float)(slope * sin(angle));
    for (int32_t y = 0; y < scene->height; y++) {
        float *row = map + (size_t)y * (size_t)scene->width;
        for (int32_t x = 0; x < scene->width; x++)
            row[x] += slope_x * (float)x + slope_y * (float)y;
    }
}

ptie_status ptie_flow_compose(float *phase, const ptie_flow_mix *mix,
                              const ptie_flow_params *params, uint32_t *morphologies) {
    ptie_scene scene = scene_of(params);
    size_t count = (size_t)scene.width * (size_t)scene.height;
    ptie_random random, own;
    ptie_random_init(&random, params->seed, PTIE_STREAM_FLOW, params->index);
    int32_t members =
        ptie_random_integer(&random, (int32_t)mix->components.low, (int32_t)mix->components.high);
    double smoothing = ptie_random_uniform(&random, mix->smoothing_px.low, mix->smoothing_px.high);
    double gradient = ptie_random_uniform(&random, mix->gradient.low, mix->gradient.high);
    double angle = ptie_random_uniform(&random, 0, 2 * acos(-1.0));
    uint64_t alignment = ptie_key_draw(&random) | 1;
    float *other;
    PTIE_TRY(ptie_alloc_status(&other, count, sizeof *other, "flow"));
    ptie_status status = PTIE_OK;
    uint32_t mask = 0;
    for (int32_t i = 0; i < members; i++) {
        member m = member_draw(mix, &random);
        if (i == 0) m.height = 1, m.blend = BLEND_SUM;
        scene.alignment = m.aligned ? alignment : 0;
        ptie_random_init(&own, m.key, PTIE_STREAM_FLOW, (uint64_t)i);
        PTIE_TRY_DONE(render(i == 0 ? phase : other, m.morphology, mix->family, &scene, &own));
        if (i > 0) join(phase, other, count, &m);
        mask |= UINT32_C(1) << m.morphology;
    }
    if (gradient > 0) add_ramp(phase, &scene, gradient, angle);
    PTIE_TRY_DONE(ptie_blur(phase, scene.width, scene.height, smoothing));
    if (mix->family == PTIE_PARAMETRIC) normalise(phase, &scene);
    if (morphologies) *morphologies = mask;
done:
    ptie_free(other);
    return status;
}

ptie_flow_mix ptie_flow_mix_paper(void) {
    return (ptie_flow_mix){
        .family = PTIE_PARAMETRIC,
        /* jet eddies front pockets fan diffusion shock combustion plasma random nozzle */
        .weight = {4, 3, 1.5, 2, 1.5, 1.5, 1.5, 2, 1, 1, 4},
        .components = {1, 3},
        .smoothing_px = {0.6, 2},
        .gradient = {0, 0.15},
    };
}

ptie_flow_mix ptie_flow_mix_realistic(void) {
    return (ptie_flow_mix){
        .family = PTIE_PHYSICAL,
        .weight = {4, 3, 1.5, 1.5, 1, 2, 2, 3, 1, 1, 4},
        .components = {1, 2},
        .smoothing_px = {0.4, 0.8},
        .gradient = {0, 0.3},
    };
}
