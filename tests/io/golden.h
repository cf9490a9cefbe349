/* SPDX-License-Identifier: BSD-3-Clause */
/* The images that tests/golden/make_images.py writes. */
#ifndef PTIE_TESTS_IO_GOLDEN_H
#define PTIE_TESTS_IO_GOLDEN_H

#include "support/support.h"

enum { GOLDEN_WIDTH = 7, GOLDEN_HEIGHT = 5, GOLDEN_PIXELS = 35 };

static inline const char *golden_image(const char *name) {
    char path[200];
    snprintf(path, sizeof path, "tests/golden/images/%s", name);
    return support_source(path);
}

/* Pixel i of frame t, for the kind of the stored sample. */
static inline double golden_value(const char *sample, int64_t t, int32_t i) {
    double f = i % GOLDEN_WIDTH + 10 * (i / GOLDEN_WIDTH) + 50 * (double)t;
    return sample[0] == 'u' ? f : sample[0] == 'i' ? f - 20 : f / 2 - 20;
}

#endif
