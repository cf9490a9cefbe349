/* SPDX-License-Identifier: BSD-3-Clause */
/* The branch-free elementary functions against double precision, at the errors their header states. */
#include "support/support.h"

#include "base/clones.h"
#include "base/elementary.h"
#include "base/random.h"

/* Distance in units of the last place of the rounded truth. */
static double ulps(float found, double truth) {
    const float size = fabsf((float)truth);
    return fabs((double)found - truth) / ((double)nextafterf(size, INFINITY) - (double)size);
}

static void exponentials_are_within_1_2_ulp(void **state) {
    (void)state;
    double worst = 0;
    for (float x = -86.9f; x < 86.9f; x += 1e-4f) worst = fmax(worst, ulps(ptie_expf(x), exp((double)x)));
    assert_near(worst, 0, 1.2); /* measured 1.00 */
    assert_true(ptie_expf(0) == 1);
    assert_true(ptie_expf(-1e30f) == ptie_expf(-87) && ptie_expf(1e30f) == ptie_expf(87));
}

static void logarithms_are_within_1_2_ulp(void **state) {
    (void)state;
    double worst = 0;
    for (int32_t bits = 0x00800000; bits < 0x7f7fffff - 997; bits += 997) {
        const float x = ptie_float_of(bits);
        worst = fmax(worst, ulps(ptie_logf(x), log((double)x)));
    }
    for (int32_t bits = 0x3f7f0000; bits < 0x3f808000; bits++) /* it vanishes at 1 */
        if (bits != 0x3f800000) {
            const float x = ptie_float_of(bits);
            worst = fmax(worst, ulps(ptie_logf(x), log((double)x)));
        }
    assert_near(worst, 0, 1.2); /* measured 0.95 */
    assert_true(ptie_logf(1) == 0);
}

static void sines_and_cosines_are_within_1_2e_7(void **state) {
    (void)state;
    double worst = 0;
    for (int i = -1000000; i <= 1000000; i++) {
        const float x = (float)i * 0.01f;
        worst = fmax(worst, fabs((double)ptie_sinf(x) - sin((double)x)));
        worst = fmax(worst, fabs((double)ptie_cosf(x) - cos((double)x)));
    }
    assert_near(worst, 0, 1.2e-7); /* measured 8.6e-8 */
    worst = 0;
    for (int i = -(1 << 20); i < 1 << 20; i++) {
        const float turns = (float)i * 0x1p-18f;
        const double angle = 6.283185307179586 * (double)turns;
        float sine, cosine;
        ptie_turnf(turns, &sine, &cosine);
        worst = fmax(worst, fmax(fabs((double)sine - sin(angle)), fabs((double)cosine - cos(angle))));
    }
    assert_near(worst, 0, 1.2e-7); /* measured 9.8e-8 */
}

static void angles_are_within_4e_7(void **state) {
    (void)state;
    double worst = 0;
    for (int i = 0; i < 200000; i++) {
        const double angle = 3.14159 * (i - 100000) / 100000, r = pow(10, i % 7 - 3);
        const float x = (float)(r * cos(angle)), y = (float)(r * sin(angle));
        worst = fmax(worst, fabs((double)ptie_anglef(y, x) - atan2((double)y, (double)x)));
    }
    assert_near(worst, 0, 4e-7); /* measured 2.9e-7 */
    assert_true(ptie_anglef(0, 0) == 0 && ptie_anglef(0, 1) == 0);
}

static void floors_go_down(void **state) {
    (void)state;
    for (float x = -5; x <= 5; x += 0.125f) assert_true(ptie_floorf(x) == floorf(x));
}

enum { N = 4099 };

PTIE_CLONES static void vectorised(float *out, const float *x) {
    for (int i = 0; i < N; i++)
        out[i] = ptie_expf(x[i]) + ptie_sinf(40 * x[i]) + ptie_logf(x[i] * x[i] + 1e-3f);
}

/* What a data set's bytes rest on. */
static void clones_compute_the_same_bits(void **state) {
    (void)state;
    static float x[N], all[N];
    ptie_random random;
    ptie_random_init(&random, 1, PTIE_STREAM_TEXTURE, 0);
    ptie_random_normals(&random, x, N);
    vectorised(all, x);
    for (int i = 0; i < N; i++) {
        volatile float one = x[i]; /* keeps this loop scalar */
        assert_true(all[i] == ptie_expf(one) + ptie_sinf(40 * one) + ptie_logf(one * one + 1e-3f));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exponentials_are_within_1_2_ulp),
        cmocka_unit_test(logarithms_are_within_1_2_ulp),
        cmocka_unit_test(sines_and_cosines_are_within_1_2e_7),
        cmocka_unit_test(angles_are_within_4e_7),
        cmocka_unit_test(floors_go_down),
        cmocka_unit_test(clones_compute_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
