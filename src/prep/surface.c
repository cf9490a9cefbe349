/* SPDX-License-Identifier: BSD-3-Clause */
/* Smooth backgrounds: least squares in products of Legendre polynomials, which span the same
 * surfaces as Zernike's of the same order.  A sum over the frame is a sum over rows of sums over
 * columns, so that a pixel costs one multiplication per degree instead of one per term.
 * docs/math.md (P10). */
#include "prep/surface.h"

#include <math.h>
#include <string.h>

#include "base/clones.h"
#include "base/image.h"
#include "base/memory.h"
#include "prep/cholesky.h"
#include "prep/median.h"

enum { ORDERS = PTIE_SURFACE_DEGREE + 1, TERMS = ORDERS * (ORDERS + 1) / 2, PAIRS = TERMS };

static const double TO_DEVIATION = 1.4826; /* of normal noise, from the median of |residual| */

struct ptie_surface {
    ptie_surface_params params;
    int32_t terms;
    int32_t order_x[TERMS], order_y[TERMS]; /* of each term */
    uint8_t *mask;                          /* (height, width): 0 or 1 */
    size_t samples;                         /* pixels of the mask, evenly spaced ... */
    size_t *sample;                         /* ... that tell how far a pixel may be off */
    float *across[ORDERS];                  /* (width): P_a along x */
    float *pairs[PAIRS];          /* (width): P_a P_b along x, a >= b, at a (a + 1) / 2 + b */
    double *down[ORDERS];         /* (height): P_b along y */
    double factor[TERMS * TERMS]; /* Cholesky's, of the normal equations over the mask */
};

void ptie_surface_params_init(ptie_surface_params *params) {
    *params = (ptie_surface_params){.struct_size = sizeof *params, .degree = 1, .reject = 3};
}

/* Legendre's polynomials of degree 0..4. */
static double legendre(int32_t degree, double x) {
    double before = 0, now = 1;
    for (int32_t n = 0; n < degree; n++) {
        const double next = ((2 * n + 1) * x * now - n * before) / (n + 1);
        before = now, now = next;
    }
    return now;
}

/* The middle of pixel i of n, on -1..1. */
static double position(int32_t i, int32_t n) {
    return (2 * i + 1.0) / n - 1;
}

static ptie_status fill_tables(ptie_surface *s) {
    const int32_t w = s->params.width_px, h = s->params.height_px;
    for (int32_t a = 0; a <= s->params.degree; a++) {
        PTIE_TRY(ptie_alloc_status(&s->across[a], (size_t)w, sizeof(float), "surface"));
        PTIE_TRY(ptie_alloc_status(&s->down[a], (size_t)h, sizeof(double), "surface"));
        for (int32_t x = 0; x < w; x++) s->across[a][x] = (float)legendre(a, position(x, w));
        for (int32_t y = 0; y < h; y++) s->down[a][y] = legendre(a, position(y, h));
        for (int32_t b = 0; b <= a; b++) {
            float **pair = &s->pairs[a * (a + 1) / 2 + b];
            PTIE_TRY(ptie_alloc_status(pair, (size_t)w, sizeof(float), "surface"));
            for (int32_t x = 0; x < w; x++) (*pair)[x] = s->across[a][x] * s->across[b][x];
            s->order_x[s->terms] = b, s->order_y[s->terms] = a - b;
            s->terms++;
        }
    }
    return PTIE_OK;
}

/* Sum of a[i] b[i], in lanes: the order is fixed, and it vectorises. */
PTIE_CLONES static double dot(const float *restrict a, const float *restrict b, int32_t n) {
    enum { LANES = 16 };
    double lanes[LANES] = {0}, sum = 0;
    int32_t i = 0;
    for (; i + LANES <= n; i += LANES)
        for (int32_t k = 0; k < LANES; k++) lanes[k] += (double)(a[i + k] * b[i + k]);
    for (; i < n; i++) sum += (double)(a[i] * b[i]);
    for (int32_t k = 0; k < LANES; k++) sum += lanes[k];
    return sum;
}

/* Normal equations over the pixels of `use`, factored.  False: too few pixels to tell the terms
 * apart. */
static bool factor(double *matrix, const ptie_surface *s, const uint8_t *use, float *row) {
    const int32_t w = s->params.width_px, pairs = s->terms;
    memset(matrix, 0, TERMS * TERMS * sizeof *matrix);
    for (int32_t y = 0; y < s->params.height_px; y++) {
        double sums[PAIRS];
        for (int32_t x = 0; x < w; x++) row[x] = use[(ptrdiff_t)y * w + x] ? 1 : 0;
        for (int32_t p = 0; p < pairs; p++) sums[p] = dot(row, s->pairs[p], w);
        for (int32_t i = 0; i < s->terms; i++)
            for (int32_t j = 0; j <= i; j++) {
                const int32_t a = s->order_x[i] > s->order_x[j] ? s->order_x[i] : s->order_x[j];
                const int32_t b = s->order_x[i] + s->order_x[j] - a;
                matrix[i * s->terms + j] += sums[a * (a + 1) / 2 + b] * s->down[s->order_y[i]][y] *
                                            s->down[s->order_y[j]][y];
            }
    }
    return ptie_cholesky(matrix, s->terms);
}

PTIE_CLONES static void masked_row(float *restrict row, const float *restrict map,
                                   const uint8_t *restrict use, int32_t width) {
    for (int32_t x = 0; x < width; x++) row[x] = use[x] ? map[x] : 0;
}

/* coefficient (out): of the least-squares surface through the pixels of `use`. */
static void fit(double coefficient[TERMS], const ptie_surface *s, const double *matrix,
                const float *map, const uint8_t *use, float *row) {
    const int32_t w = s->params.width_px;
    memset(coefficient, 0, TERMS * sizeof *coefficient);
    for (int32_t y = 0; y < s->params.height_px; y++) {
        double sums[ORDERS];
        masked_row(row, map + (ptrdiff_t)y * w, use + (ptrdiff_t)y * w, w);
        for (int32_t a = 0; a <= s->params.degree; a++) sums[a] = dot(row, s->across[a], w);
        for (int32_t i = 0; i < s->terms; i++)
            coefficient[i] += sums[s->order_x[i]] * s->down[s->order_y[i]][y];
    }
    ptie_cholesky_solve(matrix, s->terms, coefficient);
}

PTIE_CLONES static void subtract_row(float *restrict out, const float *restrict map,
                                     const float *restrict across, float weight, int32_t width) {
    for (int32_t x = 0; x < width; x++) out[x] = map[x] - weight * across[x];
}

/* out = map - surface; out may be the map. */
static void subtract(float *out, const ptie_surface *s, const double coefficient[TERMS],
                     const float *map) {
    const int32_t w = s->params.width_px;
    for (int32_t y = 0; y < s->params.height_px; y++) {
        double weight[ORDERS] = {0};
        for (int32_t i = 0; i < s->terms; i++)
            weight[s->order_x[i]] += coefficient[i] * s->down[s->order_y[i]][y];
        const float *from = map + (ptrdiff_t)y * w;
        float *to = out + (ptrdiff_t)y * w;
        for (int32_t a = 0; a <= s->params.degree; a++, from = to)
            subtract_row(to, from, s->across[a], (float)weight[a], w);
    }
}

/* MOST pixels of the mask at most: enough to know a median to 1 %. */
static ptie_status choose_samples(ptie_surface *s, size_t pixels) {
    enum { MOST = 16384 };
    size_t count = 0, seen = 0;
    for (size_t i = 0; i < pixels; i++) count += s->mask[i];
    const size_t step = (count + MOST - 1) / MOST;
    PTIE_TRY(
        ptie_alloc_status(&s->sample, count < MOST ? count : MOST, sizeof *s->sample, "surface"));
    for (size_t i = 0; i < pixels; i++)
        if (s->mask[i] && seen++ % step == 0) s->sample[s->samples++] = i;
    return PTIE_OK;
}

ptie_status ptie_prep_surface(ptie_surface **out, const ptie_surface_params *params,
                              const uint8_t *mask) {
    *out = NULL;
    ptie_surface *s;
    float *row = NULL;
    const size_t pixels = (size_t)params->width_px * (size_t)params->height_px;
    PTIE_TRY(ptie_alloc_status(&s, 1, sizeof *s, "surface"));
    s->params = *params;
    ptie_status status;
    PTIE_TRY_DONE(ptie_alloc_status(&s->mask, pixels, 1, "surface"));
    PTIE_TRY_DONE(ptie_alloc_status(&row, (size_t)params->width_px, sizeof *row, "surface"));
    PTIE_TRY_DONE(fill_tables(s));
    for (size_t i = 0; i < pixels; i++) s->mask[i] = !mask || mask[i];
    PTIE_TRY_DONE(choose_samples(s, pixels));
    if (!factor(s->factor, s, s->mask, row))
        status =
            PTIE_FAIL(PTIE_EINVAL,
                      "surface: mask leaves too little to fit (expected pixels that tell %d terms "
                      "apart)",
                      s->terms);
done:
    ptie_free(row);
    if (status == PTIE_OK)
        *out = s;
    else
        ptie_surface_free(s);
    return status;
}

void ptie_surface_free(ptie_surface *s) {
    if (!s) return;
    for (int i = 0; i < ORDERS; i++) {
        ptie_free(s->across[i]);
        ptie_free(s->down[i]);
    }
    for (int i = 0; i < PAIRS; i++) ptie_free(s->pairs[i]);
    ptie_free(s->mask);
    ptie_free(s->sample);
    ptie_free(s);
}

typedef struct scratch {
    float *row, *residual, *values; /* (width), (height, width), (samples) */
    uint8_t *use;                   /* (height, width) */
} scratch;

static scratch carve(ptie_slicer *slicer, const ptie_surface *s) {
    const size_t all = (size_t)s->params.width_px * (size_t)s->params.height_px;
    const size_t pixels = s->params.rounds ? all : 0;
    scratch work;
    work.row = ptie_slice(slicer, (size_t)s->params.width_px, sizeof *work.row);
    work.residual = ptie_slice(slicer, pixels, sizeof *work.residual);
    work.values = ptie_slice(slicer, s->samples, sizeof *work.values);
    work.use = ptie_slice(slicer, pixels, sizeof *work.use);
    return work;
}

size_t ptie_prep_surface_scratch(const ptie_surface *s) {
    ptie_slicer slicer = {0};
    carve(&slicer, s);
    return slicer.used;
}

PTIE_CLONES static void choose(uint8_t *restrict use, const uint8_t *restrict mask,
                               const float *restrict residual, float middle, float limit,
                               size_t pixels) {
    for (size_t i = 0; i < pixels; i++) use[i] = mask[i] & (fabsf(residual[i] - middle) <= limit);
}

/* Pixels of the mask within `times` the median distance from the surface, which rejected ones do
   not set; the median of the samples. */
static void reject(const ptie_surface *s, const scratch *work, double times) {
    for (size_t i = 0; i < s->samples; i++) work->values[i] = work->residual[s->sample[i]];
    const float middle = (float)ptie_median(work->values, s->samples);
    for (size_t i = 0; i < s->samples; i++) work->values[i] = fabsf(work->values[i] - middle);
    const float limit = (float)(times * ptie_median(work->values, s->samples));
    choose(work->use, s->mask, work->residual, middle, limit,
           (size_t)s->params.width_px * (size_t)s->params.height_px);
}

ptie_status ptie_prep_surface_remove(const ptie_surface *s, float *map, void *scratch_block) {
    ptie_slicer slicer = {.base = scratch_block};
    const scratch work = carve(&slicer, s);
    double coefficient[TERMS], matrix[TERMS * TERMS];
    PTIE_TRY(ptie_image_finite(map, s->params.width_px, s->params.height_px, "map"));
    fit(coefficient, s, s->factor, map, s->mask, work.row);
    for (int32_t i = 0; i < s->params.rounds;
         i++) { /* half the pixels, trimmed; then all but outliers */
        subtract(work.residual, s, coefficient, map);
        reject(s, &work, i < s->params.rounds / 2 ? 1 : TO_DEVIATION * s->params.reject);
        if (!factor(matrix, s, work.use, work.row))
            return PTIE_FAIL(PTIE_ENUMERIC, "surface: outlier rejection leaves too little to fit");
        fit(coefficient, s, matrix, map, work.use, work.row);
    }
    subtract(map, s, coefficient, map);
    return PTIE_OK;
}
