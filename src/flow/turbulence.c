/* SPDX-License-Identifier: BSD-3-Clause */
#include "flow/turbulence.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "fft/fft.h"

#define TWO_PI 6.28318530717958647693
#define FIELDS PTIE_TURBULENCE_FIELDS

double ptie_von_karman(double frequency, double outer, double inner) {
    double f0 = 1 / outer, fm = 5.92 / (TWO_PI * inner);
    return 0.023 * exp(-(frequency / fm) * (frequency / fm)) *
           pow(frequency * frequency + f0 * f0, -11.0 / 6);
}

ptie_turbulence_params ptie_turbulence_draw(const ptie_scene *scene, ptie_random *random,
                                            double outer, double inner, double speed) {
    double width = scene->width, height = scene->height, unit_px = fmin(width, height);
    /* Longer than the frame, tilted or not, so that no eddy is seen twice. */
    double period = fmax(1.6 * fmax(width, height) / unit_px, 2 * outer);
    int32_t cells = 32;
    while (cells < 1024 && cells * 4.5 < period * unit_px) cells *= 2;
    double way = speed * scene->time_s, pace = ptie_random_uniform(random, 0.03, 0.12);
    return (ptie_turbulence_params){.key = ptie_key_draw(random),
                                    .period = period,
                                    .outer = outer,
                                    .inner = inner * outer,
                                    .drift = way,
                                    .turns = pace * way / outer,
                                    .cells = cells};
}

/* Amplitude and turning rate of the modes with kx^2 + ky^2 = k2, for k2 up to `limit`^2. */
typedef struct spectrum_table {
    float *amplitude, *turns; /* of mode 0: 0 */
    int32_t limit;
    double variance; /* of a phase screen with r0 = 1 unit */
} spectrum_table;

static void tabulate(spectrum_table *table, const ptie_turbulence_params *params) {
    int32_t limit = table->limit;
    double step = 1 / params->period; /* cycles per unit between modes */
    for (int32_t k2 = 1; k2 <= limit * limit; k2++) {
        double f = sqrt(k2) * step;
        table->amplitude[k2] =
            (float)sqrt(ptie_von_karman(f, params->outer, params->inner) * step * step);
        table->turns[k2] = (float)(params->turns * cbrt(f * f * params->outer * params->outer));
    }
    for (int32_t ky = -limit; ky <= limit; ky++)
        for (int32_t kx = -limit; kx <= limit; kx++) {
            int32_t k2 = kx * kx + ky * ky;
            if (k2 > 0 && k2 <= limit * limit)
                table->variance += (double)table->amplitude[k2] * (double)table->amplitude[k2];
        }
}

/* Fourier symbol of the cubic B-spline sampled at its nodes: dividing by it makes the spline pass
   through the field's values. */
static double spline_symbol(int32_t mode, int32_t cells) {
    return (2 + cos(TWO_PI * mode / cells)) / 3;
}

/* A complex normal number of standard deviation `scale`, turned by time, from two random words. */
PTIE_INLINE void draw_mode(float *mode, uint32_t a, uint32_t b, float scale, float turns) {
    const float uniform = (float)(int32_t)((a >> 8) + 1) * 0x1p-24f;
    const float rate = (float)(int32_t)(a & 255) / 127.5f - 1; /* bits that the radius left over */
    const float turn = (float)(int32_t)(b >> 8) * 0x1p-24f + rate * turns;
    const float radius = scale * sqrtf(-2 * ptie_logf(uniform));
    float sine, cosine;
    ptie_turnf(turn - ptie_floorf(turn), &sine, &cosine);
    mode[0] = radius * cosine;
    mode[1] = radius * sine;
}

/* Modes (kx, ky) for kx = first .. first + count - 1, for both planes. */
PTIE_CLONES static void draw_modes(float *plane_a, float *plane_b, int32_t first, int32_t count,
                                   int32_t ky, const float *scale, const float *turns,
                                   uint64_t key) {
    const uint32_t philox_key[2] = {(uint32_t)key, (uint32_t)(key >> 32)};
    for (int32_t i = 0; i < count; i++) {
        const uint32_t kx = (uint32_t)(first + i) & 0xffff;
        const uint32_t counter[4] = {kx << 16 | ((uint32_t)ky & 0xffff), PTIE_STREAM_TEXTURE, 0, 0};
        uint32_t word[4];
        ptie_philox(word, counter, philox_key);
        draw_mode(plane_a + 2 * i, word[0], word[1], scale[i], turns[i]);
        draw_mode(plane_b + 2 * i, word[2], word[3], scale[i], turns[i]);
    }
}

/* The spectra of both planes; a plane's real and imaginary parts are two independent fields.  `row`:
   scratch of 2 * cells floats. */
static void fill_spectra(float *a, float *b, const spectrum_table *table, const double *symbol,
                         float *row, const ptie_turbulence_params *params) {
    const int32_t cells = params->cells, limit = table->limit;
    const double gain = (double)cells * cells / sqrt(table->variance);
    float *scale = row, *turns = row + cells;
    for (int32_t ky = -limit; ky <= limit; ky++) {
        const int32_t y = ky & (cells - 1), reach = (int32_t)sqrt(limit * limit - ky * ky);
        for (int32_t kx = -reach; kx <= reach; kx++) {
            const int32_t x = kx & (cells - 1), k2 = kx * kx + ky * ky;
            scale[x] = (float)(gain / (symbol[x] * symbol[y]) * (double)table->amplitude[k2]);
            turns[x] = table->turns[k2];
        }
        const size_t at = 2 * (size_t)y * (size_t)cells, left = (size_t)(cells - reach);
        draw_modes(a + at, b + at, 0, reach + 1, ky, scale, turns, params->key);
        draw_modes(a + at + 2 * left, b + at + 2 * left, -reach, reach, ky, scale + left,
                   turns + left, params->key);
    }
}

/* Weaves a plane into fields 2 * plane and 2 * plane + 1, with three columns wrapped around. */
static void weave(ptie_turbulence *turbulence, const float *image, int plane) {
    int32_t cells = turbulence->cells;
    for (int32_t y = 0; y < cells; y++)
        for (int32_t x = 0; x < cells + 3; x++) {
            size_t from = 2 * ((size_t)y * (size_t)cells + (size_t)(x % cells));
            size_t to = ((size_t)y * (size_t)(cells + 3) + (size_t)x) * FIELDS + 2 * (size_t)plane;
            turbulence->values[to] = image[from];
            turbulence->values[to + 1] = image[from + 1];
        }
}

static ptie_status synthesise(ptie_turbulence *turbulence, const ptie_turbulence_params *params) {
    int32_t cells = params->cells;
    size_t n = (size_t)cells;
    spectrum_table table = {.limit = cells * 3 / 8};
    size_t rings = (size_t)(table.limit * table.limit) + 1;
    ptie_fft *fft = NULL;
    ptie_slicer slicer = {0};
    float *planes[2] = {0}, *image = NULL, *row = NULL;
    double *symbol = NULL;
    ptie_status status = PTIE_OK;
    PTIE_TRY_DONE(ptie_fft_create(&fft, PTIE_FFT_COMPLEX, cells, cells));
    for (int pass = 0; pass < 2; pass++) {
        slicer.used = 0;
        for (int p = 0; p < 2; p++) planes[p] = ptie_slice(&slicer, 2 * n * n, sizeof(float));
        image = ptie_slice(&slicer, 2 * n * n, sizeof(float));
        table.amplitude = ptie_slice(&slicer, rings, sizeof(float));
        table.turns = ptie_slice(&slicer, rings, sizeof(float));
        symbol = ptie_slice(&slicer, n, sizeof(double));
        row = ptie_slice(&slicer, 2 * n, sizeof(float));
        if (pass == 0)
            PTIE_TRY_DONE(
                ptie_alloc_status(&slicer.base, slicer.used, 1, "scratch of the turbulence"));
    }
    tabulate(&table, params);
    for (int32_t i = 0; i < cells; i++) symbol[i] = spline_symbol(i, cells);
    fill_spectra(planes[0], planes[1], &table, symbol, row, params);
    for (int p = 0; p < 2; p++) {
        ptie_fft_inverse(fft, image, planes[p]);
        weave(turbulence, image, p);
    }
    turbulence->screen_rad = (float)sqrt(table.variance);
done:
    ptie_free(slicer.base);
    ptie_fft_free(fft);
    return status;
}

ptie_status ptie_turbulence_create(ptie_turbulence *out, const ptie_turbulence_params *params) {
    assert(params->cells >= 16 && params->cells <= 4096 && params->inner < params->outer);
    size_t n = (size_t)params->cells;
    double per_unit = params->cells / params->period;
    *out = (ptie_turbulence){
        .cells = params->cells,
        .cells_per_unit = (float)per_unit,
        .drift = (float)fmod(params->drift * per_unit, params->cells),
    };
    PTIE_TRY(ptie_alloc_status(&out->values, n * (n + 3) * FIELDS, sizeof(float), "turbulence"));
    ptie_status status = synthesise(out, params);
    if (status != PTIE_OK) ptie_turbulence_free(out);
    return status;
}

void ptie_turbulence_free(ptie_turbulence *turbulence) {
    ptie_free(turbulence->values);
    turbulence->values = NULL;
}

/* Where points lie between the nodes along one axis: the first of four, and their weights. */
typedef struct knots {
    int32_t first[PTIE_LINE];
    float weight[4][PTIE_LINE];
} knots;

/* Integer part of u modulo cells (a power of two), cubic B-spline weights of its fraction;
   u = x * scale - drift. */
PTIE_CLONES static void find_knots(knots *at, const float *x, int count, float scale, float drift,
                                   int32_t cells) {
    for (int i = 0; i < count; i++) {
        const float u = x[i] * scale - drift, whole = ptie_floorf(u), t = u - whole, s = 1 - t;
        at->first[i] = ((int32_t)whole - 1) & (cells - 1);
        at->weight[0][i] = s * s * s * (1.0f / 6);
        at->weight[1][i] = 2.0f / 3 - t * t * (1 - t / 2);
        at->weight[2][i] = 2.0f / 3 - s * s * (1 - s / 2);
        at->weight[3][i] = t * t * t * (1.0f / 6);
    }
}

/* The fields of one node, in one register. */
typedef float node __attribute__((vector_size(FIELDS * sizeof(float))));

static void interpolate(const ptie_turbulence *turbulence, float fields[][FIELDS], const float *x,
                        const float *y, int count) {
    const int32_t cells = turbulence->cells;
    knots across, down;
    find_knots(&across, x, count, turbulence->cells_per_unit, turbulence->drift, cells);
    find_knots(&down, y, count, turbulence->cells_per_unit, 0, cells);
    for (int n = 0; n < count; n++) {
        node sum[4] = {0}; /* down the four columns */
        for (int j = 0; j < 4; j++) {
            size_t row = (size_t)((down.first[n] + j) & (cells - 1)) * (size_t)(cells + 3);
            const node *from = (const node *)(const void *)turbulence->values + row + across.first[n];
            for (int i = 0; i < 4; i++) sum[i] += down.weight[j][n] * from[i];
        }
        for (int i = 1; i < 4; i++) sum[i] *= across.weight[i][n];
        sum[0] = sum[0] * across.weight[0][n] + sum[1] + (sum[2] + sum[3]);
        memcpy(fields[n], sum, sizeof sum[0]);
    }
}

void ptie_turbulence_at(const ptie_turbulence *turbulence, float x, float y, float fields[FIELDS]) {
    interpolate(turbulence, (float(*)[FIELDS])fields, &x, &y, 1);
}

void ptie_turbulence_line(const ptie_turbulence *turbulence, float fields[PTIE_LINE][FIELDS],
                          const float *x, const float *y) {
    interpolate(turbulence, fields, x, y, PTIE_LINE);
}
