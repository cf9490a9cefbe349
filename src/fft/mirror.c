/* SPDX-License-Identifier: BSD-3-Clause */
/* DCT-II and DCT-III by the real transform of the reordered image (Makhoul 1980): FFTW's own are
 * scalar code, its real transforms are not.  Along one axis, v[j] = x[2 j], v[N-1-j] = x[2 j + 1]
 * has the spectrum V with
 *
 *     X[k] = 2 Re(w^k V[k]),   V[k] = w^-k (X[k] - i X[N-k]) / 2,   w = exp(-i pi / 2 N), X[N] = 0;
 *
 * along both, with P = w^x V(y, x) and Q = w^x V(H-y, x) (V is that of a real image),
 *
 *     X(y, x)   = 2 Re(w^y (P + conj Q)),    X(y, W-x) = -2 Im(w^y (P - conj Q)),
 *     V(y, x)   = w^-y w^-x (X(y, x) - X(H-y, W-x) - i (X(H-y, x) + X(y, W-x))) / 4.
 */
#include <math.h>
#include <string.h>

#include "base/clones.h"
#include "base/memory.h"
#include "fft/plan.h"

/* (cos, sin) of pi k / 2 n. */
static void fill_turns(float *turns, int32_t count, int32_t n) {
    for (int32_t k = 0; k < count; k++) {
        const double angle = 3.14159265358979323846 * k / (2.0 * n);
        turns[2 * k] = (float)cos(angle);
        turns[2 * k + 1] = (float)sin(angle);
    }
}

ptie_status ptie_mirror_prepare(ptie_fft *fft) {
    const int32_t columns = fft->width / 2 + 1;
    PTIE_TRY(ptie_alloc_status(&fft->turns_x, 2 * (size_t)columns, sizeof(float), "transform"));
    PTIE_TRY(ptie_alloc_status(&fft->turns_y, 2 * (size_t)fft->height, sizeof(float), "transform"));
    fill_turns(fft->turns_x, columns, fft->width);
    fill_turns(fft->turns_y, fft->height, fft->height);
    return PTIE_OK;
}

/* Row of the image that becomes row y of the reordered one. */
static int32_t source_row(int32_t y, int32_t height) {
    return 2 * y < height ? 2 * y : 2 * (height - y) - 1;
}

PTIE_CLONES static void reorder_row(float *restrict v, const float *restrict x, int32_t n) {
    for (int32_t j = 0; j < n / 2; j++) v[j] = x[2 * j];
    for (int32_t j = 0; j < n / 2; j++) v[n - 1 - j] = x[2 * j + 1];
    if (n % 2) v[n / 2] = x[n - 1];
}

PTIE_CLONES static void restore_row(float *restrict x, const float *restrict v, int32_t n) {
    for (int32_t j = 0; j < n / 2; j++) {
        x[2 * j] = v[j];
        x[2 * j + 1] = v[n - 1 - j];
    }
    if (n % 2) x[n - 1] = v[n / 2];
}

typedef struct number {
    float re, im;
} number;

/* Entry x of a complex row times turn^-1 (sign -1) or turn (+1). */
PTIE_INLINE number turned(number v, const float *turn, float sign) {
    const float c = turn[0], s = sign * turn[1];
    return (number){v.re * c - v.im * s, v.re * s + v.im * c};
}

PTIE_INLINE number entry(const float *row, int32_t x) {
    return (number){row[2 * x], row[2 * x + 1]};
}

/* Row y of X from the rows y and H - y of V. */
PTIE_CLONES static void combine_row(float *restrict out, const float *v, const float *opposite,
                                    const float *restrict turn_y, const float *restrict turns_x,
                                    int32_t width) {
    const float c = 2 * turn_y[0], s = 2 * turn_y[1];
    for (int32_t x = 0; x <= width / 2; x++) {
        const number p = turned(entry(v, x), turns_x + 2 * x, -1);
        const number q = turned(entry(opposite, x), turns_x + 2 * x, -1);
        out[x] = c * (p.re + q.re) + s * (p.im - q.im);
    }
    float *mirrored = out + width;
    for (int32_t x = 1; x < (width + 1) / 2; x++) {
        const number p = turned(entry(v, x), turns_x + 2 * x, -1);
        const number q = turned(entry(opposite, x), turns_x + 2 * x, -1);
        mirrored[-x] = s * (p.re - q.re) - c * (p.im + q.im);
    }
}

/* Row y of V from the rows y and H - y of X; there is no row H: `weight` is 0 for y = 0, else 1. */
PTIE_CLONES static void separate_row(float *restrict v, const float *row, const float *opposite,
                                     float weight, const float *restrict turn_y,
                                     const float *restrict turns_x, int32_t width) {
    const float *row_end = row + width, *opposite_end = opposite + width;
    const number first =
        turned((number){0.25f * row[0], -0.25f * weight * opposite[0]}, turn_y, 1);
    v[0] = first.re, v[1] = first.im;
    for (int32_t x = 1; x <= width / 2; x++) {
        const number sum = {0.25f * (row[x] - weight * opposite_end[-x]),
                            -0.25f * (weight * opposite[x] + row_end[-x])};
        const number turned_x = turned(sum, turns_x + 2 * x, 1), both = turned(turned_x, turn_y, 1);
        v[2 * x] = both.re;
        v[2 * x + 1] = both.im;
    }
}

/* V lies in `spectrum`, whose rows have room for it; the image holds what is on its way. */
void ptie_mirror_forward(const ptie_fft *fft, float *spectrum, float *image) {
    const int32_t w = fft->width, h = fft->height;
    const ptrdiff_t pitch = 2 * (w / 2 + 1);
    for (int32_t y = 0; y < h; y++)
        reorder_row(spectrum + y * pitch, image + (ptrdiff_t)source_row(y, h) * w, w);
    fftwf_execute_dft_r2c(fft->forward, spectrum, (fftwf_complex *)(void *)spectrum);
    for (int32_t y = 0; y < h; y++)
        combine_row(image + (ptrdiff_t)y * w, spectrum + y * pitch, spectrum + (h - y) % h * pitch,
                    fft->turns_y + 2 * y, fft->turns_x, w);
    memcpy(spectrum, image, (size_t)w * (size_t)h * sizeof *image);
}

void ptie_mirror_inverse(const ptie_fft *fft, float *image, float *spectrum) {
    const int32_t w = fft->width, h = fft->height;
    const ptrdiff_t pitch = 2 * (w / 2 + 1);
    memcpy(image, spectrum, (size_t)w * (size_t)h * sizeof *image);
    for (int32_t y = 0; y < h; y++)
        separate_row(spectrum + y * pitch, image + (ptrdiff_t)y * w,
                     image + (ptrdiff_t)((h - y) % h) * w, y > 0, fft->turns_y + 2 * y,
                     fft->turns_x, w);
    fftwf_execute_dft_c2r(fft->inverse, (fftwf_complex *)(void *)spectrum, spectrum);
    for (int32_t y = 0; y < h; y++)
        restore_row(image + (ptrdiff_t)source_row(y, h) * w, spectrum + y * pitch, w);
}
