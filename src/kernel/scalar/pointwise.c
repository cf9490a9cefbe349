/* SPDX-License-Identifier: BSD-3-Clause */
/* The output's sigmoid (N6). */
#include <math.h>

#include "kernel/scalar/scalar.h"

void ptie_sigmoid_scalar(const ptie_map *out, const ptie_map *in) {
    for (int32_t c = 0; c < in->channels; c++)
        for (int32_t y = 0; y < in->height; y++)
            for (int32_t x = 0; x < in->width; x++)
                row_of(out, c, y)[x] = 1 / (1 + expf(-row_of(in, c, y)[x]));
}
