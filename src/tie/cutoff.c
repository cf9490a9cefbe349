/* SPDX-License-Identifier: BSD-3-Clause */
/* The cut-off of (M6) from one frame: the smallest expected error, or the corner of the L-curve.
 * docs/math.md (M15), (M16). */
#include <math.h>

#include "tie/inner.h"

#define TWO_PI 6.283185307179586476925

/* Cut-offs tried, evenly spaced in the logarithm from four times the frame to four pixels: 7 % apart for
   1024 pixels. */
enum { TRIALS = 97 };

/* What the planes say of g = (2 pi / lambda) (dI/dz) / I, per entry of its spectrum. */
typedef struct spectrum {
    size_t entries;
    float *energy; /* share in the sum of g^2 */
    float *modes;  /* that it stands for */
    double noise;  /* energy per mode expected from noise alone */
    float *k2;
} spectrum;

static double itself(double k2, const void *context) {
    (void)context;
    return k2;
}

static void fill_spectrum(spectrum *s, const ptie_solver *solver, const float *values) {
    const ptie_fft *fft = solver->fft;
    const double k0 = TWO_PI / solver->params.wavelength_m;
    const size_t parts = ptie_fft_entry_floats(fft);
    const int32_t columns = ptie_fft_columns(fft);
    for (size_t i = 0; i < s->entries; i++) {
        const int32_t x = (int32_t)(i % (size_t)columns), y = (int32_t)(i / (size_t)columns);
        double squares = 0;
        for (size_t j = i * parts; j < (i + 1) * parts; j++) squares += (double)values[j] * (double)values[j];
        s->energy[i] = (float)(squares * ptie_fft_share(fft, x, y) * k0 * k0);
        s->modes[i] = (float)ptie_fft_multiplicity(fft, x);
    }
    ptie_fft_filter_fill(fft, s->k2, solver->params.pixel_m, itself, NULL);
}

/* Mean energy per mode of the finest structures, beyond 0.7 of the Nyquist frequency, where a phase has hardly any
   light to move: the noise. */
static double fine_energy(const spectrum *s, double pixel_m) {
    const double fine = pow(0.7 * TWO_PI / (2 * pixel_m), 2);
    double energy = 0, modes = 0;
    for (size_t i = 0; i < s->entries; i++)
        if ((double)s->k2[i] > fine) energy += (double)s->energy[i], modes += (double)s->modes[i];
    return modes > 0 ? energy / modes : 0;
}

/* Logarithm of a cut-off's wave number, and the sums of squares that it leaves of g, gives the phase, and
   lets expect of the phase's error (M15). */
typedef struct trial {
    double log_k, left, phase, error;
} trial;

static trial try_cutoff(const spectrum *s, double log_k) {
    trial t = {.log_k = log_k};
    const double cutoff4 = exp(4 * log_k);
    for (size_t i = 0; i < s->entries; i++) {
        const double k4 = (double)s->k2[i] * (double)s->k2[i], energy = (double)s->energy[i], noise = s->noise * (double)s->modes[i];
        if (k4 <= 0) continue;
        const double kept = k4 / (k4 + cutoff4), lost = 1 - kept;
        t.left += lost * lost * energy;
        t.phase += kept * kept * energy / k4;
        t.error += (lost * lost * (energy - noise) + kept * kept * noise) / k4;
    }
    return t;
}

static int32_t least_error(const trial *trials) {
    int32_t best = 0;
    for (int32_t i = 1; i < TRIALS; i++)
        if (trials[i].error < trials[best].error) best = i;
    return best;
}

/* Slope of the L-curve (log |left|, log |phase|) at a trial, from its neighbours. */
static double slope(const trial *t) {
    return log(t[1].phase / t[-1].phase) / log(t[1].left / t[-1].left);
}

/* The L-curve falls steeply while clouds go, and again when structure goes: the first point between, where it is
   flattest (M16). */
static int32_t corner(const trial *trials) {
    for (int32_t i = 2; i + 2 < TRIALS; i++) {
        const double here = slope(trials + i);
        if (here > slope(trials + i - 1) && here >= slope(trials + i + 1)) return i;
    }
    return 0;
}

static double choose(const spectrum *s, const ptie_solver_params *p, ptie_cutoff_rule rule) {
    const double longest = (p->width_px > p->height_px ? p->width_px : p->height_px) * p->pixel_m;
    const double low = log(TWO_PI / (4 * longest)), high = log(TWO_PI / (4 * p->pixel_m));
    trial trials[TRIALS];
    for (int32_t i = 0; i < TRIALS; i++)
        trials[i] = try_cutoff(s, low + (high - low) * i / (TRIALS - 1));
    const int32_t best = rule == PTIE_CUTOFF_NOISE ? least_error(trials) : corner(trials);
    return best > 0 ? TWO_PI / exp(trials[best].log_k) : 0;
}

typedef struct work {
    ptie_solver *solver;
    float *image, *values;
    spectrum spectrum;
} work;

static ptie_status prepare(work *w, const ptie_solver_params *params) {
    ptie_solver_params p = *params;
    p.method = PTIE_SOLVE_DIRECT;
    p.cutoff_m = 0;
    PTIE_TRY(ptie_tie_plan(&w->solver, &p));
    const ptie_fft *fft = w->solver->fft;
    spectrum *s = &w->spectrum;
    s->entries = ptie_fft_filter_floats(fft);
    PTIE_TRY(ptie_alloc_status(&w->image, ptie_fft_image_floats(fft), sizeof(float), "solver"));
    PTIE_TRY(ptie_alloc_status(&w->values, ptie_fft_spectrum_floats(fft), sizeof(float), "solver"));
    PTIE_TRY(ptie_alloc_status(&s->energy, s->entries, sizeof(float), "solver"));
    PTIE_TRY(ptie_alloc_status(&s->modes, s->entries, sizeof(float), "solver"));
    return ptie_alloc_status(&s->k2, s->entries, sizeof(float), "solver");
}

static ptie_status analyse(work *w, const float *const *planes, double sigma) {
    const ptie_tie_weights *weights = &w->solver->weights;
    PTIE_TRY(ptie_tie_derivative(w->image, weights, planes));
    ptie_fft_forward(w->solver->fft, w->values, w->image);
    fill_spectrum(&w->spectrum, w->solver, w->values);
    const double k0 = TWO_PI / w->solver->params.wavelength_m;
    w->spectrum.noise = sigma > 0 ? k0 * k0 * sigma * sigma * ptie_tie_noise_gain(weights)
                                  : fine_energy(&w->spectrum, w->solver->params.pixel_m);
    return PTIE_OK;
}

ptie_status ptie_tie_choose_cutoff(double *cutoff_m, const ptie_solver_params *params,
                                   const float *const *planes, ptie_cutoff_rule rule, double sigma) {
    work w = {0};
    ptie_status status = prepare(&w, params);
    if (status == PTIE_OK) status = analyse(&w, planes, sigma);
    if (status == PTIE_OK) *cutoff_m = choose(&w.spectrum, params, rule);
    ptie_solver_free(w.solver);
    ptie_free(w.image);
    ptie_free(w.values);
    ptie_free(w.spectrum.energy);
    ptie_free(w.spectrum.modes);
    ptie_free(w.spectrum.k2);
    return status;
}
