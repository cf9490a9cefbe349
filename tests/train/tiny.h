/* SPDX-License-Identifier: BSD-3-Clause */
/* Presets that a test can afford. */
#ifndef PTIE_TESTS_TRAIN_TINY_H
#define PTIE_TESTS_TRAIN_TINY_H

#include "support/support.h"

#include <ptie/dataset.h>

/* Loads a preset of `side` x `side` maps whose [camera] noise is `noise`; the rest is preset
 * `paper`. */
static inline ptie_preset *tiny_preset(int side, const char *noise) {
    char text[256];
    const char *path = support_temporary("tiny.ini");
    int length = snprintf(text, sizeof text,
                          "[preset]\nname = tiny\n[image]\nwidth = %d\nheight = %d\n"
                          "[camera]\nnoise = %s\n",
                          side, side, noise);
    support_write(path, text, (size_t)length);
    ptie_preset *preset;
    assert_ok(ptie_preset_load(&preset, path));
    return preset;
}

#endif
