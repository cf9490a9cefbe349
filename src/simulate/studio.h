/* SPDX-License-Identifier: BSD-3-Clause */
/* One frame of a simulation: flow, optics, camera.  A const plan: any thread may ask for any frame. */
#ifndef PTIE_SIMULATE_STUDIO_H
#define PTIE_SIMULATE_STUDIO_H

#include <ptie/simulate.h>

#include "base/status.h"

typedef struct ptie_studio ptie_studio;

/* params stay the caller's. */
ptie_status ptie_studio_create(ptie_studio **out, const ptie_simulate_params *params);
void ptie_studio_free(ptie_studio *studio); /* NULL is fine */
size_t ptie_studio_scratch(const ptie_studio *studio);
/* Images of a frame: I+ and I- without a camera, else one per sensor. */
int32_t ptie_studio_images(const ptie_studio *studio);

/* image (out): that many of height x width floats.  phase (out): the truth in rad, height x width; left alone unless
   the exposure is PTIE_EXPOSE_FLOW. */
ptie_status ptie_studio_frame(const ptie_studio *studio, float *const *image, float *phase, ptie_exposure exposure,
                             int64_t frame, void *scratch);

#endif
