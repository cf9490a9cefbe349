/* SPDX-License-Identifier: BSD-3-Clause */
/* Teague's auxiliary function psi, grad psi = I grad phi: lap psi = -k0 dI/dz, then
 * lap phi = div(grad psi / I).  docs/math.md (M12). */
#include <math.h>
#include <string.h>

#include "tie/inner.h"

#define TWO_PI 6.283185307179586476925

static double inverse_response(double k2, const void *context) {
    const double cutoff_m = *(const double *)context, cutoff = cutoff_m > 0 ? TWO_PI / cutoff_m : 0;
    return k2 > 0 ? k2 / (k2 * k2 + pow(cutoff, 4)) : 0;
}

static void fill_wavenumbers(float *k, const ptie_fft *fft, int axis, int32_t count, int32_t points,
                             double pixel_m) {
    for (int32_t i = 0; i < count; i++)
        k[i] = 2 * i == points ? 0 : (float)ptie_fft_wavenumber(fft, axis, i, pixel_m);
}

ptie_status ptie_poisson_prepare(ptie_poisson *q, const ptie_solver_params *p) {
    const int32_t copies = p->boundary == PTIE_MIRROR ? 2 : 1;
    const int32_t w = copies * p->width_px, h = copies * p->height_px;
    PTIE_TRY(ptie_fft_create(&q->fft, PTIE_FFT_REAL, w, h));
    const int32_t columns = ptie_fft_columns(q->fft);
    PTIE_TRY(ptie_alloc_status(&q->inverse, ptie_fft_filter_floats(q->fft), sizeof(float), "solver"));
    PTIE_TRY(ptie_alloc_status(&q->k_x, (size_t)columns, sizeof(float), "solver"));
    PTIE_TRY(ptie_alloc_status(&q->k_y, (size_t)h, sizeof(float), "solver"));
    ptie_fft_filter_fill(q->fft, q->inverse, p->pixel_m, inverse_response, &p->cutoff_m);
    fill_wavenumbers(q->k_x, q->fft, 0, columns, w, p->pixel_m);
    fill_wavenumbers(q->k_y, q->fft, 1, h, h, p->pixel_m);
    return PTIE_OK;
}

void ptie_poisson_clear(ptie_poisson *q) {
    ptie_fft_free(q->fft);
    ptie_free(q->inverse);
    ptie_free(q->k_x);
    ptie_free(q->k_y);
}

ptie_poisson_work ptie_poisson_slice(const ptie_poisson *q, ptie_slicer *slicer) {
    const size_t image = ptie_fft_image_floats(q->fft), spectrum = ptie_fft_spectrum_floats(q->fft);
    ptie_poisson_work work;
    work.slope_x = ptie_slice(slicer, image, sizeof(float));
    work.slope_y = ptie_slice(slicer, image, sizeof(float));
    work.light = ptie_slice(slicer, image, sizeof(float));
    work.spectrum = ptie_slice(slicer, spectrum, sizeof(float));
    work.sum = ptie_slice(slicer, spectrum, sizeof(float));
    return work;
}

/* The image and, where the frame is larger, its mirror images to the right and below. */
static void unfold(float *out, const float *image, const ptie_solver_params *p) {
    const ptrdiff_t w = p->width_px, h = p->height_px, copies = p->boundary == PTIE_MIRROR ? 2 : 1;
    for (ptrdiff_t y = 0; y < copies * h; y++) {
        const float *row = image + (y < h ? y : 2 * h - 1 - y) * w;
        float *to = out + y * copies * w;
        memcpy(to, row, (size_t)w * sizeof *to);
        for (ptrdiff_t x = w; x < copies * w; x++) to[x] = row[2 * w - 1 - x];
    }
}

/* What the slope of psi is divided by: dark pixels have no say in it. */
static void set_divisor(float *out, const float *light, size_t count, double floor) {
    double sum = 0;
    for (size_t i = 0; i < count; i++) sum += (double)light[i];
    const double dark = floor > 0 ? floor : 0.01; /* of the brightest, which is 1 */
    const float instead = (float)(floor > 0 ? floor : sum / (double)count);
    for (size_t i = 0; i < count; i++) out[i] = (double)light[i] < dark ? instead : light[i];
}

/* to += sign i k from: a derivative along the axis. */
static void add_derivative(const ptie_poisson *q, float *restrict to, const float *restrict from, int axis,
                           float sign) {
    const size_t columns = (size_t)ptie_fft_columns(q->fft);
    const size_t rows = ptie_fft_filter_floats(q->fft) / columns;
    for (size_t y = 0; y < rows; y++)
        for (size_t x = 0; x < columns; x++) {
            const size_t i = 2 * (y * columns + x);
            const float k = sign * (axis == 0 ? q->k_x[x] : q->k_y[y]);
            to[i] -= k * from[i + 1];
            to[i + 1] += k * from[i];
        }
}

/* slope (in: psi's spectrum `from`; out): the derivative along the axis over the intensity. */
static void set_slope(const ptie_poisson *q, float *slope, const float *from, int axis, const float *light,
                      float *spectrum) {
    memset(spectrum, 0, ptie_fft_spectrum_floats(q->fft) * sizeof *spectrum);
    add_derivative(q, spectrum, from, axis, +1);
    ptie_fft_inverse(q->fft, slope, spectrum);
    const size_t count = ptie_fft_image_floats(q->fft);
    for (size_t i = 0; i < count; i++) slope[i] /= light[i];
}

void ptie_poisson_step(const ptie_solver *solver, float *phase_rad, const float *slope, const float *light,
                       const ptie_poisson_work *work) {
    const ptie_solver_params *p = &solver->params;
    const ptie_poisson *q = &solver->poisson;
    set_divisor(work->slope_y, light, ptie_solver_pixels(solver), p->intensity_floor);
    unfold(work->light, work->slope_y, p);
    unfold(work->slope_x, slope, p);
    ptie_fft_forward(q->fft, work->sum, work->slope_x);
    ptie_fft_filter_apply(q->fft, work->sum, q->inverse); /* psi / k0 */
    set_slope(q, work->slope_x, work->sum, 0, work->light, work->spectrum);
    set_slope(q, work->slope_y, work->sum, 1, work->light, work->spectrum);
    memset(work->sum, 0, ptie_fft_spectrum_floats(q->fft) * sizeof *work->sum);
    ptie_fft_forward(q->fft, work->spectrum, work->slope_x);
    add_derivative(q, work->sum, work->spectrum, 0, -1);
    ptie_fft_forward(q->fft, work->spectrum, work->slope_y);
    add_derivative(q, work->sum, work->spectrum, 1, -1);
    ptie_fft_filter_apply(q->fft, work->sum, q->inverse);
    ptie_fft_inverse(q->fft, work->slope_x, work->sum);
    const float k0 = (float)(TWO_PI / p->wavelength_m);
    const ptrdiff_t w = p->width_px, pitch = p->boundary == PTIE_MIRROR ? 2 * w : w;
    for (ptrdiff_t y = 0; y < p->height_px; y++)
        for (ptrdiff_t x = 0; x < w; x++) phase_rad[y * w + x] += k0 * work->slope_x[y * pitch + x];
}
