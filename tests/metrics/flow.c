/* SPDX-License-Identifier: BSD-3-Clause */
/* Flow metrics by hand. */
#include "support/support.h"

#include <math.h>

#include <ptie/metrics.h>

enum { W = 12, H = 8 };
static const ptie_rect left = {0, 0, 6, 8}, right = {8, 0, 4, 8};

static void a_plane_has_its_slope(void **state) {
    (void)state;
    float map[W * H];
    uint8_t labels[W * H];
    for (int i = 0; i < W * H; i++) map[i] = 3 * (float)(i % W) + 4 * (float)(i / W) + 1;
    assert_ok(ptie_regions_from_rects(labels, W, H, left, right));
    ptie_flow_metrics m;
    assert_ok(ptie_flow_measure(&m, map, labels, W, H));
    assert_near(m.mgm, 5, 1e-12); /* also on the edges */
    assert_near(m.mean_jet, 3 * 2.5 + 4 * 3.5 + 1, 1e-12);
    assert_near(m.mean_background, 3 * 9.5 + 4 * 3.5 + 1, 1e-12);
    assert_near(m.sbr, m.mean_jet / m.mean_background, 1e-15);
    /* Variance of 0..n-1 is (n^2 - 1) / 12. */
    const double var_jet = 9 * 35 / 12.0 + 16 * 63 / 12.0,
                 var_background = 9 * 15 / 12.0 + 16 * 63 / 12.0;
    assert_near(m.bns, sqrt(var_background), 1e-12);
    assert_near(m.cnr, 21 / sqrt(var_jet + var_background), 1e-12);
}

static void a_clean_background_makes_ratios_unbounded(void **state) {
    (void)state;
    float map[W * H] = {0};
    uint8_t labels[W * H];
    assert_ok(ptie_regions_from_rects(labels, W, H, left, right));
    for (int i = 0; i < W * H; i++)
        if (labels[i] == PTIE_JET) map[i] = 1;
    ptie_flow_metrics m;
    assert_ok(ptie_flow_measure(&m, map, labels, W, H));
    assert_true(isinf(m.sbr) && isinf(m.cnr) && m.bns == 0);
}

static void a_scale_passes_through(void **state) {
    (void)state;
    float map[W * H];
    uint8_t labels[W * H];
    for (int i = 0; i < W * H; i++) map[i] = (float)((i * 37) % 101);
    assert_ok(ptie_regions_from_rects(labels, W, H, left, right));
    ptie_flow_metrics m, scaled;
    assert_ok(ptie_flow_measure(&m, map, labels, W, H));
    for (int i = 0; i < W * H; i++) map[i] *= -2;
    assert_ok(ptie_flow_measure(&scaled, map, labels, W, H));
    assert_near(scaled.mgm, 2 * m.mgm, 1e-12);
    assert_near(scaled.bns, 2 * m.bns, 1e-12);
    assert_near(scaled.sbr, m.sbr, 1e-14);
    assert_near(scaled.cnr, m.cnr, 1e-14);
}

static void both_regions_must_have_pixels(void **state) {
    (void)state;
    float map[4] = {1, 2, 3, 4};
    ptie_flow_metrics m;
    const uint8_t no_jet[4] = {2, 2, 0, 9}, no_background[4] = {1, 0, 1, 7};
    assert_fails(ptie_flow_measure(&m, map, no_jet, 2, 2), PTIE_EINVAL,
                 "found 0 of the jet and 2 of the background");
    assert_fails(ptie_flow_measure(&m, map, no_background, 2, 2), PTIE_EINVAL,
                 "found 2 of the jet and 0 of the background");
    map[1] = INFINITY;
    assert_fails(ptie_flow_measure(&m, map, no_jet, 2, 2), PTIE_ENUMERIC,
                 "map: value is not finite (at x=1, y=0");
}

static void a_single_row_has_slopes_along_it(void **state) {
    (void)state;
    const float map[5] = {0, 2, 4, 6, 100};
    const uint8_t labels[5] = {1, 1, 1, 0, 2};
    ptie_flow_metrics m;
    assert_ok(ptie_flow_measure(&m, map, labels, 5, 1));
    assert_near(m.mgm, 2, 1e-15);
    const uint8_t column[5] = {2, 0, 1, 1, 1}; /* slopes 2, 48, 94 */
    assert_ok(ptie_flow_measure(&m, map, column, 1, 5));
    assert_near(m.mgm, 48, 1e-12);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plane_has_its_slope),
        cmocka_unit_test(a_clean_background_makes_ratios_unbounded),
        cmocka_unit_test(a_scale_passes_through),
        cmocka_unit_test(both_regions_must_have_pixels),
        cmocka_unit_test(a_single_row_has_slopes_along_it),
    };
    return cmocka_run_group_tests_name("flow", tests, NULL, NULL);
}
