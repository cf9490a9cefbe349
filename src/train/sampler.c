/* SPDX-License-Identifier: BSD-3-Clause */
#include "train/sampler.h"

#include "base/clones.h"
#include "base/image.h"
#include "base/memory.h"
#include "base/random.h"
#include "optics/optics.h"
#include "tie/solver.h"

struct ptie_sampler {
    const ptie_preset *preset;
    size_t pixels;
    ptie_optics *optics;
    ptie_solver *solver;
};

static ptie_status plan_optics(ptie_sampler *sampler) {
    const ptie_preset *preset = sampler->preset;
    ptie_optics_params params;
    ptie_optics_params_init(&params);
    params.width_px = preset->width_px;
    params.height_px = preset->height_px;
    params.pixel_m = preset->pixel_m;
    params.wavelength_m = preset->wavelength_m;
    params.defocus_m = preset->defocus_m;
    params.boundary = (ptie_boundary)preset->boundary;
    params.propagation = (ptie_propagation)preset->propagation;
    return ptie_optics_plan(&sampler->optics, &params);
}

static ptie_status plan_solver(ptie_sampler *sampler) {
    const ptie_preset *preset = sampler->preset;
    ptie_solver_params params;
    ptie_solver_params_init(&params);
    params.width_px = preset->width_px;
    params.height_px = preset->height_px;
    params.pixel_m = preset->pixel_m;
    params.wavelength_m = preset->wavelength_m;
    params.z_m[0] = preset->defocus_m;
    params.z_m[1] = -preset->defocus_m;
    params.boundary = (ptie_boundary)preset->boundary;
    return ptie_tie_plan(&sampler->solver, &params);
}

ptie_status ptie_sampler_create(ptie_sampler **out, const ptie_preset *preset) {
    *out = NULL;
    ptie_sampler *sampler;
    PTIE_TRY(ptie_alloc_status(&sampler, 1, sizeof *sampler, "sampler"));
    sampler->preset = preset;
    sampler->pixels = (size_t)preset->width_px * (size_t)preset->height_px;
    ptie_status status = plan_optics(sampler);
    if (status == PTIE_OK) status = plan_solver(sampler);
    if (status != PTIE_OK) {
        ptie_sampler_free(sampler);
        return status;
    }
    *out = sampler;
    return PTIE_OK;
}

void ptie_sampler_free(ptie_sampler *sampler) {
    if (!sampler) return;
    ptie_optics_free(sampler->optics);
    ptie_solver_free(sampler->solver);
    ptie_free(sampler);
}

typedef struct drawing {
    float *i_plus, *i_minus;
    void *plan; /* scratch of optics, then of the solver */
} drawing;

static drawing slice_drawing(const ptie_sampler *sampler, ptie_slicer *slicer) {
    size_t optics = ptie_optics_scratch(sampler->optics),
           solver = ptie_tie_scratch(sampler->solver);
    return (drawing){
        .i_plus = ptie_slice(slicer, sampler->pixels, sizeof(float)),
        .i_minus = ptie_slice(slicer, sampler->pixels, sizeof(float)),
        .plan = ptie_slice(slicer, optics > solver ? optics : solver, 1),
    };
}

size_t ptie_sampler_scratch(const ptie_sampler *sampler) {
    ptie_slicer slicer = {0};
    slice_drawing(sampler, &slicer);
    return slicer.used;
}

/* Phase in rad relative to the undisturbed gas. */
static ptie_status draw_flow(const ptie_sampler *sampler, uint64_t seed, uint64_t index,
                             double amplitude_rad, float *phase_rad, uint32_t *morphologies) {
    const ptie_preset *preset = sampler->preset;
    ptie_flow_params params;
    ptie_flow_params_init(&params);
    params.width_px = preset->width_px;
    params.height_px = preset->height_px;
    params.pixel_m = preset->pixel_m;
    params.wavelength_m = preset->wavelength_m;
    params.family = preset->mix.family;
    params.seed = seed;
    params.index = index;
    PTIE_TRY(ptie_flow_compose(phase_rad, &preset->mix, &params, morphologies));
    if (preset->mix.family == PTIE_PARAMETRIC)
        for (size_t i = 0; i < sampler->pixels; i++) phase_rad[i] *= (float)amplitude_rad;
    return PTIE_OK;
}

/* To [0, 1]; a constant map becomes 0 with scale 0. */
PTIE_CLONES static void normalise(float *map, size_t count, float *offset, float *scale) {
    const ptie_extent e = ptie_image_extent(map, count);
    const float range = e.high - e.low, divisor = range > 0 ? range : 1;
    for (size_t i = 0; i < count; i++) map[i] = (map[i] - e.low) / divisor;
    *offset = e.low;
    *scale = range;
}

ptie_status ptie_sampler_draw(const ptie_sampler *sampler, uint64_t seed, uint64_t index,
                              float *clean, float *noisy, ptie_sample_info *info, void *scratch) {
    const ptie_preset *preset = sampler->preset;
    const size_t pixels = sampler->pixels;
    ptie_slicer slicer = {.base = scratch};
    const drawing d = slice_drawing(sampler, &slicer);

    ptie_random random;
    ptie_random_init(&random, seed, PTIE_STREAM_CAMERA, index);
    const double amplitude_rad =
        ptie_random_uniform(&random, preset->amplitude_rad.low, preset->amplitude_rad.high);
    const ptie_range noise = preset->noise;
    const double sigma =
        noise.low > 0 ? ptie_random_log_uniform(&random, noise.low, noise.high) : 0;

    ptie_sample_info drawn = {.sigma = (float)sigma};
    PTIE_TRY(draw_flow(sampler, seed, index, amplitude_rad, clean, &drawn.morphologies));
    PTIE_TRY(ptie_optics_defocus(sampler->optics, d.i_plus, d.i_minus, clean, NULL, d.plan));
    ptie_add_gaussian_noise(d.i_plus, pixels, sigma, seed, PTIE_STREAM_NOISE_PLUS, index);
    ptie_add_gaussian_noise(d.i_minus, pixels, sigma, seed, PTIE_STREAM_NOISE_MINUS, index);
    PTIE_TRY(ptie_tie_solve(sampler->solver, noisy, (const float *const[]){d.i_plus, d.i_minus}, d.plan,
                            NULL));

    normalise(clean, pixels, &drawn.clean_offset_rad, &drawn.clean_scale_rad);
    normalise(noisy, pixels, &drawn.noisy_offset_rad, &drawn.noisy_scale_rad);
    if (info) *info = drawn;
    return PTIE_OK;
}
