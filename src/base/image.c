/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/image.h"

#include <math.h>
#include <string.h>

/* Integer arithmetic, so that the loop vectorises under strict floating point. */
static bool all_finite(const float *values, size_t count) {
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
