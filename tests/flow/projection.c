/* SPDX-License-Identifier: BSD-3-Clause */
/* Line integrals with closed forms, and the Gaussian blur. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include "flow/abel.h"
#include "flow/blur.h"

static double gaussian(double r, const void *context) {
    double s = *(const double *)context;
    return exp(-r * r / (s * s));
}

static double disc(double r, const void *context) {
    (void)r, (void)context;
    return 1;
}

static double parabola(double r, const void *context) {
    double radius = *(const double *)context;
    return 1 - r * r / (radius * radius);
}

static void projections_have_their_closed_forms(void **state) {
    (void)state;
    const double s = 0.7, radius = 1.3;
    for (double y = 0; y < 1.3; y += 0.13) {
        /* Polynomials: exact but for rounding. */
        double chord = sqrt(radius * radius - y * y);
        assert_near(ptie_abel(disc, NULL, y, radius), 2 * chord, 1e-14);
        assert_near(ptie_abel(parabola, &radius, y, radius),
                    4.0 / 3 * pow(chord, 3) / (radius * radius), 1e-14);
        /* Cut off at 6 s: exp(-36) = 2e-16 is missing. */
        assert_near(ptie_abel(gaussian, &s, y, 6 * s), s * sqrt(acos(-1.0)) * exp(-y * y / (s * s)),
                    1e-12);
    }
    assert_near(ptie_abel(disc, NULL, 1.31, radius), 0, 0);
    /* The promise of the header: a field that varies over a tenth of its reach. */
    const double fine = 0.1;
    assert_near(ptie_abel(gaussian, &fine, 0.03, 1), fine * sqrt(acos(-1.0)) * exp(-0.09), 1e-9);
}

static void a_table_keeps_the_projection(void **state) {
    (void)state;
    const double s = 0.25;
    ptie_projection *table = malloc(sizeof *table);
    ptie_projection_fill(table, gaussian, &s, 1.5);
    /* Linear interpolation errs by h^2 / 8 times the largest curvature, 2 sqrt(pi) / s; floats
     * round. */
    double step = 1.5 / PTIE_PROJECTION_STEPS, curvature = 2 * sqrt(acos(-1.0)) / s;
    for (double y = 0; y < 1.5; y += 0.00317) {
        double exact = s * sqrt(acos(-1.0)) * exp(-y * y / (s * s));
        assert_near((double)ptie_projection_at(table, (float)-y), exact,
                    step * step / 8 * curvature + 2e-7);
    }
    assert_near((double)ptie_projection_at(table, 1.5f), 0, 0);
    /* A soft disc projects to as much as it holds: the integral of F is that of 2 pi r f, which for
       this edge is pi (1 + pi^2 edge^2 / 12) [Sommerfeld], up to exp(-2 / edge). */
    const double edge = 0.1, pi = acos(-1.0);
    ptie_projection_fill_disc(table, edge);
    double sum = 0, reach = (double)table->reach, h = reach / PTIE_PROJECTION_STEPS;
    for (int i = 0; i < PTIE_PROJECTION_STEPS; i++)
        sum += 2 * h * (i == 0 ? 0.5 : 1) * (double)table->value[i];
    assert_near(sum, pi * (1 + pi * pi * edge * edge / 12),
                1e-5); /* 6e-6 left outside, see the reach */
    free(table);
}

static void the_blur_is_a_gaussian_that_keeps_the_sum(void **state) {
    (void)state;
    enum { W = 61, H = 47 };
    float *map = calloc(W * H, sizeof *map);
    map[23 * W + 30] = 1;
    assert_ok(ptie_blur(map, W, H, 2.5));
    double sum = 0, xx = 0, yy = 0, xy = 0;
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            double v = (double)map[y * W + x];
            sum += v, xx += v * (x - 30) * (x - 30), yy += v * (y - 23) * (y - 23),
                xy += v * (x - 30) * (y - 23);
        }
    /* 2.5^2 = 6.25, less what is cut off at 3.5 sigma: 2 t phi(t) = 0.6 %. */
    assert_near(sum, 1, 1e-6);
    assert_near(xx, 6.25, 0.006 * 6.25);
    assert_near(yy, xx, 1e-5);
    assert_near(xy, 0, 1e-5);
    /* Mirrored edges lose nothing, even for kernels longer than the image. */
    for (int i = 0; i < W * H; i++) map[i] = (float)(i % 7);
    double before = 0, after = 0;
    for (int i = 0; i < W * H; i++) before += (double)map[i];
    assert_ok(ptie_blur(map, W, H, 30));
    for (int i = 0; i < W * H; i++) after += (double)map[i];
    assert_near(after, before, 2e-6 * before);
    free(map);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(projections_have_their_closed_forms),
        cmocka_unit_test(a_table_keeps_the_projection),
        cmocka_unit_test(the_blur_is_a_gaussian_that_keeps_the_sum),
    };
    return cmocka_run_group_tests_name("flow/projection", tests, NULL, NULL);
}
