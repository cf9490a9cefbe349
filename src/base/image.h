/* SPDX-License-Identifier: BSD-3-Clause */
/* What any layer may ask of an image. */
#ifndef PTIE_BASE_IMAGE_H
#define PTIE_BASE_IMAGE_H

#include <ptie/metrics.h>

#include "base/status.h"

/* PTIE_ENUMERIC naming `what` ("i_plus") and the first pixel that is NaN or infinite. */
ptie_status ptie_image_finite(const float *image, int32_t width, int32_t height, const char *what);

/* Median of the outermost rows and columns: the level around a flow, because most of a frame's border is
   outside it.  border: scratch for 2 (width + height) values. */
double ptie_image_border_median(const float *image, int32_t width, int32_t height, float *border);

/* Smallest and largest of `count` >= 1 values. */
typedef struct ptie_extent {
    float low, high;
} ptie_extent;
ptie_extent ptie_image_extent(const float *values, size_t count);

/* PTIE_EINVAL naming the region if `rect` is empty or leaves an image of this size. */
ptie_status ptie_rect_check(ptie_rect rect, int32_t width, int32_t height, const char *name);

#endif
