/* SPDX-License-Identifier: BSD-3-Clause */
/* Gaussian smoothing, separable, mirrored at the edges.  docs/math.md (F3). */
#ifndef PTIE_FLOW_BLUR_H
#define PTIE_FLOW_BLUR_H

#include "base/status.h"

/* Standard deviation in px; below 0.1 nothing is left to smooth and the map stays as it is. */
ptie_status ptie_blur(float *map, int32_t width, int32_t height, double sigma_px);

#endif
