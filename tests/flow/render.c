/* SPDX-License-Identifier: BSD-3-Clause */
/* Whole flows: range, sizes, determinism, motion, scaling, messages. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include "base/pool.h"
#include "flow/flow.h"

enum { SIZE = 96, PIXELS = SIZE * SIZE };

static ptie_flow_params flow(const char *morphology, ptie_family family, uint64_t index) {
    ptie_flow_params params;
    ptie_flow_params_init(&params);
    params.width_px = params.height_px = SIZE;
    params.pixel_m = 50e-6;
    params.family = family;
    params.morphology = morphology;
    params.index = index;
    return params;
}

/* Morphologies by number, "mix" after the last. */
static const char *name_of(int32_t which) {
    const char *name = ptie_morphology_name(which);
    return name ? name : "mix";
}

typedef struct extent {
    double low, high;
    bool finite;
} extent;

static extent extent_of(const float *map, size_t count) {
    extent e = {(double)map[0], (double)map[0], true};
    for (size_t i = 0; i < count; i++) {
        e.finite = e.finite && isfinite(map[i]);
        e.low = fmin(e.low, (double)map[i]);
        e.high = fmax(e.high, (double)map[i]);
    }
    return e;
}

static void every_morphology_has_a_name(void **state) {
    (void)state;
    static const char *const names[] = {"jet",    "eddies",    "front", "pockets",
                                        "fan",    "diffusion", "shock", "combustion",
                                        "plasma", "random",    "nozzle"};
    assert_int_equal(ptie_morphology_count(), 11);
    for (int32_t i = 0; i < 11; i++) {
        assert_string_equal(ptie_morphology_name(i), names[i]);
        assert_non_null(ptie_morphology_title(i));
    }
    assert_null(ptie_morphology_name(11));
    assert_null(ptie_morphology_name(-1));
    assert_null(ptie_morphology_title(11));
}

static void parametric_maps_touch_both_ends(void **state) {
    (void)state;
    float *map = malloc(PIXELS * sizeof *map);
    for (int32_t which = 0; which <= 11; which++)
        for (uint64_t index = 0; index < 12; index++) {
            ptie_flow_params params = flow(name_of(which), PTIE_PARAMETRIC, index);
            params.time_s = (double)index * 1e-3;
            assert_ok(ptie_flow_render(map, &params));
            extent e = extent_of(map, PIXELS);
            assert_true(e.finite && e.low == 0 && e.high == 1);
        }
    free(map);
}

/* A thousandth of a radian is what a camera could see of a millimetre of gas at best. */
static void physical_maps_show_something_of_sensible_size(void **state) {
    (void)state;
    float *map = malloc(PIXELS * sizeof *map);
    for (int32_t which = 0; which <= 11; which++)
        for (uint64_t index = 0; index < 12; index++) {
            ptie_flow_params params = flow(name_of(which), PTIE_PHYSICAL, index);
            params.time_s = (double)index * 1e-3;
            assert_ok(ptie_flow_render(map, &params));
            extent e = extent_of(map, PIXELS);
            assert_true(e.finite && e.high - e.low > 1e-3 && e.high - e.low < 200);
        }
    free(map);
}

/* Hot gas and free electrons delay light less than the air does. */
static void flames_and_plasmas_are_negative(void **state) {
    (void)state;
    float *map = malloc(PIXELS * sizeof *map);
    for (uint64_t index = 0; index < 8; index++) {
        const char *const names[] = {"combustion", "plasma"};
        for (int i = 0; i < 2; i++) {
            ptie_flow_params params = flow(names[i], PTIE_PHYSICAL, index);
            assert_ok(ptie_flow_render(map, &params));
            assert_true(extent_of(map, PIXELS).high <= 0);
        }
    }
    free(map);
}

static void any_size_renders(void **state) {
    (void)state;
    static const int32_t sizes[][2] = {{16, 16},  {17, 31},  {256, 16},
                                       {16, 200}, {129, 64}, {640, 33}};
    for (int i = 0; i < 6; i++) {
        size_t count = (size_t)(sizes[i][0] * sizes[i][1]);
        /* Guard values after the end stay as they are. */
        float *map = malloc((count + 16) * sizeof *map);
        for (int32_t which = 0; which < 24; which++) {
            for (size_t k = 0; k < 16; k++) map[count + k] = 77;
            ptie_flow_params params = flow(name_of(which % 12), (ptie_family)(which / 12), 3);
            params.width_px = sizes[i][0], params.height_px = sizes[i][1];
            assert_ok(ptie_flow_render(map, &params));
            extent e = extent_of(map, count);
            assert_true(e.finite && e.high > e.low);
            for (size_t k = 0; k < 16; k++) assert_true(map[count + k] == 77);
        }
        free(map);
    }
}

static ptie_status render_one(void *context, size_t task, int32_t worker) {
    (void)worker;
    float *maps = context;
    ptie_flow_params params =
        flow(name_of((int32_t)(task / 2 % 12)), (ptie_family)(task % 2), task);
    params.time_s = 1e-4;
    return ptie_flow_render(maps + task * PIXELS, &params);
}

static void the_same_bits_in_any_order_on_any_thread(void **state) {
    (void)state;
    enum { TASKS = 48 };
    float *alone = malloc(TASKS * PIXELS * sizeof *alone),
          *together = malloc(TASKS * PIXELS * sizeof *together);
    for (size_t task = TASKS; task-- > 0;) assert_ok(render_one(alone, task, 0));
    ptie_pool *pool;
    assert_ok(ptie_pool_create(&pool, 4));
    assert_ok(ptie_pool_run(pool, TASKS, render_one, together));
    ptie_pool_free(pool);
    assert_memory_equal(alone, together, TASKS * PIXELS * sizeof *alone);
    free(alone);
    free(together);
}

static double correlation(const float *a, const float *b) {
    double ma = 0, mb = 0, ab = 0, aa = 0, bb = 0;
    for (int i = 0; i < PIXELS; i++) ma += (double)a[i] / PIXELS, mb += (double)b[i] / PIXELS;
    for (int i = 0; i < PIXELS; i++) {
        double p = (double)a[i] - ma, q = (double)b[i] - mb;
        ab += p * q, aa += p * p, bb += q * q;
    }
    return ab / sqrt(aa * bb);
}

static void morphologies_seeds_and_indices_differ(void **state) {
    (void)state;
    float *maps = malloc(12 * PIXELS * sizeof *maps), *other = malloc(PIXELS * sizeof *other);
    for (int32_t which = 0; which <= 11; which++) {
        ptie_flow_params params = flow(name_of(which), PTIE_PARAMETRIC, 1);
        float *map = maps + which * PIXELS;
        assert_ok(ptie_flow_render(map, &params));
        for (int32_t before = 0; before < which; before++)
            assert_true(correlation(map, maps + before * PIXELS) < 0.95);
        params.seed = 1;
        assert_ok(ptie_flow_render(other, &params));
        assert_true(correlation(map, other) < 0.95);
        params.seed = 0, params.index = 2;
        assert_ok(ptie_flow_render(other, &params));
        assert_true(correlation(map, other) < 0.95);
    }
    free(maps);
    free(other);
}

/* Frames of a camera at 25,000 per second follow from each other, and later ones less. */
static void flows_move_and_stay_themselves(void **state) {
    (void)state;
    float *first = malloc(PIXELS * sizeof *first), *next = malloc(PIXELS * sizeof *next);
    for (int32_t which = 0; which < 22; which++) {
        double near = 0, far = 0;
        enum { FLOWS = 8 };
        for (uint64_t index = 0; index < FLOWS; index++) {
            ptie_flow_params params = flow(name_of(which % 11), (ptie_family)(which / 11), index);
            assert_ok(ptie_flow_render(first, &params));
            params.time_s = 40e-6;
            assert_ok(ptie_flow_render(next, &params));
            double now = correlation(first, next);
            assert_true(memcmp(first, next, PIXELS * sizeof *first) != 0);
            near += now / FLOWS;
            params.time_s = 400e-6;
            assert_ok(ptie_flow_render(next, &params));
            far += correlation(first, next) / FLOWS;
        }
        /* Measured: near 0.56 (front) to 0.998; pockets are periodic and come round again. */
        bool periodic = strcmp(name_of(which % 11), "pockets") == 0;
        assert_true(near > 0.4 && near < 0.9999 && (far < near || periodic));
    }
    free(first);
    free(next);
}

static void assert_scaled(const float *a, const float *b, double factor) {
    extent e = extent_of(a, PIXELS);
    double peak = fmax(fabs(e.low), fabs(e.high));
    /* A dozen roundings of factors, added with both signs. */
    for (int i = 0; i < PIXELS; i++)
        assert_near((double)b[i], factor * (double)a[i], 3e-6 * fmax(1, factor) * peak);
}

static void phase_goes_with_path_and_wave_number(void **state) {
    (void)state;
    static const char *const gases[] = {"jet",       "eddies", "front",      "pockets", "fan",
                                        "diffusion", "shock",  "combustion", "nozzle"};
    float *once = malloc(PIXELS * sizeof *once), *scaled = malloc(PIXELS * sizeof *scaled);
    for (int i = 0; i < 9; i++) {
        ptie_flow_params params = flow(gases[i], PTIE_PHYSICAL, 4);
        assert_ok(ptie_flow_render(once, &params));
        params.wavelength_m *= 2;
        assert_ok(ptie_flow_render(scaled, &params));
        assert_scaled(once, scaled, 0.5);
        params.wavelength_m /= 2, params.pixel_m *= 2;
        assert_ok(ptie_flow_render(scaled, &params));
        assert_scaled(once, scaled, 2);
    }
    ptie_flow_params params = flow("plasma", PTIE_PHYSICAL, 4);
    assert_ok(ptie_flow_render(once, &params));
    params.wavelength_m *= 2; /* electrons: with the wavelength */
    assert_ok(ptie_flow_render(scaled, &params));
    assert_scaled(once, scaled, 2);
    free(once);
    free(scaled);
}

/* One member, nothing added: what a composition does by itself. */
static ptie_flow_mix plain(int32_t which, ptie_family family) {
    ptie_flow_mix mix = {.family = family, .components = {1, 1}};
    mix.weight[which] = 1;
    return mix;
}

static void compositions_report_their_members(void **state) {
    (void)state;
    float *map = malloc(PIXELS * sizeof *map);
    ptie_flow_params params = flow("mix", PTIE_PARAMETRIC, 5);
    uint32_t members;
    for (int32_t which = 0; which < 11; which++) {
        ptie_flow_mix mix = plain(which, PTIE_PARAMETRIC);
        assert_ok(ptie_flow_compose(map, &mix, &params, &members));
        assert_int_equal(members, 1u << which);
    }
    ptie_flow_mix paper = ptie_flow_mix_paper();
    uint32_t seen = 0;
    for (params.index = 0; params.index < 60; params.index++) {
        assert_ok(ptie_flow_compose(map, &paper, &params, &members));
        assert_true(members != 0 && members < 1u << 11);
        seen |= members;
    }
    assert_int_equal(seen,
                     (1u << 11) - 1); /* the rarest has a chance of 4 % per member, two per map */
    free(map);
}

static void gradients_tilt_by_their_share_of_the_range(void **state) {
    (void)state;
    float *flat = malloc(PIXELS * sizeof *flat), *tilted = malloc(PIXELS * sizeof *tilted);
    ptie_flow_params params = flow("mix", PTIE_PHYSICAL, 5);
    ptie_flow_mix mix = plain(7, PTIE_PHYSICAL);
    assert_ok(ptie_flow_compose(flat, &mix, &params, NULL));
    mix.gradient = (ptie_range){0.3, 0.3};
    assert_ok(ptie_flow_compose(tilted, &mix, &params, NULL));
    extent e = extent_of(flat, PIXELS);
    for (int i = 0; i < PIXELS; i++) tilted[i] -= flat[i];
    extent ramp = extent_of(tilted, PIXELS);
    /* From corner to corner, between the centres of the outer pixels: (SIZE - 1) / SIZE of the
     * share. */
    double share = 0.3 * (SIZE - 1) / SIZE * (e.high - e.low);
    assert_near(ramp.high - ramp.low, share, 1e-5 * (e.high - e.low));
    free(flat);
    free(tilted);
}

static void wrong_parameters_are_named(void **state) {
    (void)state;
    float map[256];
    ptie_flow_params params = flow("jett", PTIE_PARAMETRIC, 0);
    assert_fails(ptie_flow_render(map, &params), PTIE_ENAME,
                 "ptie_flow_render: unknown morphology 'jett' (did you mean 'jet'?)");
    params.morphology = "combustions";
    assert_fails(ptie_flow_render(map, &params), PTIE_ENAME, "did you mean 'combustion'?");
    params.morphology = NULL;
    assert_fails(ptie_flow_render(map, &params), PTIE_EINVAL, "morphology is missing");
    params = flow("mix", PTIE_PARAMETRIC, 0);
    params.width_px = 15;
    assert_fails(ptie_flow_render(map, &params), PTIE_EINVAL,
                 "width_px is out of range (expected 16..32768, found 15)");
    params = flow("mix", PTIE_PARAMETRIC, 0);
    params.height_px = 40000;
    assert_fails(ptie_flow_render(map, &params), PTIE_EINVAL, "height_px");
    params = flow("mix", PTIE_PARAMETRIC, 0);
    params.pixel_m = 0;
    assert_fails(ptie_flow_render(map, &params), PTIE_EINVAL, "pixel_m");
    params.pixel_m = 1e-300; /* steps of 1e300 px are no 64-bit number */
    params.time_s = 1;
    assert_fails(ptie_flow_render(map, &params), PTIE_EINVAL,
                 "pixel_m is out of range (expected 1e-09..1, found 1e-300)");
    params = flow("mix", PTIE_PARAMETRIC, 0);
    params.wavelength_m = (double)NAN;
    assert_fails(ptie_flow_render(map, &params), PTIE_EINVAL, "wavelength_m");
    params = flow("mix", (ptie_family)2, 0);
    assert_fails(ptie_flow_render(map, &params), PTIE_EINVAL,
                 "family is out of range (expected 0..1, found 2)");
    params = flow("mix", PTIE_PARAMETRIC, 0);
    params.time_s = -1;
    assert_fails(ptie_flow_render(map, &params), PTIE_EINVAL, "time_s");
    assert_fails(ptie_flow_render(NULL, &params), PTIE_EINVAL, "phase");
    assert_fails(ptie_flow_render(map, NULL), PTIE_EINVAL, "params");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_morphology_has_a_name),
        cmocka_unit_test(parametric_maps_touch_both_ends),
        cmocka_unit_test(physical_maps_show_something_of_sensible_size),
        cmocka_unit_test(flames_and_plasmas_are_negative),
        cmocka_unit_test(any_size_renders),
        cmocka_unit_test(the_same_bits_in_any_order_on_any_thread),
        cmocka_unit_test(morphologies_seeds_and_indices_differ),
        cmocka_unit_test(flows_move_and_stay_themselves),
        cmocka_unit_test(phase_goes_with_path_and_wave_number),
        cmocka_unit_test(compositions_report_their_members),
        cmocka_unit_test(gradients_tilt_by_their_share_of_the_range),
        cmocka_unit_test(wrong_parameters_are_named),
    };
    return cmocka_run_group_tests_name("flow/render", tests, NULL, NULL);
}
