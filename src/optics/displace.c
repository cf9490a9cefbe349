/* SPDX-License-Identifier: BSD-3-Clause */
/* Resampling with a windowed sinc of eight pixels per axis, from a table of 512 places between two pixels
   (docs/math.md C3). */
#include "optics/displace.h"

#include <math.h>

#include "base/clones.h"
#include "base/memory.h"

#define PI 3.14159265358979323846

enum { TAPS = 8, BEFORE = TAPS / 2 - 1, STEPS = 512 };

struct ptie_displacer {
    int32_t width, height;
    double xx, xy, yx, yy, x0, y0; /* input pixel = matrix * output pixel + offset */
    float weight[STEPS][TAPS];     /* sum 1 */
};

/* Kaiser's window of this shape keeps the pass band flat to 1e-3 up to half the Nyquist frequency. */
static double bessel_i0(double x) {
    double term = 1, sum = 1;
    for (int k = 1; k < 32; k++) {
        term *= (x / 2 / k) * (x / 2 / k);
        sum += term;
    }
    return sum;
}

static double kernel(double d) {
    const double shape = 6, edge = TAPS / 2.0;
    if (fabs(d) >= edge) return 0;
    const double sinc = fabs(d) < 1e-12 ? 1 : sin(PI * d) / (PI * d);
    return sinc * bessel_i0(shape * sqrt(1 - d * d / (edge * edge))) / bessel_i0(shape);
}

static void fill_weights(ptie_displacer *s) {
    for (int step = 0; step < STEPS; step++) {
        double weight[TAPS], sum = 0;
        for (int k = 0; k < TAPS; k++) sum += weight[k] = kernel(k - BEFORE - (double)step / STEPS);
        for (int k = 0; k < TAPS; k++) s->weight[step][k] = (float)(weight[k] / sum);
    }
}

ptie_status ptie_displacer_create(ptie_displacer **out, int32_t width_px, int32_t height_px,
                                   const ptie_similarity *p) {
    ptie_displacer *s;
    *out = NULL;
    PTIE_TRY(ptie_alloc_status(&s, 1, sizeof *s, "displaced plane"));
    const double cosine = cos(p->rotation_rad) / p->magnification,
                 sine = sin(p->rotation_rad) / p->magnification;
    const double cx = (width_px - 1) / 2.0, cy = (height_px - 1) / 2.0;
    const double ax = cx + p->shift_x_px, ay = cy + p->shift_y_px; /* where the centre appears */
    s->width = width_px, s->height = height_px;
    s->xx = cosine, s->xy = sine, s->x0 = cx - cosine * ax - sine * ay;
    s->yx = -sine, s->yy = cosine, s->y0 = cy + sine * ax - cosine * ay;
    fill_weights(s);
    *out = s;
    return PTIE_OK;
}

void ptie_displacer_free(ptie_displacer *displacer) {
    ptie_free(displacer);
}

/* Pixel and place between it and the next, to the nearest step. */
PTIE_INLINE int32_t split(double place, int32_t *step) {
    const int64_t steps = (int64_t)floor(place * STEPS + 0.5);
    *step = (int32_t)(steps & (STEPS - 1));
    return (int32_t)((steps - *step) / STEPS);
}

PTIE_INLINE int32_t clamped(int32_t i, int32_t count) {
    return i < 0 ? 0 : i >= count ? count - 1 : i;
}

PTIE_INLINE float inner_value(const float *in, size_t pitch, const float *wx, const float *wy) {
    float column[TAPS] = {0}, sum = 0;
    for (int j = 0; j < TAPS; j++)
        for (int k = 0; k < TAPS; k++) column[k] += wy[j] * in[(size_t)j * pitch + (size_t)k];
    for (int k = 0; k < TAPS; k++) sum += wx[k] * column[k];
    return sum;
}

/* The same where the eight pixels may lie outside. */
static float edge_value(const ptie_displacer *s, const float *in, int32_t x, int32_t y, const float *wx,
                        const float *wy) {
    float patch[TAPS * TAPS];
    for (int j = 0; j < TAPS; j++)
        for (int k = 0; k < TAPS; k++)
            patch[j * TAPS + k] = in[(size_t)clamped(y + j, s->height) * (size_t)s->width +
                                     (size_t)clamped(x + k, s->width)];
    return inner_value(patch, TAPS, wx, wy);
}

PTIE_CLONES static void resample_row(const ptie_displacer *s, float *out, const float *in, int32_t row) {
    const int32_t w = s->width, h = s->height;
    for (int32_t column = 0; column < w; column++) {
        int32_t step_x, step_y;
        const int32_t x = split(s->xx * column + s->xy * row + s->x0, &step_x) - BEFORE,
                      y = split(s->yx * column + s->yy * row + s->y0, &step_y) - BEFORE;
        const float *wx = s->weight[step_x], *wy = s->weight[step_y];
        const bool inside = x >= 0 && y >= 0 && x + TAPS <= w && y + TAPS <= h;
        out[column] = inside ? inner_value(in + (size_t)y * (size_t)w + (size_t)x, (size_t)w, wx, wy)
                             : edge_value(s, in, x, y, wx, wy);
    }
}

void ptie_displacer_run(const ptie_displacer *s, float *out, const float *in) {
    for (int32_t row = 0; row < s->height; row++)
        resample_row(s, out + (size_t)row * (size_t)s->width, in, row);
}
