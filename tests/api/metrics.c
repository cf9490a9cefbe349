/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/metrics.h>: every function, its arguments and their refusal. */
#include "support/support.h"

#include <math.h>

#include <ptie/metrics.h>

static const float image[16] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};

static void compare_checks_its_arguments(void **state) {
    (void)state;
    ptie_comparison c;
    assert_ok(ptie_compare(&c, image, image, 4, 4, 1));
    assert_ok(ptie_compare(&c, image, image, 1, 1, 1));
    assert_fails(ptie_compare(NULL, image, image, 4, 4, 1), PTIE_EINVAL,
                 "ptie_compare: out is missing");
    assert_fails(ptie_compare(&c, NULL, image, 4, 4, 1), PTIE_EINVAL, "estimate is missing");
    assert_fails(ptie_compare(&c, image, NULL, 4, 4, 1), PTIE_EINVAL, "truth is missing");
    assert_fails(ptie_compare(&c, image, image, 0, 4, 1), PTIE_EINVAL, "width_px is out of range");
    assert_fails(ptie_compare(&c, image, image, 4, 32769, 1), PTIE_EINVAL,
                 "height_px is out of range");
    assert_fails(ptie_compare(&c, image, image, 4, 4, 0), PTIE_EINVAL,
                 "range is out of range (expected a number > 0, found 0)");
    assert_fails(ptie_compare(&c, image, image, 4, 4, (double)NAN), PTIE_EINVAL, "found nan");
}

static void rectangles_must_lie_inside(void **state) {
    (void)state;
    uint8_t labels[16];
    const ptie_rect all = {0, 0, 4, 4};
    static const ptie_rect bad[] = {{-1, 0, 2, 2}, {0, -1, 2, 2},        {0, 0, 0, 2},
                                    {0, 0, 2, 0},  {3, 0, 2, 2},         {0, 3, 2, 2},
                                    {0, 0, 5, 1},  {0, 0, -2, 2},        {4, 0, 1, 1},
                                    {0, 4, 1, 1},  {1, 0, INT32_MAX, 1}, {INT32_MAX, 0, 1, 1}};
    assert_ok(ptie_regions_from_rects(labels, 4, 4, all, all));
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_fails(ptie_regions_from_rects(labels, 4, 4, bad[i], all), PTIE_EINVAL,
                     "region 'jet' leaves the image or is empty (expected within 4 x 4 px, found");
        assert_fails(ptie_regions_from_rects(labels, 4, 4, all, bad[i]), PTIE_EINVAL,
                     "region 'background' leaves the image or is empty");
    }
    for (int i = 0; i < 16; i++) assert_int_equal(labels[i], PTIE_JET); /* untouched */
    assert_fails(ptie_regions_from_rects(NULL, 4, 4, all, all), PTIE_EINVAL, "labels is missing");
    assert_fails(ptie_regions_from_rects(labels, 4, -4, all, all), PTIE_EINVAL, "height_px");
}

static void propose_checks_its_arguments(void **state) {
    (void)state;
    uint8_t labels[16];
    assert_fails(ptie_regions_propose(NULL, image, 4, 4), PTIE_EINVAL, "labels is missing");
    assert_fails(ptie_regions_propose(labels, NULL, 4, 4), PTIE_EINVAL, "map is missing");
    assert_fails(ptie_regions_propose(labels, image, 0, 4), PTIE_EINVAL,
                 "width_px is out of range");
    assert_fails(ptie_regions_propose(labels, image, 1, 1), PTIE_ENUMERIC, "map: is constant");
}

static void flow_measure_checks_its_arguments(void **state) {
    (void)state;
    const uint8_t labels[16] = {PTIE_JET, PTIE_BACKGROUND};
    ptie_flow_metrics m;
    assert_ok(ptie_flow_measure(&m, image, labels, 4, 4));
    assert_near(m.sbr, 0.5, 1e-15);
    assert_fails(ptie_flow_measure(NULL, image, labels, 4, 4), PTIE_EINVAL, "out is missing");
    assert_fails(ptie_flow_measure(&m, NULL, labels, 4, 4), PTIE_EINVAL, "map is missing");
    assert_fails(ptie_flow_measure(&m, image, NULL, 4, 4), PTIE_EINVAL, "labels is missing");
    assert_fails(ptie_flow_measure(&m, image, labels, 4, 0), PTIE_EINVAL,
                 "height_px is out of range");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(compare_checks_its_arguments),
        cmocka_unit_test(rectangles_must_lie_inside),
        cmocka_unit_test(propose_checks_its_arguments),
        cmocka_unit_test(flow_measure_checks_its_arguments),
    };
    return cmocka_run_group_tests_name("metrics", tests, NULL, NULL);
}
