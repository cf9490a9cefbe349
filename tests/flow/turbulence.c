/* SPDX-License-Identifier: BSD-3-Clause */
/* Turbulence: von Karman's structure function, moments, motion. */
#include "support/support.h"

#include <math.h>

#include "flow/turbulence.h"

static const double pi = 3.14159265358979323846;

/* 4 pi * integral of f PSD(f) (1 - J0(2 pi f r)) df over low .. high, on a logarithmic grid. */
static double structure_function(double r, double outer, double inner, double low, double high) {
    const int steps = 20000;
    double step = log(high / low) / steps, sum = 0;
    for (int i = 0; i < steps; i++) {
        double f = low * exp((i + 0.5) * step);
        sum += f * f * ptie_von_karman(f, outer, inner) * (1 - j0(2 * pi * f * r)) * step;
    }
    return 4 * pi * sum;
}

/* Without scales the spectrum is Kolmogorov's: D = 6.88 (r / r0)^(5/3).  The 0.023 of the spectrum
   is rounded from 0.02290 (0.5 %); the outer scale takes 1.5 (r / L0)^(1/3) = 0.15 % away. */
static void the_spectrum_tends_to_kolmogorov(void **state) {
    (void)state;
    for (double r = 0.1; r < 3; r *= 2)
        assert_near(structure_function(r, 1e9 * r, 1e-6 * r, 1e-12 / r, 1e4 / r),
                    6.88 * pow(r, 5.0 / 3), 0.007 * 6.88 * pow(r, 5.0 / 3));
}

enum { CELLS = 256, SCREENS = 24, POINTS = 64, FIELDS = PTIE_TURBULENCE_FIELDS };

static ptie_turbulence_params screen(uint64_t key) {
    return (ptie_turbulence_params){
        .key = key, .period = 8, .outer = 1, .inner = 0.05, .cells = CELLS};
}

/* Mean of (phi(x + r) - phi(x))^2 over a grid of points, along both axes, one value per field. */
static void squared_differences(double out[FIELDS], const ptie_turbulence *t, float r) {
    for (int c = 0; c < FIELDS; c++) out[c] = 0;
    for (int y = 0; y < POINTS; y++)
        for (int x = 0; x < POINTS; x++) {
            float u = 8.0f * (float)x / POINTS, v = 8.0f * (float)y / POINTS;
            float here[FIELDS], right[FIELDS], below[FIELDS];
            ptie_turbulence_at(t, u, v, here);
            ptie_turbulence_at(t, u + r, v, right);
            ptie_turbulence_at(t, u, v + r, below);
            for (int c = 0; c < FIELDS; c++) {
                double a = (double)(right[c] - here[c]), b = (double)(below[c] - here[c]);
                out[c] += (a * a + b * b) / (2.0 * POINTS * POINTS);
            }
        }
}

/* r0 = 1.  The fields are independent, so their scatter gives the error of the mean; four of it.
   The modes beyond the tile's are missing: none below 1 / period, where 1 - J0 is small, and the
   finest, which the reference leaves out too. */
static void screens_have_von_karmans_structure_function(void **state) {
    (void)state;
    const float separations[] = {0.1f, 0.2f, 0.4f, 0.8f};
    for (int i = 0; i < 4; i++) {
        double sum = 0, squares = 0, r = (double)separations[i];
        for (uint64_t key = 1; key <= SCREENS; key++) {
            ptie_turbulence t;
            double difference[FIELDS];
            ptie_turbulence_params params = screen(key);
            assert_ok(ptie_turbulence_create(&t, &params));
            squared_differences(difference, &t, separations[i]);
            for (int c = 0; c < FIELDS; c++) {
                double d = difference[c] * (double)(t.screen_rad * t.screen_rad);
                sum += d, squares += d * d;
            }
            ptie_turbulence_free(&t);
        }
        double n = SCREENS * FIELDS, mean = sum / n;
        double error = sqrt((squares / n - mean * mean) / (n - 1));
        double high = CELLS * 3.0 / 8 / 8, exact = structure_function(r, 1, 0.05, 1e-4, high);
        /* The discrete sum over modes differs from the integral by less than 1 % of it: f0 = 8
         * steps. */
        assert_near(mean, exact, 4 * error + 0.01 * exact);
        assert_true(4 * error < 0.15 * exact);
    }
}

static void fields_have_unit_variance_and_are_independent(void **state) {
    (void)state;
    double mean[FIELDS] = {0}, product[FIELDS][FIELDS] = {{0}};
    double n = (double)SCREENS * POINTS * POINTS;
    for (uint64_t key = 1; key <= SCREENS; key++) {
        ptie_turbulence t;
        ptie_turbulence_params params = screen(key);
        assert_ok(ptie_turbulence_create(&t, &params));
        for (int i = 0; i < POINTS * POINTS; i++) {
            float field[FIELDS];
            ptie_turbulence_at(&t, 8.0f * (float)(i % POINTS) / POINTS,
                               8.0f * (float)(i / POINTS) / POINTS, field);
            for (int a = 0; a < FIELDS; a++) {
                mean[a] += (double)field[a] / n;
                for (int b = 0; b < FIELDS; b++) product[a][b] += (double)(field[a] * field[b]) / n;
            }
        }
        ptie_turbulence_free(&t);
    }
    /* Correlated over about L0 / 2: some 8^2 * 4 = 256 independent patches per screen; five errors.
     */
    double patches = SCREENS * 256.0;
    for (int a = 0; a < FIELDS; a++) {
        /* Mode 0 is missing; modes that are multiples of the 64 points look like it.  Theirs is
           1e-5 of the variance: an error of sqrt(1e-5 / screens) = 6e-4. */
        assert_near(mean[a], 0, 5 * 6e-4);
        for (int b = 0; b < FIELDS; b++)
            assert_near(product[a][b], a == b ? 1 : 0, 5 * sqrt((a == b ? 2 : 1) / patches));
    }
}

static double correlation(const ptie_turbulence *a, const ptie_turbulence *b) {
    double ab = 0, aa = 0, bb = 0;
    for (int i = 0; i < POINTS * POINTS; i++) {
        float x = 8.0f * (float)(i % POINTS) / POINTS, y = 8.0f * (float)(i / POINTS) / POINTS;
        float p[FIELDS], q[FIELDS];
        ptie_turbulence_at(a, x, y, p);
        ptie_turbulence_at(b, x, y, q);
        for (int c = 0; c < FIELDS; c++)
            ab += (double)(p[c] * q[c]), aa += (double)(p[c] * p[c]), bb += (double)(q[c] * q[c]);
    }
    return ab / sqrt(aa * bb);
}

static void turbulence_drifts_and_turns(void **state) {
    (void)state;
    ptie_turbulence start, later;
    ptie_turbulence_params params = screen(5);
    assert_ok(ptie_turbulence_create(&start, &params));
    params.drift = 8 * 1000 + 0.75; /* a thousand times around, and a bit */
    assert_ok(ptie_turbulence_create(&later, &params));
    for (float x = -3; x < 12; x += 0.37f) {
        float a[FIELDS], b[FIELDS];
        ptie_turbulence_at(&start, x, 1.3f, a);
        ptie_turbulence_at(&later, x + 0.75f, 1.3f, b);
        /* Positions round to 12 cells-per-unit * 32 * 2^-24 cells; fields vary by about 1 per cell.
         */
        for (int c = 0; c < FIELDS; c++) assert_near((double)a[c], (double)b[c], 1e-4);
    }
    ptie_turbulence_free(&later);
    double last = 1;
    params.drift = 0;
    for (params.turns = 0.02; params.turns < 0.4; params.turns *= 3) {
        assert_ok(ptie_turbulence_create(&later, &params));
        double now = correlation(&start, &later);
        assert_true(now < last && now > 0);
        last = now;
        ptie_turbulence_free(&later);
    }
    ptie_turbulence_free(&start);
}

/* The coarse eddies stay when the tile gets finer: what differs is the modes between the two
 * cut-offs. */
static void finer_tiles_keep_the_coarse_eddies(void **state) {
    (void)state;
    ptie_turbulence coarse, fine;
    ptie_turbulence_params params = screen(9);
    params.cells = 64;
    assert_ok(ptie_turbulence_create(&coarse, &params));
    params.cells = 256;
    assert_ok(ptie_turbulence_create(&fine, &params));
    /* Correlation of a signal with itself plus independent modes: the root of the ratio of
       variances. The sample's own share of fine modes scatters by a few per mille. */
    double ratio = (double)(coarse.screen_rad / fine.screen_rad);
    assert_true(ratio < 1);
    assert_near(correlation(&coarse, &fine), ratio, 0.01);
    ptie_turbulence_free(&coarse);
    ptie_turbulence_free(&fine);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_spectrum_tends_to_kolmogorov),
        cmocka_unit_test(screens_have_von_karmans_structure_function),
        cmocka_unit_test(fields_have_unit_variance_and_are_independent),
        cmocka_unit_test(turbulence_drifts_and_turns),
        cmocka_unit_test(finer_tiles_keep_the_coarse_eddies),
    };
    return cmocka_run_group_tests_name("flow/turbulence", tests, NULL, NULL);
}
