/* SPDX-License-Identifier: BSD-3-Clause */
/* Forward model: what a camera sees of a phase, defocused both ways.  Paper section 2.2, docs/math.md
 * (M1)-(M3) and (M7).
 *
 * Images are row-major, contiguous, height x width floats.  Phase is in rad, lengths are in m,
 * intensities are relative to the mean in-focus intensity.
 */
#ifndef PTIE_OPTICS_H
#define PTIE_OPTICS_H

#include <ptie/context.h>

typedef enum ptie_boundary {
    PTIE_PERIODIC = 0, /* the image repeats: FFT */
    PTIE_MIRROR = 1    /* homogeneous Neumann, the image is mirrored at its edges: DCT-II */
} ptie_boundary;

typedef enum ptie_propagation {
    PTIE_TIE_SPECTRAL = 0,    /* linear TIE, Laplacian by its symbol -k^2 (exact inverse of the solver) */
    PTIE_TIE_STENCIL = 1,     /* linear TIE, 5-point Laplacian */
    PTIE_ANGULAR_SPECTRUM = 2 /* scalar diffraction, exp(i k dz sqrt(1-(lambda f)^2)), evanescent = 0 */
} ptie_propagation;

typedef struct ptie_optics_params {
    uint32_t struct_size;       /* set by ptie_optics_params_init */
    int32_t width_px, height_px;/* 2..32768 each, default 256 */
    double pixel_m;             /* pixel pitch at the object, 1e-9..1, default 20e-6 */
    double wavelength_m;        /* 1e-12..1e-2, default 532e-9 */
    double defocus_m;           /* distance from focus to each plane, 1e-9..1e3, default 10e-3 */
    ptie_boundary boundary;       /* default PTIE_PERIODIC */
    ptie_propagation propagation; /* default PTIE_TIE_SPECTRAL */
} ptie_optics_params;

typedef struct ptie_optics ptie_optics;

PTIE_API void ptie_optics_params_init(ptie_optics_params *params);

/* Prepares transforms and propagators.  Allocates.  Errors: PTIE_EINVAL, PTIE_ENOMEM. */
PTIE_API PTIE_NODISCARD ptie_status ptie_optics_create(ptie_optics **out, ptie_ctx *ctx,
                                                       const ptie_optics_params *params);
PTIE_API void ptie_optics_free(ptie_optics *optics); /* NULL is fine */
PTIE_API size_t ptie_optics_scratch_bytes(const ptie_optics *optics);

/* i_plus, i_minus (out): intensity at +defocus and -defocus.  phase_rad (in).  i_zero (in): in-focus
   intensity, NULL for 1 everywhere.  scratch: ptie_optics_scratch_bytes, 64-byte aligned.
   PTIE_TIE_SPECTRAL and _STENCIL need i_zero == NULL or constant: they are Eq. 1, which drops the
   gradient of I0; use PTIE_ANGULAR_SPECTRUM for structured light.
   An output may be one of the inputs.  No allocation.  The plan is const: concurrent runs with
   different scratch are fine.
   Errors: PTIE_ENUMERIC (phase or intensity not finite, intensity negative: names the pixel),
   PTIE_EINVAL (a pointer is missing, scratch not aligned, i_zero not constant where it must be). */
PTIE_API PTIE_NODISCARD ptie_status ptie_optics_run(const ptie_optics *optics, float *i_plus,
                                                    float *i_minus, const float *phase_rad,
                                                    const float *i_zero, void *scratch);

/* Adds zero-mean Gaussian noise of standard deviation `sigma` (same unit as the image) to `count`
   values.  A pure function of (seed, stream, index): the same bits in any order, on any thread. */
PTIE_API void ptie_add_gaussian_noise(float *image, size_t count, double sigma, uint64_t seed,
                                      uint32_t stream, uint64_t index);

#endif
