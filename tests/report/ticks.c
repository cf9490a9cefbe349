/* SPDX-License-Identifier: BSD-3-Clause */
/* Ticks, their labels, and colours. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include "report/colormap.h"
#include "report/ticks.h"

/* The number a label shows, with its true minus sign. */
static double shown(const char *label) {
    static const char minus[] = "−";
    return strncmp(label, minus, strlen(minus)) == 0 ? -atof(label + strlen(minus)) : atof(label);
}

static void linear_ticks_are_round_inside_and_distinct(void **state) {
    (void)state;
    static const double ranges[][2] = {
        {0, 1},          {-1, 1},    {0.13, 0.38},   {1, 20},         {-3.7, -3.1}, {1e-9, 4e-9},
        {-2e-13, 1e-13}, {1e7, 9e7}, {1000, 1000.1}, {-0.098, 0.099}, {0, 1023},    {-5e-324, 1}};
    for (size_t r = 0; r < sizeof ranges / sizeof *ranges; r++) {
        for (int32_t most = 5; most <= PTIE_MAX_TICKS; most++) {
            double low = ranges[r][0], high = ranges[r][1];
            ptie_ticks t;
            ptie_linear_ticks(&t, low, high, most, false);
            assert_in_range(t.count, 2, most);
            double slack = 1e-6 * (high - low), step = t.value[1] - t.value[0];
            for (int32_t i = 0; i < t.count; i++) {
                char text[PTIE_LABEL_BYTES];
                ptie_tick_label(text, &t, i);
                assert_true(t.value[i] >= low - slack && t.value[i] <= high + slack);
                if (i > 0) assert_near(t.value[i] - t.value[i - 1], step, 1e-6 * step);
                /* Labels are exact: a step is 1, 2 or 5 in its last digit. */
                assert_near(shown(text) * pow(10, t.exponent), t.value[i], 1e-6 * step);
            }
            /* There is no room for another tick at either end. */
            assert_true(t.value[0] - step < low + slack &&
                        t.value[t.count - 1] + step > high - slack);
        }
    }
}

static void ticks_of_counts_are_whole(void **state) {
    (void)state;
    ptie_ticks t;
    ptie_linear_ticks(&t, 1, 3, 6, true);
    assert_int_equal(t.count, 3);
    for (int32_t i = 0; i < 3; i++) assert_true(t.value[i] == i + 1);
}

static void empty_ranges_are_opened(void **state) {
    (void)state;
    double ranges[][2] = {
        {0, 0}, {5, 5}, {-2e-9, -2e-9}, {1, -1}, {(double)NAN, (double)NAN}, {HUGE_VAL, -HUGE_VAL}};
    for (size_t r = 0; r < sizeof ranges / sizeof *ranges; r++) {
        double low = ranges[r][0], high = ranges[r][1];
        ptie_widen(&low, &high);
        assert_true(isfinite(low) && isfinite(high) && low < high);
        ptie_ticks t;
        ptie_linear_ticks(&t, low, high, 6, false);
        assert_in_range(t.count, 2, 6);
    }
}

static void logarithmic_ticks_follow_the_decades(void **state) {
    (void)state;
    ptie_ticks t;
    char text[PTIE_LABEL_BYTES];
    ptie_log_ticks(&t, 1e-6, 1e-1, 8);
    assert_int_equal(t.count, 6);
    ptie_tick_label(text, &t, 0);
    assert_string_equal(text, "10⁻⁶");
    ptie_tick_label(text, &t, 5);
    assert_string_equal(text, "0.1");
    ptie_log_ticks(&t, 0.9, 60, 6); /* 1 2 5 10 20 50 */
    assert_int_equal(t.count, 6);
    assert_near(t.value[4], 20, 1e-12);
    ptie_log_ticks(&t, 1e-300, 1e300, 8);
    assert_in_range(t.count, 3, 8);
    ptie_log_ticks(&t, 0.21, 0.28, 6); /* no power of ten inside: linear */
    assert_in_range(t.count, 2, 6);
}

static void labels_leave_out_a_common_power(void **state) {
    (void)state;
    ptie_ticks t;
    char text[PTIE_LABEL_BYTES];
    ptie_linear_ticks(&t, 0, 3e-4, 5, false);
    ptie_tick_factor(text, &t);
    assert_string_equal(text, "×10⁻⁴");
    ptie_tick_label(text, &t, 1);
    assert_string_equal(text, "1");
    ptie_linear_ticks(&t, -0.5, 0.5, 5, false);
    ptie_tick_factor(text, &t);
    assert_string_equal(text, "");
    ptie_tick_label(text, &t, 0);
    assert_string_equal(text, "−0.4");
    ptie_tick_label(text, &t, 2);
    assert_string_equal(text, "0.0");
}

static int channel(uint32_t rgb, int shift) {
    return (int)(rgb >> shift & 255);
}

static int distance(uint32_t a, uint32_t b) {
    int most = 0;
    for (int shift = 0; shift <= 16; shift += 8) {
        int d = abs(channel(a, shift) - channel(b, shift));
        if (d > most) most = d;
    }
    return most;
}

static void colours_are_those_of_the_published_maps(void **state) {
    (void)state;
    /* Entries of matplotlib's viridis between the control points; linear pieces of 15 entries stay
       within 6/255 of them (measured: 5, at the yellow end). */
    static const struct {
        int entry;
        double rgb[3];
    } viridis[] = {{7, {0.276022, 0.044167, 0.370164}},   {53, {0.250425, 0.274290, 0.533103}},
                   {128, {0.127568, 0.566949, 0.550556}}, {172, {0.220124, 0.725509, 0.466226}},
                   {203, {0.468053, 0.818921, 0.323998}}, {247, {0.916242, 0.896091, 0.100717}}};
    for (size_t i = 0; i < sizeof viridis / sizeof *viridis; i++) {
        uint32_t expected = 0;
        for (int c = 0; c < 3; c++)
            expected = expected << 8 | (uint32_t)lround(255 * viridis[i].rgb[c]);
        assert_in_range(distance(ptie_colour(PTIE_VIRIDIS, viridis[i].entry / 255.0), expected), 0,
                        6);
    }
    assert_int_equal(ptie_colour(PTIE_DIVERGING, 0.5), 0xffffff);
    assert_true(channel(ptie_colour(PTIE_DIVERGING, 0.2), 0) >
                channel(ptie_colour(PTIE_DIVERGING, 0.2), 16));
    assert_true(channel(ptie_colour(PTIE_DIVERGING, 0.8), 0) <
                channel(ptie_colour(PTIE_DIVERGING, 0.8), 16));
    assert_int_equal(ptie_colour(PTIE_GRAY, 100 / 255.0), 0x646464);
    assert_int_equal(ptie_colour(PTIE_GRAY, -HUGE_VAL), 0);
    assert_int_equal(ptie_colour(PTIE_GRAY, 7), 0xffffff);
}

static void nan_is_no_colour_of_a_map(void **state) {
    (void)state;
    for (int map = PTIE_GRAY; map <= PTIE_DIVERGING; map++) {
        assert_int_equal(ptie_colour((ptie_colormap)map, (double)NAN), PTIE_NAN_COLOUR);
        for (int i = 0; i <= 1000; i++)
            assert_true(distance(ptie_colour((ptie_colormap)map, i / 1000.0), PTIE_NAN_COLOUR) >
                        30);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(linear_ticks_are_round_inside_and_distinct),
        cmocka_unit_test(ticks_of_counts_are_whole),
        cmocka_unit_test(empty_ranges_are_opened),
        cmocka_unit_test(logarithmic_ticks_follow_the_decades),
        cmocka_unit_test(labels_leave_out_a_common_power),
        cmocka_unit_test(colours_are_those_of_the_published_maps),
        cmocka_unit_test(nan_is_no_colour_of_a_map),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
