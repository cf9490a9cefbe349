/* SPDX-License-Identifier: BSD-3-Clause */
/* MATLAB stores columns. */
#ifndef PTIE_IO_TRANSPOSE_H
#define PTIE_IO_TRANSPOSE_H

#include <stddef.h>

/* out: height rows; columns: width columns of height values each.  In tiles, so that both sides
 * stay in the cache. */
static inline void ptie_transpose(float *out, const float *columns, size_t height, size_t width) {
    enum { TILE = 16 };
    for (size_t top = 0; top < height; top += TILE)
        for (size_t left = 0; left < width; left += TILE)
            for (size_t y = top; y < height && y < top + TILE; y++)
                for (size_t x = left; x < width && x < left + TILE; x++)
                    out[y * width + x] = columns[x * height + y];
}

#endif
