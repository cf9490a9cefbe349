/* SPDX-License-Identifier: BSD-3-Clause */
/* The forward model inside the library: contracts of <ptie/optics.h>, arguments already checked. */
#ifndef PTIE_OPTICS_OPTICS_H
#define PTIE_OPTICS_OPTICS_H

#include <ptie/optics.h>

#include "base/status.h"

ptie_status ptie_optics_plan(ptie_optics **out, const ptie_optics_params *params);
size_t ptie_optics_scratch(const ptie_optics *optics);
ptie_status ptie_optics_defocus(const ptie_optics *optics, float *i_plus, float *i_minus,
                                const float *phase_rad, const float *i_zero, void *scratch);

#endif
