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

/* How the phase is found from dI/dz. */
typedef enum ptie_solver_method {
    PTIE_SOLVE_DIRECT = 0 /* one inverse Laplacian of (dI/dz) / I (M5) */
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
} ptie_solver_params;

/* What a run says of itself. */
typedef struct ptie_solver_report {
    int32_t iterations; /* 1 for a direct method */
    double residual;    /* largest of dI/dz left unexplained, relative to the largest measured; 0 for a direct
                           method, which leaves none to its own model */
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
   positive: names the plane and the pixel). */
PTIE_API PTIE_NODISCARD ptie_status ptie_solver_run(const ptie_solver *solver, float *phase_rad,
                                                    const float *const *planes, void *scratch,
                                                    ptie_solver_report *report);

/* Standard deviation of the reconstructed phase (rad, over the frame) caused by white noise of relative
   standard deviation `sigma` in each plane: the closed form (M8), summed over this plan's filter. */
PTIE_API double ptie_solver_noise_rad(const ptie_solver *solver, double sigma);

#endif
