/* SPDX-License-Identifier: BSD-3-Clause */
/* Smooth backgrounds (P10); contracts as in <ptie/preprocess.h>. */
#ifndef PTIE_PREP_SURFACE_H
#define PTIE_PREP_SURFACE_H

#include <ptie/preprocess.h>

#include "base/status.h"

ptie_status ptie_prep_surface(ptie_surface **out, const ptie_surface_params *params,
                              const uint8_t *mask);
size_t ptie_prep_surface_scratch(const ptie_surface *surface);
ptie_status ptie_prep_surface_remove(const ptie_surface *surface, float *map, void *scratch);

#endif
