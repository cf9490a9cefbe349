/* SPDX-License-Identifier: BSD-3-Clause */
/* Backgrounds: surfaces that are known, flows that must stay, medians by sorting. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include <ptie/preprocess.h>

#include "base/random.h"

enum { W = 90, H = 61, PIXELS = W * H };

static ptie_status remove_surface(float *map, const uint8_t *mask, int32_t degree, int32_t rounds) {
    ptie_surface_params p;
    ptie_surface_params_init(&p);
    p.width_px = W, p.height_px = H, p.degree = degree, p.rounds = rounds;
    ptie_surface *surface;
    assert_ok(ptie_surface_create(&surface, &p, mask));
    void *scratch = ptie_scratch_alloc(ptie_surface_scratch_bytes(surface));
    const ptie_status status = ptie_surface_remove(surface, map, scratch);
    ptie_scratch_free(scratch);
    ptie_surface_free(surface);
    return status;
}

/* Zernike polynomials R cos m theta, R sin m theta over the frame's circle, up to radial order
 * `order`. */
static double zernike(int i, double x, double y) {
    const double r2 = x * x + y * y;
    const double z[] = {1,
                        x,
                        y,
                        2 * r2 - 1,
                        x * x - y * y,
                        2 * x * y,
                        (3 * r2 - 2) * x,
                        (3 * r2 - 2) * y,
                        x * x * x - 3 * x * y * y,
                        3 * x * x * y - y * y * y,
                        6 * r2 * r2 - 6 * r2 + 1,
                        (4 * r2 - 3) * (x * x - y * y),
                        (4 * r2 - 3) * 2 * x * y,
                        x * x * x * x - 6 * x * x * y * y + y * y * y * y,
                        4 * x * y * (x * x - y * y)};
    return z[i];
}
static const int zernikes[] = {1, 3, 6, 10, 15}; /* up to each order */

static void add_zernikes(float *map, int32_t order) {
    for (int p = 0; p < PIXELS; p++) {
        const double x = (p % W - (W - 1) / 2.0) / (H / 2.0),
                     y = (p / W - (H - 1) / 2.0) / (H / 2.0);
        double sum = 0;
        for (int i = 0; i < zernikes[order]; i++) sum += cos(3 * i + 1) * zernike(i, x, y);
        map[p] += (float)sum;
    }
}

static double largest(const float *map) {
    double most = 0;
    for (int i = 0; i < PIXELS; i++) most = fmax(most, fabs((double)map[i]));
    return most;
}

static void zernike_polynomials_are_removed(void **state) {
    (void)state;
    static float map[PIXELS];
    for (int32_t degree = 1; degree <= PTIE_SURFACE_DEGREE; degree++) {
        memset(map, 0, sizeof map);
        add_zernikes(map, degree);
        const double size = largest(map);
        assert_ok(remove_surface(map, NULL, degree, 0));
        assert_near(largest(map) / size, 0, 1e-6); /* 5 subtractions of 6e-8; measured 2.5e-7 */
    }
    memset(map, 0, sizeof map);
    add_zernikes(map, 4);
    assert_ok(remove_surface(map, NULL, 3, 0));
    assert_true(largest(map) > 0.1); /* a lower degree leaves the higher one */
}

static bool in_flow(int i) {
    return abs(i / W - H / 2) < 10;
}

static void the_masked_flow_stays(void **state) {
    (void)state;
    static float map[PIXELS];
    static uint8_t still[PIXELS];
    memset(map, 0, sizeof map);
    add_zernikes(map, 4);
    const double size = largest(map);
    for (int i = 0; i < PIXELS; i++) {
        still[i] = !in_flow(i);
        if (in_flow(i)) map[i] += 10;
    }
    assert_ok(remove_surface(map, still, 4, 0));
    for (int i = 0; i < PIXELS; i++)
        assert_near((double)map[i], in_flow(i) ? 10 : 0, 2e-6 * (size + 10));
}

/* A flow on a quarter of the frame, not masked, over noise: rejected, so that the plane is that of
 * the rest. */
static void rejection_finds_the_flow_itself(void **state) {
    (void)state;
    static float map[PIXELS], noise[PIXELS];
    ptie_random random;
    ptie_random_init(&random, 9, PTIE_STREAM_TEXTURE, 0);
    ptie_random_normals(&random, noise, PIXELS);
    double plain = 0, robust = 0;
    for (int rounds = 0; rounds <= 10; rounds += 10) {
        for (int i = 0; i < PIXELS; i++)
            map[i] = (float)(0.02 * (i % W) - 0.01 * (i / W)) + 0.1f * noise[i] +
                     (i % W > 2 * W / 3 && i / W > H / 4 ? 3 : 0);
        assert_ok(remove_surface(map, NULL, 1, rounds));
        double squares = 0;
        int count = 0;
        for (int i = 0; i < PIXELS; i++)
            if (i % W < W / 2) squares += pow((double)map[i] - 0.1 * (double)noise[i], 2), count++;
        *(rounds ? &robust : &plain) = sqrt(squares / count);
    }
    assert_true(plain > 0.3);
    assert_near(robust, 0,
                0.01); /* three terms from 4100 pixels of noise 0.1: 0.003; measured 0.003 */
}

static void a_mask_must_leave_enough(void **state) {
    (void)state;
    uint8_t still[PIXELS] = {0};
    for (int x = 0; x < W; x++) still[5 * W + x] = 1; /* a line does not tell a plane */
    ptie_surface_params p;
    ptie_surface_params_init(&p);
    p.width_px = W, p.height_px = H;
    ptie_surface *surface;
    assert_fails(ptie_surface_create(&surface, &p, still), PTIE_EINVAL,
                 "mask leaves too little to fit");
    assert_null(surface);
    p.degree = 5;
    assert_fails(ptie_surface_create(&surface, &p, NULL), PTIE_EINVAL, "degree is out of range");
}

static int ascending(const void *a, const void *b) {
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static void medians_are_those_of_sorted_frames(void **state) {
    (void)state;
    enum { MOST = 34, N = 201, STRIDE = 205 };
    static float stack[MOST * STRIDE], median[N];
    ptie_random random;
    ptie_random_init(&random, 10, PTIE_STREAM_TEXTURE, 0);
    ptie_random_normals(&random, stack, MOST * STRIDE);
    for (int i = 0; i < MOST * STRIDE; i += 3)
        stack[i] = (float)(i % 5 - 2); /* ties, zeros, both signs */
    stack[0] = -0.0f, stack[STRIDE] = 3e38f, stack[2 * STRIDE] = -3e38f, stack[3 * STRIDE] = 1e-42f;
    for (int32_t frames = 1; frames <= MOST; frames++) {
        ptie_temporal_median(median, stack, frames, STRIDE, N);
        for (int i = 0; i < N; i++) {
            float sorted[MOST];
            for (int t = 0; t < frames; t++) sorted[t] = stack[t * STRIDE + i];
            qsort(sorted, (size_t)frames, sizeof *sorted, ascending);
            assert_true(median[i] == (sorted[(frames - 1) / 2] + sorted[frames / 2]) / 2);
        }
    }
}

static void the_still_region_becomes_zero(void **state) {
    (void)state;
    static float map[PIXELS];
    for (int i = 0; i < PIXELS; i++) map[i] = (float)(i % W);
    assert_ok(ptie_pin_region(map, W, H, (ptie_rect){10, 5, 21, 8})); /* mean column 20 */
    for (int i = 0; i < PIXELS; i++) assert_true(map[i] == (float)(i % W - 20));
    assert_fails(ptie_pin_region(map, W, H, (ptie_rect){80, 5, 21, 8}), PTIE_EINVAL,
                 "region 'without flow' leaves the image or is empty");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(zernike_polynomials_are_removed),
        cmocka_unit_test(the_masked_flow_stays),
        cmocka_unit_test(rejection_finds_the_flow_itself),
        cmocka_unit_test(a_mask_must_leave_enough),
        cmocka_unit_test(medians_are_those_of_sorted_frames),
        cmocka_unit_test(the_still_region_becomes_zero),
    };
    return cmocka_run_group_tests_name("background", tests, NULL, NULL);
}
