/* SPDX-License-Identifier: BSD-3-Clause */
/* The simulations of Zhang, Chen, Sun, Tian and Zuo, "On a universal solution to the transport-of-intensity
   equation", Opt. Lett. 45, 3649 (2020), by their published parameters: 256 x 256 pixels of 2 um, 633 nm,
   one plane in focus and one at 1 um, light inside hard apertures.  Expected errors: an independent NumPy
   computation in double precision, which agrees with the paper (30 iterations, 0.0035; 24, 0.0103). */
#include "tie/plan.h"

enum { N = 256, PIXELS = N * N };

static const double pixel_m = 2e-6, corner_m = 512e-6 * 1.4142135623730951; /* of a field twice as wide */

/* "telescope-": tilted ellipse less its top and a central obstruction; uniform. */
static double telescope(double x, double y) {
    const double r = hypot(x, y);
    return x * x + y * y + 0.5 * x * y < 0.8 * corner_m * 8e-5 && y <= 0.2 * corner_m && r >= 0.1 * corner_m;
}

static double gaussian_in_circle(double x, double y) {
    const double sigma = 1.1e-4;
    return hypot(x, y) < 0.325 * corner_m ? exp(-(x * x + y * y) / (2 * sigma * sigma)) : 0;
}

/* Dark in the middle: I0 = 0 at one pixel. */
static double inverse_gaussian_in_ellipse(double x, double y) {
    const double sigma = 0.8e-4;
    const bool inside = x * x + y * y - 0.3 * x * y < 510e-6 * 8e-5;
    return inside ? 1 - exp(-(x * x + y * y) / (2 * sigma * sigma)) : 0;
}

/* Squared Hann window of 128 x 128 pixels with its corner at (x, y). */
static double bump(int32_t i, int32_t j, int32_t x, int32_t y) {
    if (i < x || i >= x + 128 || j < y || j >= y + 128) return 0;
    const double a = 0.5 - 0.5 * cos(2 * PI * (i - x) / 127), b = 0.5 - 0.5 * cos(2 * PI * (j - y) / 127);
    return a * a * b * b;
}

typedef struct simulation {
    double (*intensity)(double x, double y);
    bool bumps;
    float light[PIXELS], beyond[PIXELS], truth[PIXELS];
} simulation;

static void propagate(simulation *s) {
    ptie_optics_params p;
    ptie_optics_params_init(&p);
    p.width_px = p.height_px = N, p.pixel_m = pixel_m, p.wavelength_m = 0.633e-6, p.defocus_m = 1e-6;
    p.propagation = PTIE_ANGULAR_SPECTRUM;
    ptie_optics *optics;
    assert_ok(ptie_optics_plan(&optics, &p));
    void *scratch = ptie_alloc(ptie_optics_scratch(optics), 1);
    float *below = image_of(N, N);
    assert_ok(ptie_optics_defocus(optics, s->beyond, below, s->truth, s->light, scratch));
    free(below);
    ptie_free(scratch);
    ptie_optics_free(optics);
}

static simulation *simulate(double (*intensity)(double x, double y), bool bumps) {
    simulation *s = calloc(1, sizeof *s);
    assert_non_null(s);
    s->intensity = intensity;
    for (int32_t j = 0; j < N; j++)
        for (int32_t i = 0; i < N; i++) {
            const double x = (i - N / 2) * pixel_m, y = (j - N / 2) * pixel_m;
            double phase = 0.82 - 0.7e3 * x + 10e6 * x * x - 10e6 * y * y + 2e3 * y;
            if (bumps) phase += bump(i, j, 64, 64) + bump(i, j, 44, 14) + bump(i, j, 34, 124);
            s->light[j * N + i] = (float)intensity(x, y);
            s->truth[j * N + i] = (float)phase;
        }
    propagate(s);
    return s;
}

/* Error inside the aperture, without the constant that is not measured. */
static double rmse(const simulation *s, const float *phase) {
    double sum = 0, squares = 0;
    int32_t count = 0;
    for (int32_t i = 0; i < PIXELS; i++)
        if (s->light[i] > 0) {
            const double error = (double)phase[i] - (double)s->truth[i];
            sum += error, squares += error * error, count++;
        }
    return sqrt(squares / count - sum / count * (sum / count));
}

static double error_of(const simulation *s, ptie_solver_method method, ptie_boundary boundary,
                       int32_t iterations, double floor, ptie_solver_report *report) {
    ptie_solver_params p = with_planes(solver_params(boundary, N, N), 2, (const double[]){0, 1e-6});
    p.pixel_m = pixel_m, p.wavelength_m = 0.633e-6, p.method = method, p.max_iterations = iterations;
    p.intensity_floor = floor;
    ptie_solver *solver;
    assert_ok(ptie_tie_plan(&solver, &p));
    void *scratch = ptie_alloc(ptie_tie_scratch(solver), 1);
    float *phase = image_of(N, N);
    assert_ok(ptie_tie_solve(solver, phase, (const float *const[]){s->light, s->beyond}, scratch, report));
    const double error = rmse(s, phase);
    free(phase);
    ptie_free(scratch);
    ptie_solver_free(solver);
    return error;
}

static void check_universal(const simulation *s, int32_t iterations, double expected) {
    const double found = error_of(s, PTIE_SOLVE_US_TIE, PTIE_PERIODIC, iterations, 0, NULL);
    assert_near(found / expected, 1, 0.02);
}

static void uniform_light_in_a_telescope(void **state) {
    (void)state;
    static const double expected[] = {.25530, .20282, .16680, .13873, .11622};
    simulation *s = simulate(telescope, false);
    for (int32_t n = 0; n < 5; n++) check_universal(s, n + 1, expected[n]);
    ptie_solver_report report;
    const double found = error_of(s, PTIE_SOLVE_US_TIE, PTIE_PERIODIC, 100, 0, &report);
    assert_near(found / 0.003479, 1, 0.02);
    assert_int_equal(report.iterations, 30);
    assert_true(report.residual <= 1e-3);
    free(s);
}

static void gaussian_light_in_a_circle(void **state) {
    (void)state;
    simulation *s = simulate(gaussian_in_circle, false);
    check_universal(s, 10, .1198);
    check_universal(s, 20, .0766);
    check_universal(s, 30, .0532);
    check_universal(s, 60, .01948);
    check_universal(s, 100, .00537);
    free(s);
}

static void light_with_a_zero_in_an_ellipse(void **state) {
    (void)state;
    simulation *s = simulate(inverse_gaussian_in_ellipse, true);
    ptie_solver_report report;
    const double found = error_of(s, PTIE_SOLVE_US_TIE, PTIE_PERIODIC, 100, 0, &report);
    assert_near(found / 0.010280, 1, 0.02);
    assert_int_equal(report.iterations, 24);
    free(s);
}

static double iterated_dct(const simulation *s, int32_t *iterations) {
    ptie_solver_report report;
    const double error = error_of(s, PTIE_SOLVE_ITERATIVE_DCT, PTIE_MIRROR, 100, 0, &report);
    *iterations = report.iterations;
    return error;
}

/* Raising dark pixels to 1 % of the brightest (FFT-TIE) ruins it; giving them the mean (iterative DCT) does not.
   Iterated on diffraction with the light as it is, the error falls further: 0.0031 and 0.0063 in NumPy. */
static void two_poisson_equations_for_comparison(void **state) {
    (void)state;
    int32_t iterations;
    simulation *s = simulate(telescope, false);
    assert_near(error_of(s, PTIE_SOLVE_TWO_POISSON, PTIE_PERIODIC, 1, 0.01, NULL) / 5.8897, 1, 0.02);
    assert_near(error_of(s, PTIE_SOLVE_TWO_POISSON, PTIE_MIRROR, 1, 0, NULL) / 0.0514, 1, 0.02);
    assert_near(iterated_dct(s, &iterations) / 0.00315, 1, 0.02);
    assert_int_equal(iterations, 4);
    free(s);
    s = simulate(gaussian_in_circle, false);
    assert_near(error_of(s, PTIE_SOLVE_TWO_POISSON, PTIE_PERIODIC, 1, 0.01, NULL) / 1.5085, 1, 0.02);
    assert_near(error_of(s, PTIE_SOLVE_TWO_POISSON, PTIE_MIRROR, 1, 0, NULL) / 0.0552, 1, 0.02);
    assert_near(iterated_dct(s, &iterations) / 0.00625, 1, 0.02);
    assert_int_equal(iterations, 3);
    free(s);
}

/* The iterative DCT is no universal solution: it gets worse from step to step, and stops. */
static void a_zero_in_the_light_defeats_two_poisson_equations(void **state) {
    (void)state;
    int32_t iterations;
    simulation *s = simulate(inverse_gaussian_in_ellipse, true);
    const double first = error_of(s, PTIE_SOLVE_TWO_POISSON, PTIE_MIRROR, 1, 0, NULL);
    assert_near(first / 0.11943, 1, 0.02);
    assert_true(iterated_dct(s, &iterations) > 2 * first);
    free(s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uniform_light_in_a_telescope),
        cmocka_unit_test(gaussian_light_in_a_circle),
        cmocka_unit_test(light_with_a_zero_in_an_ellipse),
        cmocka_unit_test(two_poisson_equations_for_comparison),
        cmocka_unit_test(a_zero_in_the_light_defeats_two_poisson_equations),
    };
    return cmocka_run_group_tests_name("universal", tests, NULL, NULL);
}
