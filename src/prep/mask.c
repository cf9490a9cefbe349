/* SPDX-License-Identifier: BSD-3-Clause */
/* Where no light comes through.  docs/math.md (P8), (P12). */
#include "base/image.h"
#include "base/memory.h"
#include "base/mask.h"
#include "prep/median.h"
#include "prep/prep.h"

ptie_status ptie_prep_opaque_mask(uint8_t *mask, const float *reference, int32_t width,
                                  int32_t height, double below, int32_t clean, int32_t margin) {
    const size_t pixels = (size_t)width * (size_t)height;
    uint8_t *work;
    PTIE_TRY(ptie_image_finite(reference, width, height, "reference"));
    PTIE_TRY(ptie_alloc_status(&work, pixels, 1, "mask"));
    const double limit = below * ptie_median(reference, pixels);
    for (size_t i = 0; i < pixels; i++) mask[i] = (double)reference[i] >= limit;
    ptie_mask_grow(mask, width, height, clean, 1, work); /* specks of darkness */
    ptie_mask_grow(mask, width, height, 2 * clean, 0, work);
    ptie_mask_grow(mask, width, height, clean, 1, work); /* pinholes of light */
    ptie_mask_grow(mask, width, height, margin, 0, work);
    ptie_free(work);
    return PTIE_OK;
}

void ptie_prep_pin(float *map, int32_t width, int32_t height, ptie_rect region) {
    double sum = 0;
    for (int32_t y = region.y_px; y < region.y_px + region.height_px; y++)
        for (int32_t x = region.x_px; x < region.x_px + region.width_px; x++)
            sum += (double)map[(ptrdiff_t)y * width + x];
    const float level = (float)(sum / ((double)region.width_px * region.height_px));
    for (ptrdiff_t i = 0; i < (ptrdiff_t)width * height; i++) map[i] -= level;
}
