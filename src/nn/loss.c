/* SPDX-License-Identifier: BSD-3-Clause */
#include "nn/loss.h"

#include <assert.h>
#include <math.h>

#include "base/memory.h"

enum { WINDOW = PTIE_SSIM_WINDOW, MARGIN = WINDOW - 1, ROW_SLACK = 64 };

/* Weight of a pixel's squared error (paper Eq. 10): 1 in the background, 5 where the flow is
 * densest. */
static float pixel_weight(float clean) {
    return 1 + 4 * clean;
}

/* L1 and WMSE (L1), (L2).  gradient may be NULL. */
static void measure_pixels(ptie_loss_parts *parts, float *gradient, const float *estimate,
                           const float *clean, size_t count, ptie_loss_weights weights,
                           double scale) {
    double l1 = 0, wmse = 0, mse = 0;
    for (size_t i = 0; i < count; i++) {
        float d = estimate[i] - clean[i], square = d * d;
        l1 += (double)fabsf(d);
        wmse += (double)(pixel_weight(clean[i]) * square);
        mse += (double)square;
    }
    parts->l1 = l1 / (double)count;
    parts->wmse = wmse / (double)count;
    parts->mse = mse / (double)count;
    if (!gradient) return;
    const float by_l1 = (float)(scale * weights.l1 / (double)count);
    const float by_mse = (float)(2 * scale * weights.mse / (double)count);
    for (size_t i = 0; i < count; i++) {
        float d = estimate[i] - clean[i];
        float sign = (float)((d > 0) - (d < 0));
        gradient[i] = by_l1 * sign + by_mse * pixel_weight(clean[i]) * d;
    }
}

/* What SSIM needs: windowed means of x (estimate), y (clean) and their products, valid windows
 * only. */
typedef struct ssim_maps {
    float *x, *y, *xx, *yy, *xy; /* (H-10, W-10) */
    float *image;                /* (H, W): a product, or a map spread back */
    float *row;
    size_t bytes;
} ssim_maps;

static ssim_maps slice_maps(void *scratch, int32_t width, int32_t height) {
    ptie_slicer slicer = {.base = scratch};
    const size_t windows = (size_t)(width - MARGIN) * (size_t)(height - MARGIN);
    ssim_maps maps;
    float **const each[] = {&maps.x, &maps.y, &maps.xx, &maps.yy, &maps.xy};
    for (size_t i = 0; i < sizeof each / sizeof *each; i++)
        *each[i] = ptie_slice(&slicer, windows, sizeof(float));
    maps.image = ptie_slice(&slicer, (size_t)width * (size_t)height, sizeof(float));
    maps.row = ptie_slice(&slicer, (size_t)width + ROW_SLACK, sizeof(float));
    maps.bytes = slicer.used;
    return maps;
}

size_t ptie_loss_scratch(int32_t width, int32_t height) {
    return slice_maps(NULL, width, height).bytes;
}

/* Gaussian of standard deviation 1.5, sum 1. */
static void window_taps(float taps[WINDOW]) {
    double weights[WINDOW], sum = 0;
    for (int i = 0; i < WINDOW; i++) {
        double t = (i - WINDOW / 2) / 1.5;
        sum += weights[i] = exp(-t * t / 2);
    }
    for (int i = 0; i < WINDOW; i++) taps[i] = (float)(weights[i] / sum);
}

static const float *product(float *out, const float *a, const float *b, size_t count) {
    for (size_t i = 0; i < count; i++) out[i] = a[i] * b[i];
    return out;
}

/* SSIM of every window (L3) and its derivatives: x, xx, xy become `scale` times those with respect
   to the windowed means of x, x^2 and x y; yy becomes the SSIM itself. */
static void differentiate_ssim(const ssim_maps *maps, size_t count, float scale) {
    const float c1 = 0.01f * 0.01f, c2 = 0.03f * 0.03f;
    for (size_t i = 0; i < count; i++) {
        float x = maps->x[i], y = maps->y[i];
        float a1 = 2 * x * y + c1, a2 = 2 * (maps->xy[i] - x * y) + c2;
        float b1 = x * x + y * y + c1, b2 = maps->xx[i] - x * x + maps->yy[i] - y * y + c2;
        float inverse = 1 / (b1 * b2), ssim = a1 * a2 * inverse;
        maps->x[i] = scale * 2 * (y * (a2 - a1) * inverse + x * ssim * (b1 - b2) * inverse);
        maps->xx[i] = -scale * ssim * b1 * inverse;
        maps->xy[i] = scale * 2 * a1 * inverse;
        maps->yy[i] = ssim;
    }
}

/* Mean SSIM; adds scale times its gradient. */
static double measure_ssim(const ptie_kernels *kernels, float *gradient, const float *x,
                           const float *y, int32_t width, int32_t height, double scale,
                           const ssim_maps *maps) {
    const size_t count = (size_t)width * (size_t)height;
    const size_t windows = (size_t)(width - MARGIN) * (size_t)(height - MARGIN);
    float taps[WINDOW];
    window_taps(taps);
    kernels->window(maps->x, x, width, height, taps, maps->row);
    kernels->window(maps->y, y, width, height, taps, maps->row);
    kernels->window(maps->xx, product(maps->image, x, x, count), width, height, taps, maps->row);
    kernels->window(maps->yy, product(maps->image, y, y, count), width, height, taps, maps->row);
    kernels->window(maps->xy, product(maps->image, x, y, count), width, height, taps, maps->row);
    differentiate_ssim(maps, windows, (float)(scale / (double)windows));
    double sum = 0;
    for (size_t i = 0; i < windows; i++) sum += (double)maps->yy[i];

    if (gradient) {
        kernels->window_adjoint(maps->image, maps->x, width, height, taps, maps->row);
        for (size_t i = 0; i < count; i++) gradient[i] += maps->image[i];
        kernels->window_adjoint(maps->image, maps->xx, width, height, taps, maps->row);
        for (size_t i = 0; i < count; i++) gradient[i] += 2 * x[i] * maps->image[i];
        kernels->window_adjoint(maps->image, maps->xy, width, height, taps, maps->row);
        for (size_t i = 0; i < count; i++) gradient[i] += y[i] * maps->image[i];
    }
    return sum / (double)windows;
}

void ptie_loss_evaluate(const ptie_kernels *kernels, ptie_loss_parts *parts, float *gradient,
                        const float *estimate, const float *clean, int32_t width, int32_t height,
                        ptie_loss_weights weights, double scale, void *scratch) {
    assert(width >= WINDOW && height >= WINDOW);
    const ssim_maps maps = slice_maps(scratch, width, height);
    measure_pixels(parts, gradient, estimate, clean, (size_t)width * (size_t)height, weights,
                   scale);
    parts->ssim = measure_ssim(kernels, gradient, estimate, clean, width, height,
                               -scale * weights.ssim, &maps);
    parts->loss =
        weights.l1 * parts->l1 + weights.ssim * (1 - parts->ssim) + weights.mse * parts->wmse;
}

void ptie_loss_measure(const ptie_engine *engine, ptie_loss_parts *parts, const float *estimate,
                       const float *clean, int32_t width, int32_t height, ptie_loss_weights weights,
                       void *scratch) {
    ptie_loss_evaluate(engine->kernels, parts, NULL, estimate, clean, width, height, weights, 1,
                       scratch);
}
