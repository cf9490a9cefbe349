/* SPDX-License-Identifier: BSD-3-Clause */
/* Estimate against truth: by hand, and by NumPy and SciPy (tests/golden/make_metrics.py). */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include <ptie/metrics.h>

/* The golden images: ratios of integers. */
static void set_images(float *estimate, float *truth, int32_t w, int32_t h) {
    for (int64_t y = 0; y < h; y++)
        for (int64_t x = 0; x < w; x++) {
            const int64_t t = (x * x + 3 * y * y + x * y) % 997;
            const int64_t e = (7 * t + (x * 7919 + y * 104729) % 400) % 7979;
            truth[y * w + x] = (float)t / 997;
            estimate[y * w + x] = (float)e / 7979;
        }
}

/* The golden regions: left half, last quarter of the columns. */
static void set_regions(uint8_t *labels, int32_t w, int32_t h) {
    assert_ok(ptie_regions_from_rects(labels, w, h, (ptie_rect){0, 0, w / 2, h},
                                      (ptie_rect){w - w / 4, 0, w / 4, h}));
}

static void check_row(const double v[12]) {
    const int32_t w = (int32_t)v[0], h = (int32_t)v[1];
    float *estimate = calloc((size_t)(w * h), sizeof(float)),
          *truth = calloc((size_t)(w * h), sizeof(float));
    uint8_t *labels = calloc((size_t)(w * h), 1);
    set_images(estimate, truth, w, h);
    set_regions(labels, w, h);
    ptie_comparison c;
    ptie_flow_metrics m;
    assert_ok(ptie_compare(&c, estimate, truth, w, h, v[2]));
    assert_ok(ptie_flow_measure(&m, estimate, labels, w, h));
    /* Sums of up to 3072 doubles near 1, in another order; measured 4e-15. */
    const double found[] = {c.psnr_db, c.mae, c.rmse, c.ssim, c.correlation,
                            m.mgm,     m.sbr, m.bns,  m.cnr};
    for (int i = 0; i < 9; i++) assert_near(found[i], v[3 + i], 1e-13 * fmax(1, fabs(v[3 + i])));
    free(estimate), free(truth), free(labels);
}

static void metrics_agree_with_numpy_and_scipy(void **state) {
    (void)state;
    FILE *file = fopen(support_source("tests/golden/metrics.txt"), "r");
    assert_non_null(file);
    char line[512];
    int rows = 0;
    while (fgets(line, sizeof line, file)) {
        if (line[0] == '#') continue;
        double v[12];
        char *next = line;
        for (int i = 0; i < 12; i++) v[i] = strtod(next, &next);
        check_row(v);
        rows++;
    }
    fclose(file);
    assert_int_equal(rows, 8);
}

static void differences_by_hand(void **state) {
    (void)state;
    const float estimate[] = {0, 0.5f, 1, 0.5f}, truth[] = {0, 0.5f, 0.5f, 1};
    ptie_comparison c;
    assert_ok(ptie_compare(&c, estimate, truth, 2, 2, 1));
    assert_near(c.mae, 0.25, 1e-15);
    assert_near(c.rmse, sqrt(0.125), 1e-15);
    assert_near(c.psnr_db, 10 * log10(8), 1e-13);
    assert_near(c.signal_kept, 0.5, 1e-15);
    assert_near(c.correlation, 0.5, 1e-15); /* covariance 1/4, variances 1/2 */
    assert_true(isnan(c.ssim));             /* no window fits */
}

static void equal_images_are_perfect(void **state) {
    (void)state;
    float a[20 * 15], b[20 * 15];
    set_images(a, b, 20, 15);
    ptie_comparison c;
    assert_ok(ptie_compare(&c, a, a, 20, 15, 1));
    assert_true(isinf(c.psnr_db) && c.psnr_db > 0);
    assert_true(c.mae == 0 && c.rmse == 0);
    assert_near(c.ssim, 1, 1e-12);
    assert_near(c.correlation, 1, 1e-12);
    assert_near(c.signal_kept, 1, 1e-12);
    for (int i = 0; i < 20 * 15; i++) b[i] = 3 - 2 * a[i];
    assert_ok(ptie_compare(&c, a, b, 20, 15, 1));
    assert_near(c.correlation, -1, 1e-6); /* b is rounded to float */
    assert_near(c.signal_kept, -0.5, 1e-6);
}

/* Half of a flow of two equal waves erased, an offset, and noise that is orthogonal to both. */
static void what_is_erased_is_missing_from_the_signal(void **state) {
    (void)state;
    enum { N = 64 };
    float estimate[N], truth[N];
    for (int i = 0; i < N; i++) {
        const double turn = 6.283185307179586 * i / N;
        truth[i] = (float)(sin(3 * turn) + cos(5 * turn));
        estimate[i] = (float)(sin(3 * turn) + 7 + 2 * cos(11 * turn));
    }
    ptie_comparison c;
    assert_ok(ptie_compare(&c, estimate, truth, N / 4, 4, 1));
    assert_near(c.signal_kept, 0.5, 2e-7); /* values up to 10 are rounded to 2^-21 of 1 at worst */
}

/* Waves of equal size: the inverse itself, twice it, an empty map, and the truth under noise. */
static void residuals_by_hand(void **state) {
    (void)state;
    enum { N = 64 };
    float measured[N], wave[N], twice[N], empty[N] = {0};
    double found;
    for (int i = 0; i < N; i++) {
        const double turn = 6.283185307179586 * i / N;
        wave[i] = (float)(sin(3 * turn));
        measured[i] = (float)(sin(3 * turn) + cos(5 * turn) + 0.5); /* the mean says nothing */
        twice[i] = 2 * measured[i];
    }
    assert_ok(ptie_residual(&found, measured, measured, N / 4, 4));
    assert_near(found, 0, 1e-15);
    assert_ok(ptie_residual(&found, twice, measured, N / 4, 4));
    assert_near(found, 1, 1e-12);
    assert_ok(ptie_residual(&found, empty, measured, N / 4, 4));
    assert_near(found, 1, 1e-12);
    assert_ok(ptie_residual(&found, wave, measured, N / 4, 4));
    assert_near(found, sqrt(0.5), 1e-7); /* values are rounded to f32 */
    assert_ok(ptie_residual(&found, wave, empty, N / 4, 4));
    assert_true(isnan(found));
    assert_fails(ptie_residual(&found, wave, NULL, 1, 1), PTIE_EINVAL, "measured is missing");
}

/* Two constants: SSIM is its luminance term (2 a b + c1) / (a^2 + b^2 + c1). */
static void ssim_of_constants_is_luminance(void **state) {
    (void)state;
    float a[12 * 12], b[12 * 12];
    for (int i = 0; i < 144; i++) a[i] = 0.25f, b[i] = 0.75f;
    ptie_comparison c;
    assert_ok(ptie_compare(&c, a, b, 12, 12, 1));
    assert_near(c.ssim, (0.375 + 1e-4) / (0.625 + 1e-4), 1e-12);
    assert_true(isnan(c.correlation));
}

static void the_range_scales_psnr_and_ssim(void **state) {
    (void)state;
    float a[24 * 24], b[24 * 24];
    set_images(a, b, 24, 24);
    ptie_comparison unit, four;
    assert_ok(ptie_compare(&unit, a, b, 24, 24, 1));
    for (int i = 0; i < 576; i++) a[i] *= 4, b[i] *= 4;
    assert_ok(ptie_compare(&four, a, b, 24, 24, 4));
    assert_near(four.psnr_db, unit.psnr_db, 1e-12);
    assert_near(four.ssim, unit.ssim, 1e-12);
    assert_near(four.correlation, unit.correlation, 1e-12);
    assert_near(four.rmse, 4 * unit.rmse, 1e-12);
}

static void values_that_are_not_finite_are_named(void **state) {
    (void)state;
    float a[12] = {0}, b[12] = {0};
    ptie_comparison c = {.mae = 5};
    a[7] = NAN;
    assert_fails(ptie_compare(&c, a, b, 4, 3, 1), PTIE_ENUMERIC,
                 "estimate: value is not finite (at x=3, y=1");
    assert_fails(ptie_compare(&c, b, a, 4, 3, 1), PTIE_ENUMERIC, "truth: value is not finite");
    assert_true(c.mae == 5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(metrics_agree_with_numpy_and_scipy),
        cmocka_unit_test(differences_by_hand),
        cmocka_unit_test(equal_images_are_perfect),
        cmocka_unit_test(what_is_erased_is_missing_from_the_signal),
        cmocka_unit_test(residuals_by_hand),
        cmocka_unit_test(ssim_of_constants_is_luminance),
        cmocka_unit_test(the_range_scales_psnr_and_ssim),
        cmocka_unit_test(values_that_are_not_finite_are_named),
    };
    return cmocka_run_group_tests_name("compare", tests, NULL, NULL);
}
