/* SPDX-License-Identifier: BSD-3-Clause */
#include "simulate/studio.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/random.h"
#include "optics/camera.h"
#include "optics/optics.h"

#define PARAMETRIC_RAD 1.0 /* phase of the value 1 unless the caller says */

struct ptie_studio {
    const ptie_simulate_params *params;
    ptie_optics *optics;
    ptie_camera *camera; /* NULL: none */
    size_t pixels;
    float factor;                    /* of the rendered flow, to rad */
    float *light; /* intensity at the object; NULL: 1 */
    /* Planes without flow, and of the target; NULL without a camera. */
    float *still_plus, *still_minus, *target_plus, *target_minus;
};

typedef struct studio_work {
    float *plus, *minus;
    void *plan; /* scratch of the optics, then of the camera */
} studio_work;

static studio_work carve(const ptie_studio *studio, ptie_slicer *slicer) {
    const size_t optics = ptie_optics_scratch(studio->optics),
                 camera = studio->camera ? ptie_camera_scratch(studio->camera) : 0;
    return (studio_work){.plus = ptie_slice(slicer, studio->camera ? studio->pixels : 0, sizeof(float)),
                        .minus = ptie_slice(slicer, studio->camera ? studio->pixels : 0, sizeof(float)),
                        .plan = ptie_slice(slicer, optics > camera ? optics : camera, 1)};
}

size_t ptie_studio_scratch(const ptie_studio *studio) {
    ptie_slicer slicer = {0};
    carve(studio, &slicer);
    return slicer.used;
}

int32_t ptie_studio_images(const ptie_studio *studio) {
    return studio->camera ? studio->camera->sensors : 2;
}

static ptie_status render(const ptie_studio *studio, int64_t frame, float *phase) {
    ptie_flow_params flow = studio->params->flow;
    flow.time_s += (double)frame / studio->params->frame_rate_hz;
    PTIE_TRY(ptie_flow_render(phase, &flow));
    for (size_t i = 0; i < studio->pixels; i++) phase[i] *= studio->factor;
    return PTIE_OK;
}

/* Planes of a phase.  Diffraction takes the light along; the linear TIE is for even light, whose planes are then
   multiplied by what there is (C1). */
static ptie_status propagate(const ptie_studio *studio, float *plus, float *minus, const float *phase, void *scratch) {
    const bool diffraction = studio->params->propagation == PTIE_ANGULAR_SPECTRUM;
    PTIE_TRY(ptie_optics_defocus(studio->optics, plus, minus, phase, diffraction ? studio->light : NULL, scratch));
    for (size_t i = 0; studio->light && !diffraction && i < studio->pixels; i++) {
        plus[i] = fmaxf(0, plus[i]) * studio->light[i];
        minus[i] = fmaxf(0, minus[i]) * studio->light[i];
    }
    return PTIE_OK;
}

static ptie_status plan_optics(ptie_studio *studio) {
    const ptie_simulate_params *p = studio->params;
    ptie_optics_params optics;
    ptie_optics_params_init(&optics);
    optics.width_px = p->flow.width_px;
    optics.height_px = p->flow.height_px;
    optics.pixel_m = p->flow.pixel_m;
    optics.wavelength_m = p->flow.wavelength_m;
    optics.defocus_m = p->defocus_m;
    optics.boundary = p->boundary;
    optics.propagation = p->propagation;
    return ptie_optics_plan(&studio->optics, &optics);
}

static ptie_status plan_camera(ptie_studio *studio) {
    const ptie_flow_params *flow = &studio->params->flow;
    PTIE_TRY(ptie_camera_plan(&studio->camera, studio->params->camera, flow->width_px, flow->height_px, flow->pixel_m,
                              flow->seed));
    float **const maps[] = {&studio->light, &studio->still_plus, &studio->still_minus, &studio->target_plus,
                            &studio->target_minus};
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++)
        PTIE_TRY(ptie_alloc_status(maps[i], studio->pixels, sizeof(float), "planes without flow"));
    return PTIE_OK;
}

/* A physical flow is scaled by what frame 0 needs, so that it still grows and fades as it does. */
static ptie_status find_factor(ptie_studio *studio, float *phase) {
    const ptie_simulate_params *p = studio->params;
    studio->factor = 1;
    if (p->flow.family == PTIE_PARAMETRIC) {
        studio->factor = (float)(p->amplitude_rad > 0 ? p->amplitude_rad : PARAMETRIC_RAD);
    } else if (p->amplitude_rad > 0) {
        float peak = 0;
        PTIE_TRY(render(studio, 0, phase));
        for (size_t i = 0; i < studio->pixels; i++) peak = fmaxf(peak, fabsf(phase[i]));
        if (peak > 0) studio->factor = (float)p->amplitude_rad / peak;
    }
    return PTIE_OK;
}

/* Planes without flow, first of the light with the target in it, then of the light alone. */
static ptie_status light_still_planes(ptie_studio *studio, float *phase) {
    void *scratch;
    PTIE_TRY(ptie_alloc_status(&scratch, ptie_optics_scratch(studio->optics), 1, "scratch of the optics"));
    memset(phase, 0, studio->pixels * sizeof *phase);
    ptie_camera_illuminate(studio->camera, studio->light);
    ptie_camera_target(studio->camera, studio->light);
    ptie_status status = propagate(studio, studio->target_plus, studio->target_minus, phase, scratch);
    ptie_camera_illuminate(studio->camera, studio->light);
    if (status == PTIE_OK) status = propagate(studio, studio->still_plus, studio->still_minus, phase, scratch);
    ptie_free(scratch);
    return status;
}

/* What needs an image of its own: the flow's scale, and the planes without flow. */
static ptie_status look_ahead(ptie_studio *studio) {
    float *phase;
    PTIE_TRY(ptie_alloc_status(&phase, studio->pixels, sizeof *phase, "simulation"));
    ptie_status status = find_factor(studio, phase);
    if (status == PTIE_OK && studio->camera) status = light_still_planes(studio, phase);
    ptie_free(phase);
    return status;
}

ptie_status ptie_studio_create(ptie_studio **out, const ptie_simulate_params *params) {
    ptie_studio *studio;
    *out = NULL;
    PTIE_TRY(ptie_alloc_status(&studio, 1, sizeof *studio, "simulation"));
    studio->params = params;
    studio->pixels = (size_t)params->flow.width_px * (size_t)params->flow.height_px;
    ptie_status status = plan_optics(studio);
    if (status == PTIE_OK && params->camera) status = plan_camera(studio);
    if (status == PTIE_OK) status = look_ahead(studio);
    if (status != PTIE_OK) {
        ptie_studio_free(studio);
        return status;
    }
    *out = studio;
    return PTIE_OK;
}

void ptie_studio_free(ptie_studio *studio) {
    if (!studio) return;
    ptie_optics_free(studio->optics);
    ptie_camera_free(studio->camera);
    ptie_free(studio->light);
    ptie_free(studio->still_plus);
    ptie_free(studio->still_minus);
    ptie_free(studio->target_plus);
    ptie_free(studio->target_minus);
    ptie_free(studio);
}

/* Without a camera: white noise on both planes. */
static ptie_status frame_of_planes(const ptie_studio *studio, float *plus, float *minus, float *phase, int64_t frame,
                                   void *scratch) {
    const ptie_simulate_params *p = studio->params;
    PTIE_TRY(render(studio, frame, phase));
    PTIE_TRY(propagate(studio, plus, minus, phase, scratch));
    ptie_add_gaussian_noise(plus, studio->pixels, p->noise, p->flow.seed, PTIE_STREAM_NOISE_PLUS, (uint64_t)frame);
    ptie_add_gaussian_noise(minus, studio->pixels, p->noise, p->flow.seed, PTIE_STREAM_NOISE_MINUS, (uint64_t)frame);
    return PTIE_OK;
}

ptie_status ptie_studio_frame(const ptie_studio *studio, float *const *image, float *phase, ptie_exposure exposure,
                             int64_t frame, void *scratch) {
    const studio_work work = carve(studio, &(ptie_slicer){.base = scratch});
    if (!studio->camera) return frame_of_planes(studio, image[0], image[1], phase, frame, work.plan);
    const bool target = exposure == PTIE_EXPOSE_TARGET;
    const float *plus = target ? studio->target_plus : studio->still_plus,
                *minus = target ? studio->target_minus : studio->still_minus;
    if (exposure == PTIE_EXPOSE_FLOW) {
        PTIE_TRY(render(studio, frame, phase));
        PTIE_TRY(propagate(studio, work.plus, work.minus, phase, work.plan));
        plus = work.plus, minus = work.minus;
    }
    ptie_camera_capture(studio->camera, image, plus, minus, exposure, frame, work.plan);
    return PTIE_OK;
}
