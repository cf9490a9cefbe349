/* SPDX-License-Identifier: BSD-3-Clause */
/* A forward plan's inside, for the files of this folder. */
#ifndef PTIE_OPTICS_PLAN_H
#define PTIE_OPTICS_PLAN_H

#include "fft/propagate.h"
#include "optics/optics.h"

struct ptie_optics {
    ptie_optics_params params;
    ptie_fft *fft;      /* of the boundary; NULL for the stencil */
    float *signal;      /* PTIE_TIE_SPECTRAL: spectrum of dz dI/dz per spectrum of phase */
    ptie_propagator propagator; /* PTIE_ANGULAR_SPECTRUM: to +defocus */
};

/* Scratch of a linear run; spectrum: NULL for the stencil. */
typedef struct ptie_optics_work {
    float *image, *spectrum;
} ptie_optics_work;

/* Linear TIE (M1)-(M3).  work->image (out): dz dI/dz for unit intensity. */
void ptie_linear_signal_spectral(const ptie_optics *optics, const float *phase_rad,
                                 const ptie_optics_work *work);
void ptie_linear_signal_stencil(const ptie_optics *optics, const float *phase_rad,
                                const ptie_optics_work *work);
/* Response of ptie_optics.signal; context: the plan. */
double ptie_linear_response(double k2, const void *context);

/* Angular spectrum (M7).  The outputs may be the inputs. */
void ptie_angular_defocus(const ptie_optics *optics, float *i_plus, float *i_minus,
                          const float *phase_rad, const float *i_zero, const ptie_wave *wave);

#endif
