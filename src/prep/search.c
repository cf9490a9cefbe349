/* SPDX-License-Identifier: BSD-3-Clause */
/* Where a registration begins: rotations and magnifications are tried, shifts are found by
 * cross-correlation. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "prep/texture.h"

static const double PI = 3.14159265358979323846;

/* Steps within which the textures of the coarsest scale, 64 to 127 pixels, stay alike: 45 pixels
   from the centre they are off by no more than 0.8 pixels. */
static const double TURN = 2 * 3.14159265358979323846 / 180, STRETCH = 0.04;
enum { TURNS = 4, STRETCHES = 2 }; /* to either side of none */

typedef struct search {
    ptie_texture *texture;
    ptie_fft *fft;
    float *image, *spectrum, *fixed; /* fixed: the spectrum of the windowed plane */
    double strongest;                /* correlation so far */
} search;

/* Hann's window, so that opposite edges do not meet. */
static void window(float *out, const float *image, int32_t width, int32_t height) {
    for (int32_t y = 0; y < height; y++) {
        const double wy = pow(sin(PI * (y + 0.5) / height), 2);
        for (int32_t x = 0; x < width; x++)
            *out++ = (float)(wy * pow(sin(PI * (x + 0.5) / width), 2) * (double)*image++);
    }
}

static double energy(const float *image, size_t pixels) {
    double sum = 0;
    for (size_t i = 0; i < pixels; i++) sum += (double)image[i] * (double)image[i];
    return sum;
}

/* spectrum *= conj(fixed) */
static void correlate(float *spectrum, const float *fixed, size_t entries) {
    for (size_t i = 0; i < entries; i++) {
        const float re = spectrum[2 * i], im = spectrum[2 * i + 1], a = fixed[2 * i],
                    b = fixed[2 * i + 1];
        spectrum[2 * i] = re * a + im * b;
        spectrum[2 * i + 1] = im * a - re * b;
    }
}

/* The strongest correlation of either sign: defocus may turn dark into bright. */
static size_t peak_of(const float *image, size_t pixels) {
    size_t peak = 0;
    for (size_t i = 1; i < pixels; i++)
        if (fabsf(image[i]) > fabsf(image[peak])) peak = i;
    return peak;
}

static ptie_status attempt(search *s, ptie_motion *best, ptie_motion trial) {
    ptie_texture *t = s->texture;
    const int32_t w = t->width, h = t->height;
    const size_t pixels = (size_t)w * (size_t)h;
    PTIE_TRY(ptie_texture_warp(t, trial, true));
    window(s->image, t->warped, w, h);
    const double norm = sqrt(energy(s->image, pixels));
    ptie_fft_forward(s->fft, s->spectrum, s->image);
    correlate(s->spectrum, s->fixed, ptie_fft_filter_floats(s->fft));
    ptie_fft_inverse(s->fft, s->image, s->spectrum);
    const size_t peak = peak_of(s->image, pixels);
    const double strength = fabs((double)s->image[peak]) / norm;
    if (!(strength > s->strongest)) return PTIE_OK;
    const int32_t x = (int32_t)(peak % (size_t)w), y = (int32_t)(peak / (size_t)w);
    const double dx = (x > w / 2 ? x - w : x) * t->scale, dy = (y > h / 2 ? y - h : y) * t->scale;
    s->strongest = strength;
    *best = trial;
    best->shift_x = trial.turn_re * dx - trial.turn_im * dy;
    best->shift_y = trial.turn_im * dx + trial.turn_re * dy;
    return PTIE_OK;
}

static ptie_status try_all(search *s, ptie_motion *best) {
    window(s->image, s->texture->fixed, s->texture->width, s->texture->height);
    ptie_fft_forward(s->fft, s->fixed, s->image);
    for (int turn = -TURNS; turn <= TURNS; turn++)
        for (int stretch = -STRETCHES; stretch <= STRETCHES; stretch++) {
            const double m = 1 + stretch * STRETCH;
            PTIE_TRY(
                attempt(s, best, (ptie_motion){0, 0, m * cos(turn * TURN), m * sin(turn * TURN)}));
        }
    return PTIE_OK;
}

ptie_status ptie_texture_search(ptie_texture *texture, ptie_motion *best) {
    *best = (ptie_motion){0, 0, 1, 0};
    search s = {.texture = texture};
    PTIE_TRY(ptie_fft_create(&s.fft, PTIE_FFT_REAL, texture->width, texture->height));
    ptie_status status;
    PTIE_TRY_DONE(
        ptie_alloc_status(&s.image, ptie_fft_image_floats(s.fft), sizeof(float), "registration"));
    PTIE_TRY_DONE(ptie_alloc_status(&s.spectrum, ptie_fft_spectrum_floats(s.fft), sizeof(float),
                                    "registration"));
    PTIE_TRY_DONE(ptie_alloc_status(&s.fixed, ptie_fft_spectrum_floats(s.fft), sizeof(float),
                                    "registration"));
    status = try_all(&s, best);
done:
    ptie_free(s.fixed);
    ptie_free(s.spectrum);
    ptie_free(s.image);
    ptie_fft_free(s.fft);
    return status;
}
