/* SPDX-License-Identifier: BSD-3-Clause */
#include "prep/texture.h"

#include <math.h>
#include <string.h>

#include "base/image.h"
#include "base/memory.h"

/* Of the band-pass, in pixels of the scale: noise above it, uneven light below it. */
static const double FINE = 1, COARSE = 6;

enum { EDGE = 4 }; /* pixels at the frame's edges in which the filter sees its mirror image */

static double band_pass(double k2, const void *context) {
    (void)context;
    return exp(-0.5 * FINE * FINE * k2) - exp(-0.5 * COARSE * COARSE * k2);
}

/* Means of scale x scale pixels around the frame's centre, relative to the mean of all, less 1. */
static void bin(float *out, const float *image, int32_t width, int32_t height,
                const ptie_texture *t) {
    const int32_t left = (width - t->width * t->scale) / 2,
                  top = (height - t->height * t->scale) / 2;
    const size_t pixels = (size_t)t->width * (size_t)t->height;
    double total = 0;
    for (int32_t y = 0; y < t->height; y++)
        for (int32_t x = 0; x < t->width; x++) {
            double sum = 0;
            for (int32_t j = 0; j < t->scale; j++)
                for (int32_t i = 0; i < t->scale; i++)
                    sum += (double)image[(ptrdiff_t)(top + y * t->scale + j) * width + left +
                                         x * t->scale + i];
            out[(ptrdiff_t)y * t->width + x] = (float)sum;
            total += sum;
        }
    const double mean = total / (double)pixels;
    for (size_t i = 0; i < pixels; i++) out[i] = (float)((double)out[i] / mean - 1);
}

/* A pixel of the scale counts if its middle is in the light, and it is away from the edges. */
static void choose_used(const ptie_texture *t, const uint8_t *mask, int32_t width, int32_t height) {
    const int32_t left = (width - t->width * t->scale) / 2,
                  top = (height - t->height * t->scale) / 2;
    for (int32_t y = EDGE; y < t->height - EDGE; y++)
        for (int32_t x = EDGE; x < t->width - EDGE; x++) {
            const int32_t u = left + x * t->scale + t->scale / 2,
                          v = top + y * t->scale + t->scale / 2;
            t->use[(ptrdiff_t)y * t->width + x] = !mask || mask[(ptrdiff_t)v * width + u];
        }
}

static ptie_status filter(ptie_texture *t) {
    ptie_fft *fft;
    float *response = NULL, *spectrum = NULL, *const images[] = {t->fixed, t->moving};
    PTIE_TRY(ptie_fft_create(&fft, PTIE_FFT_MIRROR, t->width, t->height));
    ptie_status status;
    PTIE_TRY_DONE(
        ptie_alloc_status(&response, ptie_fft_filter_floats(fft), sizeof(float), "registration"));
    PTIE_TRY_DONE(
        ptie_alloc_status(&spectrum, ptie_fft_spectrum_floats(fft), sizeof(float), "registration"));
    ptie_fft_filter_fill(fft, response, 1, band_pass, NULL);
    for (int i = 0; i < 2; i++) {
        ptie_fft_forward(fft, spectrum, images[i]);
        ptie_fft_filter_apply(fft, spectrum, response);
        ptie_fft_inverse(fft, images[i], spectrum);
    }
done:
    ptie_free(spectrum);
    ptie_free(response);
    ptie_fft_free(fft);
    return status;
}

static ptie_status allocate(ptie_texture *t) {
    const size_t pixels = (size_t)t->width * (size_t)t->height;
    PTIE_TRY(ptie_alloc_status(&t->fixed, pixels, sizeof(float), "registration"));
    PTIE_TRY(ptie_alloc_status(&t->moving, pixels, sizeof(float), "registration"));
    PTIE_TRY(ptie_alloc_status(&t->warped, pixels, sizeof(float), "registration"));
    PTIE_TRY(ptie_alloc_status(&t->use, pixels, 1, "registration"));
    return ptie_alloc_status(&t->inside, pixels, 1, "registration");
}

ptie_status ptie_texture_create(ptie_texture *t, const float *fixed, const float *moving,
                                const uint8_t *mask, int32_t width, int32_t height, int32_t scale) {
    *t = (ptie_texture){.scale = scale, .width = width / scale, .height = height / scale};
    ptie_status status = allocate(t);
    if (status == PTIE_OK) {
        bin(t->fixed, fixed, width, height, t);
        bin(t->moving, moving, width, height, t);
        choose_used(t, mask, width, height);
        status = filter(t);
    }
    if (status != PTIE_OK) ptie_texture_free(t);
    return status;
}

void ptie_texture_free(ptie_texture *t) {
    ptie_free(t->fixed);
    ptie_free(t->moving);
    ptie_free(t->warped);
    ptie_free(t->use);
    ptie_free(t->inside);
    *t = (ptie_texture){0};
}

ptie_status ptie_texture_warp(ptie_texture *t, ptie_motion motion, bool choose) {
    const ptie_similarity place = {motion.shift_x / t->scale, motion.shift_y / t->scale,
                                   hypot(motion.turn_re, motion.turn_im),
                                   atan2(motion.turn_im, motion.turn_re)};
    ptie_resampler *resampler;
    void *scratch = NULL;
    PTIE_TRY(ptie_prep_resampler(&resampler, t->width, t->height, place));
    const ptie_status status =
        ptie_alloc_status(&scratch, ptie_prep_resampler_scratch(resampler), 1, "registration");
    if (status == PTIE_OK) {
        ptie_prep_resample(resampler, t->warped, t->moving, scratch);
        if (choose) ptie_resampler_inside(resampler, t->inside, EDGE);
    }
    ptie_free(scratch);
    ptie_resampler_free(resampler);
    return status;
}
