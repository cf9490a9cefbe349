/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clones.h"

/* Integer arithmetic, so that the loop vectorises under strict floating point. */
PTIE_CLONES static bool all_finite(const float *values, size_t count) {
    const uint32_t exponent = 0x7f800000u; /* all ones: NaN or infinity */
    uint32_t bad = 0;
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, values + i, sizeof bits);
        bad |= (bits & exponent) == exponent;
    }
    return bad == 0;
}

ptie_status ptie_image_finite(const float *image, int32_t width, int32_t height, const char *what) {
    const size_t w = (size_t)width, h = (size_t)height;
    if (all_finite(image, w * h)) return PTIE_OK;
    size_t i = 0;
    while (isfinite(image[i])) i++;
    return PTIE_FAIL(PTIE_ENUMERIC,
                     "%s: value is not finite (at x=%zu, y=%zu; expected a number, found %g)", what,
                     i % w, i / w, (double)image[i]);
}

PTIE_CLONES ptie_extent ptie_image_extent(const float *values, size_t count) {
    enum { LANES = 16 };
    float low[LANES], high[LANES];
    ptie_extent extent = {values[0], values[0]};
    for (int k = 0; k < LANES; k++) low[k] = high[k] = values[0];
    size_t i = 0;
    for (; i + LANES <= count; i += LANES)
        for (int k = 0; k < LANES; k++) {
            low[k] = values[i + (size_t)k] < low[k] ? values[i + (size_t)k] : low[k];
            high[k] = values[i + (size_t)k] > high[k] ? values[i + (size_t)k] : high[k];
        }
    for (int k = 0; k < LANES; k++) {
        extent.low = low[k] < extent.low ? low[k] : extent.low;
        extent.high = high[k] > extent.high ? high[k] : extent.high;
    }
    for (; i < count; i++) {
        extent.low = values[i] < extent.low ? values[i] : extent.low;
        extent.high = values[i] > extent.high ? values[i] : extent.high;
    }
    return extent;
}

static int ascending(const void *a, const void *b) {
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

double ptie_image_border_median(const float *image, int32_t width, int32_t height, float *border) {
    const size_t w = (size_t)width, h = (size_t)height;
    size_t count = 0;
    for (size_t x = 0; x < w; x++) {
        border[count++] = image[x];
        border[count++] = image[(h - 1) * w + x];
    }
    for (size_t y = 0; y < h; y++) {
        border[count++] = image[y * w];
        border[count++] = image[y * w + w - 1];
    }
    qsort(border, count, sizeof *border, ascending);
    return ((double)border[count / 2 - 1] + (double)border[count / 2]) / 2;
}

/* Written so that no sum of the caller's numbers overflows. */
ptie_status ptie_rect_check(ptie_rect r, int32_t width, int32_t height, const char *name) {
    const bool inside = r.x_px >= 0 && r.y_px >= 0 && r.width_px > 0 && r.height_px > 0 &&
                        r.width_px <= width && r.x_px <= width - r.width_px &&
                        r.height_px <= height && r.y_px <= height - r.height_px;
    if (inside) return PTIE_OK;
    return PTIE_FAIL(PTIE_EINVAL,
                     "region '%s' leaves the image or is empty (expected within %d x %d px, found "
                     "%d x %d at x=%d, y=%d)",
                     name, width, height, r.width_px, r.height_px, r.x_px, r.y_px);
}
