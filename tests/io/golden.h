/* SPDX-License-Identifier: BSD-3-Clause */
/* The images that tests/golden/make_images.py writes. */
#ifndef PTIE_TESTS_IO_GOLDEN_H
#define PTIE_TESTS_IO_GOLDEN_H

#include <ptie/recording.h>

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

/* The same for what tests/golden/make_cameras.py writes. */
static inline const char *golden_camera(const char *name) {
    char path[200];
    snprintf(path, sizeof path, "tests/golden/cameras/%s", name);
    return support_source(path);
}

static inline ptie_recording *golden_open(const char *path) {
    ptie_recording *recording;
    print_message("# %s\n", path);
    assert_ok(ptie_recording_open(&recording, path));
    return recording;
}

/* Frame t is factor * (x + 10 y + 50 t); the last frame first. */
static inline void golden_check_camera(ptie_recording *recording, const char *format,
                                       int64_t frames, double factor) {
    float data[GOLDEN_PIXELS];
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    assert_string_equal(info->format, format);
    assert_int_equal(info->width_px, GOLDEN_WIDTH);
    assert_int_equal(info->height_px, GOLDEN_HEIGHT);
    assert_int_equal(info->frames, frames);
    for (int64_t t = frames - 1; t >= 0; t--) {
        assert_ok(ptie_recording_read(recording, t, data));
        for (int32_t i = 0; i < GOLDEN_PIXELS; i++)
            assert_true((double)data[i] == factor * golden_value("u", t, i));
    }
}

#endif
