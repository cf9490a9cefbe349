/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/worker.h"

#include "base/image.h"
#include "base/memory.h"
#include "nn/nn.h"
#include "prep/prep.h"
#include "prep/surface.h"
#include "rig/planes.h"
#include "tie/solver.h"

struct ptie_frame_plan {
    int32_t width, height;
    const uint8_t *mask;
    bool zero_border;
    ptie_rect still;       /* its mean becomes 0; empty: none */
    float *background;     /* off every phase, or NULL */
    ptie_surface *surface; /* fitted outside the flow and taken off, or NULL */
    int32_t polarity;
    ptie_solver *solver;
    ptie_denoiser *denoiser; /* NULL without a model */
    double noise_rad;        /* per unit of relative noise */
    int32_t workers;
    void **scratch; /* one block per worker */
};

static size_t larger(size_t a, size_t b) {
    return a > b ? a : b;
}

static size_t scratch_bytes(const ptie_frame_plan *plan) {
    size_t bytes = 2 * ((size_t)plan->width + (size_t)plan->height) * sizeof(float); /* pin_border */
    bytes = larger(bytes, ptie_tie_scratch(plan->solver));
    if (plan->surface) bytes = larger(bytes, ptie_prep_surface_scratch(plan->surface));
    return plan->denoiser ? larger(bytes, ptie_nn_denoiser_scratch(plan->denoiser)) : bytes;
}

/* The flow stands out of the background and is rejected as such. */
static ptie_status plan_surface(ptie_frame_plan *plan, ptie_background background) {
    const ptie_surface_params params = {.struct_size = sizeof params,
                                        .width_px = plan->width,
                                        .height_px = plan->height,
                                        .degree = background == PTIE_BACKGROUND_PLANE ? 1 : PTIE_SURFACE_DEGREE,
                                        .rounds = 10,
                                        .reject = 3};
    return background == PTIE_BACKGROUND_NONE ? PTIE_OK : ptie_prep_surface(&plan->surface, &params, plan->mask);
}

/* A region without flow lies in the phase. */
static ptie_status check_still(const ptie_frame_plan *plan) {
    const ptie_rect *r = &plan->still;
    if (r->width_px <= plan->width - r->x_px && r->height_px <= plan->height - r->y_px) return PTIE_OK;
    return PTIE_FAIL(PTIE_EINVAL, "rig: [flow] still leaves the phase (expected a part of %d x %d px, found %d,%d,%d,%d)",
                     plan->width, plan->height, r->x_px, r->y_px, r->width_px, r->height_px);
}

static ptie_status build(ptie_frame_plan *plan, const ptie_engine *engine, const ptie_rig *rig,
                         const ptie_model *model, const ptie_denoiser_params *params) {
    ptie_solver_params solver = ptie_rig_solver(rig, plan->width, plan->height);
    solver.mask = plan->mask;
    PTIE_TRY(check_still(plan));
    PTIE_TRY(ptie_tie_plan(&plan->solver, &solver));
    PTIE_TRY(plan_surface(plan, rig->background));
    plan->noise_rad = ptie_tie_noise_rad(plan->solver, 1);
    if (model)
        PTIE_TRY(ptie_nn_denoiser(&plan->denoiser, engine, model, plan->width, plan->height,
                                  params));
    PTIE_TRY(ptie_alloc_status(&plan->scratch, (size_t)plan->workers, sizeof *plan->scratch, "run"));
    for (int32_t i = 0; i < plan->workers; i++)
        PTIE_TRY(ptie_alloc_status(&plan->scratch[i], scratch_bytes(plan), 1, "run: scratch"));
    return PTIE_OK;
}

ptie_status ptie_frame_plan_create(ptie_frame_plan **out, const ptie_engine *engine,
                                   const ptie_rig *rig, const uint8_t *mask, const ptie_model *model,
                                   int32_t width_px, int32_t height_px, const ptie_denoiser_params *params) {
    *out = NULL;
    ptie_frame_plan *plan;
    PTIE_TRY(ptie_alloc_status(&plan, 1, sizeof *plan, "run"));
    plan->width = width_px;
    plan->height = height_px;
    plan->mask = mask;
    plan->zero_border = rig->zero_border;
    plan->still = rig->still;
    plan->polarity = rig->polarity;
    plan->workers = ptie_pool_threads(engine->pool);
    ptie_status status = build(plan, engine, rig, model, params);
    if (status == PTIE_OK)
        *out = plan;
    else
        ptie_frame_plan_free(plan);
    return status;
}

void ptie_frame_plan_free(ptie_frame_plan *plan) {
    if (!plan) return;
    for (int32_t i = 0; plan->scratch && i < plan->workers; i++) ptie_free(plan->scratch[i]);
    ptie_free(plan->scratch);
    ptie_solver_free(plan->solver);
    ptie_surface_free(plan->surface);
    ptie_free(plan->background);
    ptie_denoiser_free(plan->denoiser);
    ptie_free(plan);
}

/* The mean of a TIE phase is not measured; the level around the flow becomes 0. */
static void pin_border(const ptie_frame_plan *plan, float *phase, float *border) {
    const float level = (float)ptie_image_border_median(phase, plan->width, plan->height, border);
    for (ptrdiff_t i = 0; i < (ptrdiff_t)plan->width * plan->height; i++)
        if (!plan->mask || plan->mask[i]) phase[i] -= level;
}

void ptie_frame_plan_set_background(ptie_frame_plan *plan, float *background) {
    plan->background = background;
}

/* What is not flow comes off the phase, and its level becomes 0. */
static ptie_status remove_background(const ptie_frame_plan *plan, float *phase, void *scratch) {
    const ptrdiff_t pixels = (ptrdiff_t)plan->width * plan->height;
    for (ptrdiff_t i = 0; plan->background && i < pixels; i++) phase[i] -= plan->background[i];
    if (plan->surface) PTIE_TRY(ptie_prep_surface_remove(plan->surface, phase, scratch));
    if (plan->still.width_px > 0)
        ptie_prep_pin(phase, plan->width, plan->height, plan->still);
    else if (plan->zero_border)
        pin_border(plan, phase, scratch);
    return PTIE_OK;
}

static ptie_status clean(const ptie_frame_plan *plan, void *scratch, float *phase, float *denoised) {
    PTIE_TRY(remove_background(plan, phase, scratch));
    if (!plan->denoiser || !denoised) return PTIE_OK;
    return ptie_nn_denoise_rad(plan->denoiser, denoised, phase, plan->polarity, scratch);
}

ptie_status ptie_frame_solve(const ptie_frame_plan *plan, int32_t worker, float *phase, float *denoised,
                             const float *const *planes) {
    PTIE_TRY(ptie_tie_solve(plan->solver, phase, planes, plan->scratch[worker], NULL));
    return clean(plan, plan->scratch[worker], phase, denoised);
}

ptie_status ptie_frame_solve_measured(const ptie_frame_plan *plan, int32_t worker, float *phase, float *denoised,
                                      float *measured, const float *const *planes) {
    PTIE_TRY(ptie_tie_solve_direct(plan->solver, phase, measured, planes, plan->scratch[worker]));
    return clean(plan, plan->scratch[worker], phase, denoised);
}

double ptie_frame_noise_rad(const ptie_frame_plan *plan, double sigma) {
    return sigma * plan->noise_rad;
}

void ptie_frame_trusted(const ptie_frame_plan *plan, uint8_t *trusted) {
    ptie_tie_border(plan->solver, trusted);
}
