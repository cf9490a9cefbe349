/* SPDX-License-Identifier: BSD-3-Clause */
/* A solver's inside, for the files of this folder. */
#ifndef PTIE_TIE_INNER_H
#define PTIE_TIE_INNER_H

#include "fft/propagate.h"
#include "tie/derivative.h"

/* Poisson solver for structured light (M12), on a periodic frame: the image, or with the mirror boundary the
   image and its mirror images (twice as wide and high). */
typedef struct ptie_poisson {
    ptie_fft *fft;
    float *inverse;   /* k^2 / (k^4 + k_c^4) */
    float *k_x, *k_y; /* per column and row of the spectrum, rad/m; 0 at Nyquist, where a slope has no phase */
} ptie_poisson;

struct ptie_solver {
    ptie_solver_params params;
    uint8_t *mask;    /* own copy of params.mask, or NULL */
    uint8_t *reached; /* 1 where there is light or diffraction brings some; NULL without a mask */
    ptie_tie_weights weights;
    ptie_fft *fft;    /* of the boundary */
    float *inverse;   /* rad m: phase per (dI/dz) / I */
    ptie_propagator propagator[PTIE_MAX_PLANES]; /* of the planes off focus; other methods */
    ptie_poisson poisson;                        /* methods that solve two Poisson equations */
};

static inline size_t ptie_solver_pixels(const ptie_solver *solver) {
    return (size_t)solver->params.width_px * (size_t)solver->params.height_px;
}

/* Whether one step follows the other. */
static inline bool ptie_solver_iterates(const ptie_solver *solver) {
    return solver->params.method == PTIE_SOLVE_ITERATIVE_DCT || solver->params.method == PTIE_SOLVE_US_TIE;
}

static inline bool ptie_solver_divides_by_light(const ptie_solver *solver) {
    return solver->params.method == PTIE_SOLVE_ITERATIVE_DCT || solver->params.method == PTIE_SOLVE_TWO_POISSON;
}

/* image (H, W), in and out: (dI/dz) / I becomes phase.  spectrum: work. */
void ptie_tie_invert(const ptie_solver *solver, float *image, float *spectrum);

/* Mean 0 where there is light, and 0 elsewhere. */
void ptie_tie_level(const ptie_solver *solver, float *phase_rad);

/* Pixels that diffraction carries light across an edge (M14). */
int32_t ptie_tie_reach(const ptie_solver_params *params);
/* Pixels next to a `value` (0 or 1) get it, up to `reach` away in x and in y. */
void ptie_tie_spread(uint8_t *mask, int32_t width_px, int32_t height_px, uint8_t value, int32_t reach);

ptie_status ptie_poisson_prepare(ptie_poisson *poisson, const ptie_solver_params *params);
void ptie_poisson_clear(ptie_poisson *poisson);

typedef struct ptie_poisson_work {
    float *slope_x, *slope_y, *light; /* of the Poisson solver's frame */
    float *spectrum, *sum;
} ptie_poisson_work;

ptie_poisson_work ptie_poisson_slice(const ptie_poisson *poisson, ptie_slicer *slicer);
/* phase_rad += two Poisson equations on dI/dz = slope with intensity light (both as ptie_tie_slope). */
void ptie_poisson_step(const ptie_solver *solver, float *phase_rad, const float *slope, const float *light,
                       const ptie_poisson_work *work);

/* The methods other than PTIE_SOLVE_DIRECT. */
size_t ptie_tie_iterate_scratch(const ptie_solver *solver);
ptie_status ptie_tie_iterate(const ptie_solver *solver, float *phase_rad, const float *const *planes,
                             void *scratch, ptie_solver_report *report);

#endif
