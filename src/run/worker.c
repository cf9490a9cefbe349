/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/worker.h"

#include "base/image.h"
#include "base/memory.h"
#include "nn/nn.h"
#include "run/planes.h"
#include "tie/solver.h"

struct ptie_frame_plan {
    int32_t width, height;
    const uint8_t *mask;
    bool zero_border;
    int32_t polarity;
    ptie_solver *solver;
    ptie_denoiser *denoiser; /* NULL without a model */
    double noise_rad;        /* per unit of relative noise */
    int32_t workers;
    void **scratch; /* one block per worker */
};

static size_t scratch_bytes(const ptie_frame_plan *plan) {
    size_t bytes = 2 * ((size_t)plan->width + (size_t)plan->height) * sizeof(float); /* pin_border */
    size_t solver = ptie_tie_scratch(plan->solver);
    size_t denoiser = plan->denoiser ? ptie_nn_denoiser_scratch(plan->denoiser) : 0;
    if (bytes < solver) bytes = solver;
    return bytes < denoiser ? denoiser : bytes;
}

static ptie_status build(ptie_frame_plan *plan, const ptie_engine *engine, const ptie_rig *rig,
                         const ptie_model *model, const ptie_denoiser_params *params) {
    ptie_solver_params solver = ptie_rig_solver(rig, plan->width, plan->height);
    solver.mask = plan->mask;
    PTIE_TRY(ptie_tie_plan(&plan->solver, &solver));
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
    ptie_denoiser_free(plan->denoiser);
    ptie_free(plan);
}

/* The mean of a TIE phase is not measured; the level around the flow becomes 0. */
static void pin_border(const ptie_frame_plan *plan, float *phase, float *border) {
    const float level = (float)ptie_image_border_median(phase, plan->width, plan->height, border);
    for (ptrdiff_t i = 0; i < (ptrdiff_t)plan->width * plan->height; i++)
        if (!plan->mask || plan->mask[i]) phase[i] -= level;
}

ptie_status ptie_frame_solve(const ptie_frame_plan *plan, int32_t worker, float *phase, float *denoised,
                             const float *const *planes) {
    void *scratch = plan->scratch[worker];
    PTIE_TRY(ptie_tie_solve(plan->solver, phase, planes, scratch, NULL));
    if (plan->zero_border) pin_border(plan, phase, scratch);
    if (!plan->denoiser) return PTIE_OK;
    return ptie_nn_denoise_rad(plan->denoiser, denoised, phase, plan->polarity, scratch);
}

double ptie_frame_noise_rad(const ptie_frame_plan *plan, double sigma) {
    return sigma * plan->noise_rad;
}

void ptie_frame_trusted(const ptie_frame_plan *plan, uint8_t *trusted) {
    ptie_tie_border(plan->solver, trusted);
}
