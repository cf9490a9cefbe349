/* SPDX-License-Identifier: BSD-3-Clause */
#include "flow/turbulence.h"

#include <assert.h>
#include <math.h>

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
    float *amplitude, *turns;
    int32_t limit;
    double variance; /* of a phase screen with r0 = 1 unit */
} spectrum_table;

static int32_t signed_mode(int32_t index, int32_t cells) {
    return index < cells / 2 ? index : index - cells;
}

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

/* Two complex normal numbers of this mode, turned by time, scaled; one for each plane. */
static void draw_mode(float *plane_a, float *plane_b, int32_t kx, int32_t ky, uint64_t key,
                      float scale, float turns) {
    uint32_t counter[4] = {(uint32_t)(uint16_t)kx << 16 | (uint16_t)ky, PTIE_STREAM_TEXTURE, 0, 0};
    uint32_t philox_key[2] = {(uint32_t)key, (uint32_t)(key >> 32)}, word[4];
    ptie_philox(word, counter, philox_key);
    float *planes[2] = {plane_a, plane_b};
    for (int p = 0; p < 2; p++) {
        uint32_t a = word[2 * p], b = word[2 * p + 1];
        float radius = scale * sqrtf(-2 * logf(((float)(a >> 8) + 1) * 0x1p-24f));
        float rate = (float)(a & 255) / 127.5f - 1; /* the bits that the radius left over */
        float turn = (float)(b >> 8) * 0x1p-24f + rate * turns;
        float angle = (float)TWO_PI * (turn - floorf(turn));
        planes[p][0] = radius * cosf(angle);
        planes[p][1] = radius * sinf(angle);
    }
}

/* The spectra of both planes; a plane's real and imaginary parts are two independent fields. */
static void fill_spectra(float *a, float *b, const spectrum_table *table, const double *symbol,
                         const ptie_turbulence_params *params) {
    int32_t cells = params->cells, limit = table->limit;
    double gain = (double)cells * cells / sqrt(table->variance);
    for (int32_t y = 0; y < cells; y++) {
        int32_t ky = signed_mode(y, cells);
        for (int32_t x = 0; x < cells; x++) {
            int32_t kx = signed_mode(x, cells), k2 = kx * kx + ky * ky;
            if (k2 == 0 || k2 > limit * limit) continue;
            size_t at = 2 * ((size_t)y * (size_t)cells + (size_t)x);
            double scale = gain * (double)table->amplitude[k2] / (symbol[x] * symbol[y]);
            draw_mode(a + at, b + at, kx, ky, params->key, (float)scale, table->turns[k2]);
        }
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
    float *planes[2] = {0}, *image = NULL;
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
        if (pass == 0)
            PTIE_TRY_DONE(
                ptie_alloc_status(&slicer.base, slicer.used, 1, "scratch of the turbulence"));
    }
    tabulate(&table, params);
    for (int32_t i = 0; i < cells; i++) symbol[i] = spline_symbol(i, cells);
    fill_spectra(planes[0], planes[1], &table, symbol, params);
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

/* Integer part of u modulo cells (a power of two), fraction in t, cubic B-spline weights. */
static int32_t spline_weights(float weight[4], float u, int32_t cells) {
    int32_t whole = (int32_t)u;
    whole -= u < (float)whole;
    float t = u - (float)whole, s = 1 - t;
    weight[0] = s * s * s / 6;
    weight[1] = 2.0f / 3 - t * t * (1 - t / 2);
    weight[2] = 2.0f / 3 - s * s * (1 - s / 2);
    weight[3] = t * t * t / 6;
    return (whole - 1) & (cells - 1);
}

void ptie_turbulence_at(const ptie_turbulence *turbulence, float x, float y, float fields[FIELDS]) {
    int32_t cells = turbulence->cells;
    float across[4], down[4], sum[FIELDS] = {0};
    int32_t left =
        spline_weights(across, x * turbulence->cells_per_unit - turbulence->drift, cells);
    int32_t top = spline_weights(down, y * turbulence->cells_per_unit, cells);
    for (int j = 0; j < 4; j++) {
        size_t row = (size_t)((top + j) & (cells - 1)) * (size_t)(cells + 3) + (size_t)left;
        const float *cell = turbulence->values + row * FIELDS;
        for (int i = 0; i < 4; i++) {
            float weight = across[i] * down[j];
            for (int c = 0; c < FIELDS; c++) sum[c] += weight * cell[i * FIELDS + c];
        }
    }
    for (int c = 0; c < FIELDS; c++) fields[c] = sum[c];
}
