/* SPDX-License-Identifier: BSD-3-Clause */
/* Sums over pixels are taken over the spectrum (Parseval), so no map has to be transformed back. */
#include "run/reprojection.h"

#include <math.h>
#include <string.h>

#include "base/clones.h"
#include "base/memory.h"
#include "fft/fft.h"
#include "rig/planes.h"
#include "tie/solver.h"

#define TWO_PI 6.283185307179586476925

struct ptie_reprojection {
    ptie_solver *solver; /* by diffraction; NULL: by the linear model, which has all of the rest */
    ptie_fft *fft;
    /* Per float of the spectrum: the root of how often it counts, 0 for the mean, which is not compared; and that
       times the forward model, a phase's dI/dz / I. */
    float *count, *forward;
    size_t pixels, entries, floats, bytes; /* of an image, a spectrum and its buffer, and one worker's scratch */
    unsigned char *scratch;
};

/* A worker's scratch. */
typedef struct work {
    float *image, *measured, *reprojected; /* (H, W); spectra */
} work;

static work carve(const ptie_reprojection *r, ptie_slicer *slicer) {
    work w;
    w.image = ptie_slice(slicer, r->pixels, sizeof(float));
    w.measured = ptie_slice(slicer, r->floats, sizeof(float));
    w.reprojected = ptie_slice(slicer, r->floats, sizeof(float));
    return w;
}

static double forward_response(double k2, const void *context) {
    return ((const ptie_solver_params *)context)->wavelength_m / TWO_PI * k2;
}

static ptie_status build_linear(ptie_reprojection *r, const ptie_solver_params *solver) {
    PTIE_TRY(ptie_fft_create(&r->fft, solver->boundary == PTIE_MIRROR ? PTIE_FFT_MIRROR : PTIE_FFT_REAL,
                             solver->width_px, solver->height_px));
    const size_t per_entry = ptie_fft_entry_floats(r->fft), columns = (size_t)ptie_fft_columns(r->fft);
    r->entries = ptie_fft_filter_floats(r->fft) * per_entry;
    PTIE_TRY(ptie_alloc_status(&r->count, r->entries, sizeof(float), "reprojection"));
    PTIE_TRY(ptie_alloc_status(&r->forward, r->entries, sizeof(float), "reprojection"));
    ptie_fft_filter_fill(r->fft, r->forward, solver->pixel_m, forward_response, solver);
    for (size_t i = r->entries; i-- > 0;) { /* from the end: forward is spread in place */
        const size_t k = i / per_entry;
        r->count[i] = k > 0 ? (float)sqrt(ptie_fft_share(r->fft, (int32_t)(k % columns), (int32_t)(k / columns))) : 0;
        r->forward[i] = r->count[i] * r->forward[k];
    }
    r->floats = ptie_fft_spectrum_floats(r->fft);
    ptie_slicer slicer = {0};
    carve(r, &slicer);
    r->bytes = slicer.used;
    return PTIE_OK;
}

static ptie_status build_diffraction(ptie_reprojection *r, ptie_solver_params solver) {
    if (solver.method == PTIE_SOLVE_DIRECT) solver.method = PTIE_SOLVE_MAX_INTENSITY; /* has a wave */
    PTIE_TRY(ptie_tie_plan(&r->solver, &solver));
    r->bytes = ptie_tie_scratch(r->solver);
    return PTIE_OK;
}

/* The linear model has no dark places. */
static ptie_status build(ptie_reprojection *r, const ptie_solver_params *solver, int32_t workers) {
    const bool linear = solver->method == PTIE_SOLVE_DIRECT && !solver->mask;
    PTIE_TRY(linear ? build_linear(r, solver) : build_diffraction(r, *solver));
    return ptie_alloc_status(&r->scratch, (size_t)workers, r->bytes, "run: scratch");
}

ptie_status ptie_reprojection_create(ptie_reprojection **out, const ptie_rig *rig, const uint8_t *mask,
                                     int32_t width_px, int32_t height_px, int32_t workers) {
    *out = NULL;
    ptie_reprojection *r;
    PTIE_TRY(ptie_alloc_status(&r, 1, sizeof *r, "run"));
    ptie_solver_params solver = ptie_rig_solver(rig, width_px, height_px);
    solver.mask = mask;
    r->pixels = (size_t)width_px * (size_t)height_px;
    ptie_status status = build(r, &solver, workers);
    if (status == PTIE_OK)
        *out = r;
    else
        ptie_reprojection_free(r);
    return status;
}

void ptie_reprojection_free(ptie_reprojection *r) {
    if (!r) return;
    ptie_solver_free(r->solver);
    ptie_fft_free(r->fft);
    ptie_free(r->count);
    ptie_free(r->forward);
    ptie_free(r->scratch);
    ptie_free(r);
}

/* Sums of (f a - c b)^2 and of (c b)^2, in lanes: this vectorises, and every instruction set gives the same bits. */
enum { LANES = 16 };
typedef struct sums {
    double off[LANES], all[LANES];
} sums;

/* a: map, f: forward; b: measured, c: count, as long as a spectrum. */
PTIE_INLINE void add_square(sums *s, size_t lane, float a, float f, float b, float c) {
    const float measured = c * b;
    const double off = (double)(f * a) - (double)measured;
    s->off[lane] += off * off;
    s->all[lane] += (double)measured * (double)measured;
}

PTIE_CLONES static void add_squares(sums *restrict s, const float *restrict a, const float *restrict f,
                                    const float *restrict b, const float *restrict c, size_t count) {
    const size_t whole = count / LANES * LANES;
    for (size_t i = 0; i < whole; i += LANES)
        for (size_t l = 0; l < LANES; l++) add_square(s, l, a[i + l], f[i + l], b[i + l], c[i + l]);
    for (size_t i = whole; i < count; i++) add_square(s, i - whole, a[i], f[i], b[i], c[i]);
}

static double relative_distance(const ptie_reprojection *r, const work *w) {
    sums s = {{0}, {0}};
    double off = 0, all = 0;
    add_squares(&s, w->reprojected, r->forward, w->measured, r->count, r->entries);
    for (int l = 0; l < LANES; l++) off += s.off[l], all += s.all[l];
    return all > 0 ? sqrt(off / all) : (double)NAN;
}

static work work_of(const ptie_reprojection *r, int32_t worker) {
    return carve(r, &(ptie_slicer){.base = r->scratch + (size_t)worker * r->bytes});
}

float *ptie_reprojection_measured(const ptie_reprojection *r, int32_t worker) {
    return r->solver ? NULL : work_of(r, worker).measured;
}

ptie_status ptie_reprojection_measure(const ptie_reprojection *r, int32_t worker, double *residual,
                                      const float *const *maps, size_t count, const float *const *planes) {
    if (r->solver)
        return ptie_tie_reproject(r->solver, residual, maps, count, planes, r->scratch + (size_t)worker * r->bytes);
    const work w = work_of(r, worker);
    for (size_t n = 0; n < count; n++) {
        memcpy(w.image, maps[n], r->pixels * sizeof *w.image);
        ptie_fft_forward(r->fft, w.reprojected, w.image);
        residual[n] = relative_distance(r, &w);
    }
    return PTIE_OK;
}
