/* SPDX-License-Identifier: BSD-3-Clause */
/* A real micro-lens array behind a rectangular aperture, in focus and 1 um before it: data of Zhang et al. 2020
   (tests/tie/universal.c).  Their result: 4 iterations, -43.16 .. +88.72 rad inside the aperture; the makers'
   specification of a lens: 125 rad. */
#include "tie/plan.h"

#include <ptie/recording.h>

enum { W = 1280, H = 960 };

/* NULL without the data. */
static float *read_image(const char *name) {
    const char *path = support_data(name);
    if (!path) return NULL;
    ptie_recording *recording;
    assert_ok(ptie_recording_open(&recording, path));
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    assert_true(info->width_px == W && info->height_px == H);
    float *image = image_of(W, H);
    assert_ok(ptie_recording_read(recording, 0, image));
    ptie_recording_close(recording);
    return image;
}

/* Regularised as in the published program, r = 5e-9 (docs/math.md, after M13). */
static ptie_solver_params microlens_params(void) {
    ptie_solver_params p = with_planes(solver_params(PTIE_PERIODIC, W, H), 2, (const double[]){0, -1e-6});
    p.wavelength_m = 550e-9, p.pixel_m = 4.65e-6 / 20, p.method = PTIE_SOLVE_US_TIE;
    p.cutoff_m = 2 * PI * p.pixel_m / pow(5e-9, 0.25);
    return p;
}

static void check_range(const float *phase, const float *light) {
    double low = 1e9, high = -1e9, brightest = 0;
    for (int32_t i = 0; i < W * H; i++) brightest = fmax(brightest, (double)light[i]);
    for (int32_t i = 0; i < W * H; i++)
        if ((double)light[i] >= brightest / 10) {
            low = fmin(low, (double)phase[i]);
            high = fmax(high, (double)phase[i]);
        }
    /* In NumPy -43.159 and 88.722; rounding to float shows in the fourth digit. */
    assert_near(low, -43.16, 0.02 * 43.16);
    assert_near(high, 88.72, 0.02 * 88.72);
}

/* Top of a lens less the lowest of the array around it. */
static double lens_height(const float *phase, int32_t x, int32_t y) {
    double high = -1e9, low = 1e9;
    for (int32_t j = y - 130; j < y + 130; j++)
        for (int32_t i = x - 130; i < x + 130; i++) {
            high = fmax(high, (double)phase[j * W + i]);
            low = fmin(low, (double)phase[j * W + i]);
        }
    return high - low;
}

static void lenses_have_their_height(void **state) {
    (void)state;
    static const int32_t centre[][2] = {{331, 319}, {654, 314}, {980, 307}, {335, 644}, {661, 638}, {987, 633}};
    float *light = read_image("microlens/I0.tiff"), *beyond = read_image("microlens/Iz.tiff");
    if (!light || !beyond) skip();
    const ptie_solver_params p = microlens_params();
    ptie_solver *solver;
    ptie_solver_report report;
    assert_ok(ptie_tie_plan(&solver, &p));
    void *scratch = ptie_alloc(ptie_tie_scratch(solver), 1);
    float *phase = image_of(W, H);
    assert_ok(ptie_tie_solve(solver, phase, (const float *const[]){light, beyond}, scratch, &report));
    assert_int_equal(report.iterations, 4);
    check_range(phase, light);
    for (int i = 0; i < 6; i++) /* found 120.3 .. 125.6 */
        assert_near(lens_height(phase, centre[i][0], centre[i][1]), 125, 0.05 * 125);
    free(light), free(beyond), free(phase);
    ptie_free(scratch);
    ptie_solver_free(solver);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lenses_have_their_height),
    };
    return cmocka_run_group_tests_name("microlens", tests, NULL, NULL);
}
