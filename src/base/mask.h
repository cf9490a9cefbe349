/* SPDX-License-Identifier: BSD-3-Clause */
/* Binary images: 1 inside, 0 outside; squares as structuring elements. */
#ifndef PTIE_BASE_MASK_H
#define PTIE_BASE_MASK_H

#include <stddef.h>
#include <stdint.h>

/* Sets every pixel within `radius` (in x and in y) of one that is `value` to `value`: grows the
   inside (1) or the outside (0).  Beyond the frame is neither.  work: as many bytes as the mask. */
void ptie_mask_grow(uint8_t *mask, int32_t width, int32_t height, int32_t radius, uint8_t value,
                    uint8_t *work);

/* Removes connected parts (8 neighbours) smaller than `share` (0..1) of the largest.
   size, queue: scratch, one number per pixel each. */
void ptie_mask_keep_large(uint8_t *mask, int32_t width, int32_t height, double share, int32_t *size,
                          int32_t *queue);

#endif
