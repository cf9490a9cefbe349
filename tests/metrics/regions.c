/* SPDX-License-Identifier: BSD-3-Clause */
/* Regions: rectangles, and proposals on images whose regions are known. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include <ptie/metrics.h>

#include "base/random.h"
#include "base/mask.h"

enum { N = 200, PIXELS = N * N };

static void rectangles_become_labels_and_the_jet_wins(void **state) {
    (void)state;
    uint8_t labels[20];
    assert_ok(
        ptie_regions_from_rects(labels, 5, 4, (ptie_rect){1, 1, 2, 2}, (ptie_rect){2, 0, 3, 4}));
    static const uint8_t expected[20] = {0, 0, 2, 2, 2, 0, 1, 1, 2, 2,
                                         0, 1, 1, 2, 2, 0, 0, 2, 2, 2};
    assert_memory_equal(labels, expected, sizeof labels);
}

/* A plume that leaves the frame at its right edge: |y - 100| < 20 + x / 10 and x > 30. */
static bool in_plume(int x, int y) {
    return x > 30 && abs(y - 100) < 20 + x / 10;
}

static void set_plume(float *map, double height, double level, double noise) {
    ptie_random random;
    ptie_random_init(&random, 7, PTIE_STREAM_TEXTURE, 0);
    ptie_random_normals(&random, map, PIXELS);
    for (int i = 0; i < PIXELS; i++)
        map[i] = (float)(level + noise * (double)map[i] + (in_plume(i % N, i / N) ? height : 0));
}

/* Share of the plume labelled jet, of the jet inside the plume, and the background's properties. */
static void check_plume(const uint8_t *labels) {
    int plume = 0, jet = 0, both = 0, background = 0;
    for (int i = 0; i < PIXELS; i++) {
        const bool inside = in_plume(i % N, i / N);
        plume += inside, jet += labels[i] == PTIE_JET, both += inside && labels[i] == PTIE_JET;
        background += labels[i] == PTIE_BACKGROUND;
        if (labels[i] != PTIE_BACKGROUND) continue;
        /* 5 % of 200 px: no plume within 10 px, but for 2 px of cleaning. */
        for (int dy = -8; dy <= 8; dy += 8)
            for (int dx = -8; dx <= 8; dx += 8) {
                const int x = i % N + dx, y = i / N + dy;
                if (x >= 0 && x < N && y >= 0 && y < N) assert_false(in_plume(x, y));
            }
    }
    assert_true(both > 0.95 * plume && both > 0.95 * jet);
    assert_true(background > 0.85 * (PIXELS - plume) - 10 * 4 * N); /* all but the margin */
}

static void a_plume_of_either_sign_is_found(void **state) {
    (void)state;
    float *map = calloc(PIXELS, sizeof *map);
    uint8_t labels[PIXELS];
    for (int sign = -1; sign <= 1; sign += 2)
        for (int level = -3; level <= 3; level += 3) {
            set_plume(map, sign * 1.0, level, 0.1);
            assert_ok(ptie_regions_propose(labels, map, N, N));
            check_plume(labels);
        }
    free(map);
}

/* A flow with parts of both signs; specks are dropped, holes of a few pixels filled. */
static void parts_of_both_signs_are_one_jet(void **state) {
    (void)state;
    float *map = calloc(PIXELS, sizeof *map);
    uint8_t labels[PIXELS];
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % N, y = i / N;
        if (hypot(x - 60, y - 100) < 30) map[i] = 1;
        if (hypot(x - 140, y - 100) < 30) map[i] = -1;
        if (hypot(x - 60, y - 100) < 1.5) map[i] = 0; /* a hole of 3 x 3 */
        if (hypot(x - 20, y - 20) < 1.5) map[i] = 1;  /* a speck of 3 x 3 */
        if (hypot(x - 180, y - 20) < 6) map[i] = 1;   /* a part of 4 % of the largest */
    }
    assert_ok(ptie_regions_propose(labels, map, N, N));
    assert_int_equal(labels[100 * N + 60], PTIE_JET);
    assert_int_equal(labels[100 * N + 140], PTIE_JET);
    assert_int_equal(labels[20 * N + 20], PTIE_BACKGROUND);
    assert_int_equal(labels[20 * N + 180], PTIE_BACKGROUND);
    assert_int_equal(labels[100 * N + 60 - 35], PTIE_NOWHERE); /* 5 px from the jet */
    assert_int_equal(labels[100 * N + 60 - 45], PTIE_BACKGROUND);
    free(map);
}

static void what_has_no_regions_is_refused(void **state) {
    (void)state;
    float map[256];
    uint8_t labels[256];
    for (int i = 0; i < 256; i++) map[i] = 3, labels[i] = 77;
    assert_fails(ptie_regions_propose(labels, map, 16, 16), PTIE_ENUMERIC, "map: is constant");
    map[100] = 4; /* one pixel is no region */
    assert_fails(ptie_regions_propose(labels, map, 16, 16), PTIE_ENUMERIC,
                 "expected a jet and room for a background, found 0 and 256 pixels");
    for (int i = 0; i < 256; i++) map[i] = i % 16 > 0 && i % 16 < 15 && i > 15 && i < 240;
    assert_fails(ptie_regions_propose(labels, map, 16, 16), PTIE_ENUMERIC,
                 "found 256 and 0 pixels"); /* the gap of one pixel to the frame is closed */
    map[18] = NAN;
    assert_fails(ptie_regions_propose(labels, map, 16, 16), PTIE_ENUMERIC,
                 "map: value is not finite (at x=2, y=1");
    for (int i = 0; i < 256; i++) assert_int_equal(labels[i], 77); /* untouched */
}

/* Growing by its definition: any pixel of the value within the square. */
static void growing_meets_its_definition(void **state) {
    (void)state;
    enum { W = 23, H = 17 };
    uint8_t mask[W * H], grown[W * H], work[W * H];
    ptie_random random;
    ptie_random_init(&random, 8, PTIE_STREAM_TEXTURE, 0);
    for (int radius = 0; radius < 30; radius = 2 * radius + 1)
        for (uint8_t value = 0; value < 2; value++) {
            for (int i = 0; i < W * H; i++) {
                const bool rare = ptie_random_uniform(&random, 0, 1) < 0.02;
                mask[i] = rare ? value : !value;
            }
            memcpy(grown, mask, sizeof mask);
            ptie_mask_grow(grown, W, H, radius, value, work);
            for (int y = 0; y < H; y++)
                for (int x = 0; x < W; x++) {
                    bool near = false;
                    for (int v = 0; v < H; v++)
                        for (int u = 0; u < W; u++)
                            near |= abs(u - x) <= radius && abs(v - y) <= radius &&
                                    mask[v * W + u] == value;
                    assert_int_equal(grown[y * W + x], near ? value : !value);
                }
        }
}

static void small_parts_are_dropped(void **state) {
    (void)state;
    uint8_t mask[] = {1, 1, 0, 0, 0, 1, /* */
                      0, 0, 1, 0, 0, 0, /* the diagonal connects */
                      0, 0, 0, 0, 1, 1};
    static const uint8_t half[] = {1, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 1};
    int32_t size[18], queue[18];
    ptie_mask_keep_large(mask, 6, 3, 0.5, size, queue); /* sizes 3, 1 and 2 */
    assert_memory_equal(mask, half, sizeof half);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rectangles_become_labels_and_the_jet_wins),
        cmocka_unit_test(a_plume_of_either_sign_is_found),
        cmocka_unit_test(parts_of_both_signs_are_one_jet),
        cmocka_unit_test(what_has_no_regions_is_refused),
        cmocka_unit_test(growing_meets_its_definition),
        cmocka_unit_test(small_parts_are_dropped),
    };
    return cmocka_run_group_tests_name("regions", tests, NULL, NULL);
}
