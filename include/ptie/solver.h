/* SPDX-License-Identifier: BSD-3-Clause */
/* Inverse model: phase from defocused intensities.  Paper section 2.3, docs/math.md (M4)-(M6).
 *
 *     phase = +(2 pi / lambda) F^-1( F(dI/dz) / (k^2 + regularisation) )
 *
 * with the sign that is right (the paper's Eq. 5 prints the other one).  The mean of a TIE phase is not
 * measured: it is returned as 0.  A homogeneous gain error common to the image drops out with it.
 */
#ifndef PTIE_SOLVER_H
#define PTIE_SOLVER_H

#include <ptie/optics.h>

/* Which planes a frame brings. */
typedef enum ptie_planes {
    PTIE_PLANES_PAIR = 0,     /* I+ and I- */
    PTIE_PLANES_TRIPLE = 1,   /* I+, I0 and I-, steps may differ */
    PTIE_PLANES_REFERENCE = 2 /* one defocused plane, and a no-flow reference of the same plane */
} ptie_planes;

typedef struct ptie_solver_params {
    uint32_t struct_size;        /* set by ptie_solver_params_init */
    int32_t width_px, height_px; /* 2..32768 each, default 256 */
    double pixel_m;              /* pixel pitch at the object, 1e-9..1, default 20e-6 */
    double wavelength_m;         /* 1e-12..1e-2, default 532e-9 */
    /* Distances from focus, |z| <= 1e3.  A pair needs minus < plus, a triple minus < 0 < plus, one plane
       plus != 0 (minus is not used); by at least 1 nm. */
    double defocus_plus_m;       /* z of i_plus, default +10e-3; with one plane: its propagation distance */
    double defocus_minus_m;      /* z of i_minus, default -10e-3 */
    ptie_boundary boundary;      /* default PTIE_PERIODIC */
    /* Tikhonov: 1/k^2 becomes k^2/(k^4 + k_c^4) with k_c = 2 pi / cutoff_m.  Structures finer than the
       cut-off keep their amplitude (the factor is 1 - (k_c/k)^4 + ...); coarser ones fade.  0 = off. */
    double cutoff_m;
} ptie_solver_params;

typedef struct ptie_solver ptie_solver;

PTIE_API void ptie_solver_params_init(ptie_solver_params *params);

/* Plans transforms and the inverse filter.  Allocates.  Errors: PTIE_EINVAL, PTIE_ENOMEM. */
PTIE_API PTIE_NODISCARD ptie_status ptie_solver_create(ptie_solver **out, ptie_ctx *ctx,
                                                       const ptie_solver_params *params);
PTIE_API void ptie_solver_free(ptie_solver *solver); /* NULL is fine */
PTIE_API size_t ptie_solver_scratch_bytes(const ptie_solver *solver);

/* phase_rad (out): zero-mean phase.  Inputs are height x width, contiguous, positive:
     i_plus, i_minus, i_zero == NULL   central difference, normalised by the mean of (I+ + I-)/2;
     i_plus, i_zero, i_minus           second-order difference for unequal steps (M4b), normalised by I0;
     i_plus, i_zero, i_minus == NULL   one defocused plane with the reference i_zero (no flow, or in
                                       focus): dI/dz = (I+ - I0)/dz, divided pixelwise by I0.
   phase_rad may be one of the inputs.  No allocation; const plan: concurrent runs with different
   scratch are fine.  Errors: PTIE_EINVAL (planes missing, distances that do not fit them, scratch not
   64-byte aligned), PTIE_ENUMERIC (not finite, or the intensity to divide by is not positive: names the
   pixel). */
PTIE_API PTIE_NODISCARD ptie_status ptie_solver_run(const ptie_solver *solver, float *phase_rad,
                                                    const float *i_plus, const float *i_zero,
                                                    const float *i_minus, void *scratch);

/* Standard deviation of the reconstructed phase (rad, over the frame) caused by white noise of relative
   standard deviation `sigma` in each image of `planes`: the closed form (M8), summed over this plan's
   filter.  NaN if the plan's distances do not fit the planes. */
PTIE_API double ptie_solver_noise_rad(const ptie_solver *solver, ptie_planes planes, double sigma);

#endif
