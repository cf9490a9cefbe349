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

#define PTIE_MAX_PLANES 8

/* How the phase is found from dI/dz.  The first is for light that is even but for fine structure; the others
   take the intensity as it is, apertures with nothing outside included. */
typedef enum ptie_solver_method {
    PTIE_SOLVE_DIRECT = 0,        /* one inverse Laplacian of (dI/dz) / I (M5) */
    PTIE_SOLVE_MAX_INTENSITY = 1, /* one inverse Laplacian of (dI/dz) / max I: the first step of US-TIE (M11) */
    PTIE_SOLVE_TWO_POISSON = 2,   /* Teague's two inverse Laplacians, as Paganin and Nugent 1998 (M12) */
    PTIE_SOLVE_ITERATIVE_DCT = 3, /* that, iterated on what it leaves of dI/dz (M13); mirror boundary.  Fast, but
                                     diverges where the intensity falls to 0 inside the aperture */
    PTIE_SOLVE_US_TIE = 4         /* max-intensity steps, iterated on what they leave of dI/dz (M11, M13):
                                     converges for any intensity */
} ptie_solver_method;

typedef struct ptie_solver_params {
    uint32_t struct_size;        /* set by ptie_solver_params_init */
    int32_t width_px, height_px; /* 2..32768 each, default 256 */
    double pixel_m;              /* pixel pitch at the object, 1e-9..1, default 20e-6 */
    double wavelength_m;         /* 1e-12..1e-2, default 532e-9 */
    /* Where the planes of a frame lie: their number, 2..PTIE_MAX_PLANES, default 2, and distances from focus
       in any order, |z| <= 1e3, apart by at least 1 nm, default +10e-3 and -10e-3.  A plane within 1 nm of 0
       is the intensity to divide by, pixel by pixel: the image in focus, or the no-flow reference of a
       recording of one defocused plane, which then counts as 0 and the flow as its propagation distance.
       Without one, the mean of all planes is the intensity everywhere. */
    int32_t plane_count;
    double z_m[PTIE_MAX_PLANES];
    /* Degree of the polynomial fitted to I(z) by least squares, whose slope at z = 0 is dI/dz (M4b, M4d):
       1..plane_count - 1, or 0 (default): 1 for two planes, 2 for more. */
    int32_t polynomial_order;
    ptie_boundary boundary;      /* default PTIE_PERIODIC */
    ptie_solver_method method;   /* default PTIE_SOLVE_DIRECT */
    /* Tikhonov: 1/k^2 becomes k^2/(k^4 + k_c^4) with k_c = 2 pi / cutoff_m.  Structures finer than the
       cut-off keep their amplitude (the factor is 1 - (k_c/k)^4 + ...); coarser ones fade.  0 = off. */
    double cutoff_m;
    int32_t max_iterations;      /* of an iterating method, 1..100000, default 100; (M13) has what else stops it */
    /* Where two Poisson equations divide by I0: pixels below this share of the brightest are raised to it
       (0..1); 0 (default) takes what lies below 1 % for outside of the light and gives it the mean. */
    double intensity_floor;
    /* Where there is light: height x width, 1 = light, 0 = opaque (a nozzle); NULL (default) = everywhere.
       Opaque pixels have no light and phase 0.  What the planes hold there is read only next to light, where
       diffraction puts some (M14), and by PTIE_SOLVE_DIRECT not at all.  The plan copies the mask. */
    const uint8_t *mask;
} ptie_solver_params;

/* What a run says of itself. */
typedef struct ptie_solver_report {
    int32_t iterations; /* 1 for a direct method */
    double residual;    /* largest dI/dz left unexplained by diffraction, relative to the largest measured; 0 for
                           a method of one step, which does not look */
} ptie_solver_report;

typedef struct ptie_solver ptie_solver;

PTIE_API void ptie_solver_params_init(ptie_solver_params *params);

/* Plans transforms and the inverse filter.  Allocates.  Errors: PTIE_EINVAL (a parameter out of range; planes
   that coincide), PTIE_ENOMEM. */
PTIE_API PTIE_NODISCARD ptie_status ptie_solver_create(ptie_solver **out, ptie_ctx *ctx,
                                                       const ptie_solver_params *params);
PTIE_API void ptie_solver_free(ptie_solver *solver); /* NULL is fine */
PTIE_API size_t ptie_solver_scratch_bytes(const ptie_solver *solver);

/* phase_rad (out): zero-mean phase (height x width).  planes: params.plane_count images of that size,
   contiguous, in the order of params.z_m.  phase_rad may be one of them.  report: NULL is fine.
   No allocation; const plan: concurrent runs with different scratch are fine.  Errors: PTIE_EINVAL (a plane
   is missing, scratch not 64-byte aligned), PTIE_ENUMERIC (not finite, or the intensity to divide by is not
   positive: names the plane and the pixel; an iteration that diverged). */
PTIE_API PTIE_NODISCARD ptie_status ptie_solver_run(const ptie_solver *solver, float *phase_rad,
                                                    const float *const *planes, void *scratch,
                                                    ptie_solver_report *report);

/* Standard deviation of the reconstructed phase (rad, over the frame) caused by white noise of relative
   standard deviation `sigma` in each plane: the closed form (M8), summed over this plan's filter.  For
   even light; darker regions are noisier by max I / I. */
PTIE_API double ptie_solver_noise_rad(const ptie_solver *solver, double sigma);

/* mask (out; height x width): 1 where the phase is made of measured light only, 0 where light from beyond the frame's
   edge or from behind an opaque one can have been diffracted to: within lambda max|z| / (2 pixel) of it (M14).
   What the boundary condition itself adds has no such border: it is smooth, and fades into the frame.
   Errors: PTIE_EINVAL (a pointer is missing). */
PTIE_API PTIE_NODISCARD ptie_status ptie_solver_border(const ptie_solver *solver, uint8_t *mask);

/* How a cut-off is chosen (M15, M16). */
typedef enum ptie_cutoff_rule {
    PTIE_CUTOFF_NOISE = 0,  /* the smallest expected error of the phase, from the noise of the planes */
    PTIE_CUTOFF_L_CURVE = 1 /* the corner between what is left of dI/dz and what the phase amounts to: against drifts
                               and gradients of the light; white noise alone makes no corner */
} ptie_cutoff_rule;

/* cutoff_m (out): for ptie_solver_params, from the planes of one frame; 0 where none is better than any.  params:
   those of the solver; its method and cutoff_m do not matter.  sigma (PTIE_CUTOFF_NOISE): relative standard deviation of
   the white noise in each plane, or 0: found from the finest structures of dI/dz.  One frame decides by a handful of
   coarse modes: for a recording take the median over several.  Does not depend on the scale of the planes.
   Allocates.  Errors: those of ptie_solver_create and ptie_solver_run; PTIE_EINVAL (sigma < 0). */
PTIE_API PTIE_NODISCARD ptie_status ptie_solver_choose_cutoff(double *cutoff_m, ptie_ctx *ctx,
                                                              const ptie_solver_params *params,
                                                              const float *const *planes,
                                                              ptie_cutoff_rule rule, double sigma);

#endif
