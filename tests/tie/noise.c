/* SPDX-License-Identifier: BSD-3-Clause */
/* White camera noise becomes a cloud of k^-4: closed form, plan's sum and statistics agree. */
#include "tie/plan.h"

#include "fft/fft.h"

#define SIGMA 0.01

/* Lattice sums of 1 / (m^2 + n^2)^2 (docs/math.md M8): 4 zeta(2) beta(2) over all (m, n) but 0, and
   zeta(2) beta(2) + zeta(4) over m, n >= 0 but 0. */
#define ZETA2_BETA2 (1.6449340668482264 * 0.9159655941772190)
#define ZETA4 1.0823232337111382

static double closed_form(const ptie_solver_params *p) {
    const double scale = 2 * PI / p->wavelength_m * SIGMA * p->width_px * p->pixel_m * p->pixel_m /
                         p->z_m[0];
    if (p->boundary == PTIE_MIRROR) return scale * sqrt(ZETA2_BETA2 + ZETA4) / (PI * PI * sqrt(2));
    return scale * sqrt(4 * ZETA2_BETA2) / (4 * PI * PI * sqrt(2));
}

static void the_plan_meets_the_closed_form(void **state) {
    (void)state;
    assert_near(sqrt(4 * ZETA2_BETA2) / (4 * PI * PI * sqrt(2)), 0.04397, 5e-6);
    assert_near(sqrt(ZETA2_BETA2 + ZETA4) / (PI * PI * sqrt(2)), 0.11528, 5e-6);
    for (int boundary = 0; boundary < 2; boundary++)
        for (int32_t n = 32; n <= 512; n *= 2) {
            const ptie_solver_params p = solver_params((ptie_boundary)boundary, n, n);
            ptie_solver *solver;
            assert_ok(ptie_tie_plan(&solver, &p));
            const double found = ptie_tie_noise_rad(solver, SIGMA);
            /* What lies beyond the grid is integral 2 pi k dk / k^4 = pi / (n / 2)^2 of 6.03
               (periodic), a quarter circle, pi / 4 / n^2 of 2.59 (mirror), at most; half of that on
               the root. */
            assert_near(found / closed_form(&p), 1, boundary ? 0.16 / (n * n) : 1.05 / (n * n));
            ptie_solver_free(solver);
        }
}

/* Mean square over trials of the phase that noise alone makes.  Its relative standard error: the
   power sits in few modes, sum w^2 / (sum w)^2 = 0.118 (periodic) or 0.31 (mirror) per trial and
   degree of freedom, times 2. */
static double trial_variance(const ptie_solver_params *p, int trials) {
    const int32_t pixels = p->width_px * p->height_px;
    float *image[PTIE_MAX_PLANES];
    for (int32_t i = 0; i < p->plane_count; i++) image[i] = image_of(p->width_px, p->height_px);
    ptie_solver *solver;
    assert_ok(ptie_tie_plan(&solver, p));
    void *scratch = ptie_alloc(ptie_tie_scratch(solver), 1);
    double squares = 0;
    for (int trial = 0; trial < trials; trial++) {
        for (int32_t plane = 0; plane < p->plane_count; plane++) {
            for (int32_t i = 0; i < pixels; i++) image[plane][i] = 1;
            ptie_add_gaussian_noise(image[plane], (size_t)pixels, SIGMA, 5,
                                    PTIE_STREAM_NOISE_PLUS + (uint32_t)plane, (uint64_t)trial);
        }
        assert_ok(ptie_tie_solve(solver, image[0], (const float *const *)image, scratch, NULL));
        for (int32_t i = 0; i < pixels; i++) squares += (double)image[0][i] * (double)image[0][i];
    }
    for (int32_t i = 0; i < p->plane_count; i++) free(image[i]);
    ptie_free(scratch);
    ptie_solver_free(solver);
    return squares / trials / pixels;
}

static const struct {
    int32_t count;
    double z_m[PTIE_MAX_PLANES];
} sets[] = {{2, {10e-3, -10e-3}},
            {3, {10e-3, 0, -4e-3}},
            {2, {10e-3, 0}},
            {5, {0, 10e-3, 20e-3, -10e-3, -20e-3}},
            {4, {1e-3, 5e-3, -2e-3, 9e-3}}};
enum { SETS = sizeof sets / sizeof *sets };

static void statistics_meet_the_plan_for_every_input(void **state) {
    (void)state;
    enum { TRIALS = 1000 };
    for (int boundary = 0; boundary < 2; boundary++)
        for (int set = 0; set < SETS; set++) {
            const ptie_solver_params p =
                with_planes(solver_params((ptie_boundary)boundary, 48, 48), sets[set].count, sets[set].z_m);
            ptie_solver *solver;
            assert_ok(ptie_tie_plan(&solver, &p));
            const double expected = ptie_tie_noise_rad(solver, SIGMA);
            ptie_solver_free(solver);
            const double variance = trial_variance(&p, TRIALS);
            const double error = sqrt(2 * (boundary ? 0.31 : 0.118) / TRIALS);
            assert_near(variance / (expected * expected), 1, 4 * error);
        }
}

static void noise_falls_with_the_fourth_power(void **state) {
    (void)state;
    enum { N = 64, TRIALS = 60 };
    const ptie_solver_params p = solver_params(PTIE_PERIODIC, N, N);
    const double amplitude =
        2 * PI / p.wavelength_m * SIGMA * p.pixel_m / (sqrt(2) * p.z_m[0]);
    double ring[N / 2] = {0};
    int count[N / 2] = {0};
    ptie_fft *fft;
    assert_ok(ptie_fft_create(&fft, PTIE_FFT_REAL, N, N));
    float *phase = ptie_alloc(N * N, sizeof *phase), *minus = ptie_alloc(N * N, sizeof *minus);
    float *spectrum = ptie_alloc(ptie_fft_spectrum_floats(fft), sizeof *spectrum);
    for (int trial = 0; trial < TRIALS; trial++) {
        for (int i = 0; i < N * N; i++) phase[i] = minus[i] = 1;
        ptie_add_gaussian_noise(phase, N * N, SIGMA, 6, PTIE_STREAM_NOISE_PLUS, (uint64_t)trial);
        ptie_add_gaussian_noise(minus, N * N, SIGMA, 6, PTIE_STREAM_NOISE_MINUS, (uint64_t)trial);
        assert_ok(solve(&p, phase, phase, NULL, minus));
        ptie_fft_forward(fft, spectrum, phase);
        for (int32_t y = 0; y < N; y++)
            for (int32_t x = 1; x < N / 2; x++) {
                const double kx = ptie_fft_wavenumber(fft, 0, x, p.pixel_m);
                const double ky = ptie_fft_wavenumber(fft, 1, y, p.pixel_m);
                const double k = hypot(kx, ky);
                const int radius = (int)(k / (2 * PI) * N * p.pixel_m);
                if (radius >= N / 2) continue;
                const float *c = spectrum + 2 * (y * ptie_fft_columns(fft) + x);
                /* PSD = |F|^2 p^2 / N^2 = amplitude^2 / k^4. */
                const double power = (double)c[0] * (double)c[0] + (double)c[1] * (double)c[1];
                ring[radius] += power * p.pixel_m * p.pixel_m / (N * N) * pow(k, 4);
                count[radius]++;
            }
    }
    /* Exponentially distributed powers: error 1 / sqrt(count); 4.5 of it for 31 rings. */
    for (int r = 1; r < N / 2; r++)
        assert_near(ring[r] / count[r] / (amplitude * amplitude), 1, 4.5 / sqrt(count[r]));
    ptie_free(phase), ptie_free(minus), ptie_free(spectrum);
    ptie_fft_free(fft);
}

static void regularisation_lowers_the_noise(void **state) {
    (void)state;
    ptie_solver_params p = solver_params(PTIE_MIRROR, 48, 48);
    p.cutoff_m = 12 * p.pixel_m;
    ptie_solver *solver;
    assert_ok(ptie_tie_plan(&solver, &p));
    const double expected = ptie_tie_noise_rad(solver, SIGMA);
    ptie_solver_free(solver);
    assert_true(expected < 0.2 * closed_form(&p));
    /* Some 40 modes of similar weight share the power: four of sqrt(2 / 40 / 500). */
    assert_near(trial_variance(&p, 500) / (expected * expected), 1, 0.04);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_plan_meets_the_closed_form),
        cmocka_unit_test(statistics_meet_the_plan_for_every_input),
        cmocka_unit_test(noise_falls_with_the_fourth_power),
        cmocka_unit_test(regularisation_lowers_the_noise),
    };
    return cmocka_run_group_tests_name("noise", tests, NULL, NULL);
}
