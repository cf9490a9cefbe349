/* SPDX-License-Identifier: BSD-3-Clause */
#include "rig/prepare.h"

void ptie_bin(float *out, const float *image, int32_t width, int32_t height, int32_t binning) {
    int32_t columns = width / binning, rows = height / binning;
    double share = 1.0 / ((double)binning * binning);
    for (int32_t y = 0; y < rows; y++)
        for (int32_t x = 0; x < columns; x++) {
            const float *corner = image + ((ptrdiff_t)y * width + x) * binning;
            double sum = 0;
            for (int32_t j = 0; j < binning; j++)
                for (int32_t i = 0; i < binning; i++) sum += (double)corner[(ptrdiff_t)j * width + i];
            out[(ptrdiff_t)y * columns + x] = (float)(sum * share);
        }
}
