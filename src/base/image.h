/* SPDX-License-Identifier: BSD-3-Clause */
/* Checks that images pass before anything is computed from them. */
#ifndef PTIE_BASE_IMAGE_H
#define PTIE_BASE_IMAGE_H

#include "base/status.h"

/* PTIE_ENUMERIC naming `what` ("i_plus") and the first pixel that is NaN or infinite. */
ptie_status ptie_image_finite(const float *image, int32_t width, int32_t height, const char *what);

#endif
