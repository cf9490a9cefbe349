/* SPDX-License-Identifier: BSD-3-Clause */
/* Measurements: that they add up, that nothing is forgotten, that nothing stays behind. */
#include "support/support.h"

#include <dirent.h>
#include <math.h>
#include <stdlib.h>

#include <ptie/bench.h>
#include <ptie/machine.h>

#include "bench/bench.h"
#include "bench/groups.h"
#include "bench/network.h"
#include "nn/model.h"

static void spread_is_middle_and_ends(void **state) {
    (void)state;
    double one[] = {3}, odd[] = {5, -1, 4}, even[] = {8, 2, 4, 1};
    assert_near(ptie_bench_summarise(one, 1).median, 3, 0);
    const ptie_bench_spread three = ptie_bench_summarise(odd, 3),
                            four = ptie_bench_summarise(even, 4);
    assert_near(three.median, 4, 0);
    assert_near(three.low, -1, 0);
    assert_near(three.high, 5, 0);
    assert_near(four.median, 3, 0); /* between 2 and 4 */
    assert_near(four.low, 1, 0);
    assert_near(four.high, 8, 0);
}

/* multiply_add is what the others are measured against. */
static void every_kernel_is_measured(void **state) {
    (void)state;
    for (int32_t i = 0; ptie_kernel_name(i); i++)
        if (strcmp(ptie_kernel_name(i), "multiply_add") != 0 &&
            !ptie_bench_has_kernel(ptie_kernel_name(i)))
            fail_msg("kernel %s has no row in src/bench/kernels.c", ptie_kernel_name(i));
}

/* The convolutions of the paper's network by hand, level by level: inputs times outputs. */
static void operations_are_those_of_the_paper(void **state) {
    (void)state;
    ptie_model *model;
    assert_ok(ptie_bench_model(&model));
    const double pixels = 256.0 * 256.0;
    const double products = pixels * 9 * (1 * 8 + 8 * 8 + 24 * 8 + 8 * 8) +
                            pixels / 4 * 9 * (8 * 16 + 16 * 16 + 48 * 16 + 16 * 16) +
                            pixels / 16 * 9 * (16 * 32 + 32 * 32) + pixels * 8;
    assert_near(ptie_bench_forward_flops(&model->graph, 256), 2 * products, 0);
    assert_near(ptie_bench_training_flops(&model->graph, 256),
                6 * products - 2 * pixels * 9 * 1 * 8, 0);
    ptie_nn_free(model);
}

typedef struct watch {
    ptie_engine engine;
    uint64_t done, total, stop_at;
} watch;

static int on_progress(void *user, uint64_t done, uint64_t total, const char *note) {
    watch *w = user;
    assert_true(done <= total);
    assert_true(done == total || note);
    w->done = done;
    w->total = total;
    return done >= w->stop_at;
}

static void check_result(const ptie_bench_result *r) {
    assert_true(r->name[0] && r->unit[0]);
    assert_true(r->samples >= 1 && r->threads >= 1);
    if (isnan(r->median)) return;
    assert_true(r->median > 0 && r->low <= r->median && r->median <= r->high);
    if (isnan(r->gflops)) return;
    assert_true(r->peak_share > 0);
    assert_near(r->gflops / r->peak_gflops, r->peak_share, 1e-12 * r->peak_share);
}

static size_t folders_left(void) {
    size_t count = 0;
    const char *parent = getenv("TMPDIR");
    DIR *files = opendir(parent);
    for (const struct dirent *e; (e = readdir(files));)
        count += strncmp(e->d_name, "ptie-bench", 10) == 0;
    closedir(files);
    return count;
}

/* Every group, as short as it gets; what it announces is what comes. */
static void groups_give_what_they_announce(void **state) {
    watch *w = *state;
    for (int32_t g = 0; ptie_bench_group(g); g++) {
        /* A batch of 32 with scalar kernels takes minutes. */
        if (w->engine.level == PTIE_CPU_SCALAR && strcmp(ptie_bench_group(g), "training") == 0)
            continue;
        const ptie_bench_params params = {.groups = ptie_bench_group(g), .seconds = 1e-4};
        ptie_bench_result *results;
        size_t count;
        w->stop_at = UINT64_MAX;
        assert_ok(ptie_bench_groups(&w->engine, &params, &results, &count,
                                    (ptie_progress){on_progress, w}));
        assert_int_equal(w->done, count);
        assert_int_equal(w->total, count);
        for (size_t i = 0; i < count; i++) {
            assert_string_equal(results[i].group, ptie_bench_group(g));
            check_result(&results[i]);
        }
        ptie_bench_free(results);
    }
    assert_int_equal(folders_left(), 0);
}

static void lists_of_groups(void **state) {
    watch *w = *state;
    ptie_bench_result *results;
    size_t count;
    const ptie_progress stop = {on_progress, w};
    w->stop_at = 0;
    assert_fails(ptie_bench_groups(&w->engine,
                                   &(ptie_bench_params){.groups = "peak,family", .seconds = 1e-4},
                                   &results, &count, stop),
                 PTIE_ECANCELLED, "");
    assert_null(results);
    assert_int_equal(w->total, 3 + ptie_bench_family_count(&w->engine));
    assert_fails(ptie_bench_groups(&w->engine,
                                   &(ptie_bench_params){.groups = "peak,kernel", .seconds = 1e-4},
                                   &results, &count, stop),
                 PTIE_ENAME, "did you mean 'kernels'?");
    assert_fails(ptie_bench_groups(&w->engine, &(ptie_bench_params){.groups = "", .seconds = 1e-4},
                                   &results, &count, stop),
                 PTIE_ENAME, "unknown group ''");
}

static void arguments_are_checked(void **state) {
    (void)state;
    ptie_ctx *ctx;
    ptie_bench_params params;
    ptie_bench_result *results;
    size_t count;
    ptie_bench_params_init(&params);
    params.seconds = 0;
    assert_ok(ptie_ctx_create(&ctx, NULL));
    assert_fails(ptie_bench_run(ctx, &params, &results, &count, (ptie_progress){0}), PTIE_EINVAL,
                 "seconds");
    assert_fails(ptie_bench_run(NULL, NULL, &results, &count, (ptie_progress){0}), PTIE_EINVAL,
                 "ctx");
    assert_fails(ptie_bench_run(ctx, NULL, NULL, &count, (ptie_progress){0}), PTIE_EINVAL,
                 "results");
    assert_fails(ptie_bench_run(ctx, NULL, &results, NULL, (ptie_progress){0}), PTIE_EINVAL,
                 "count");
    ptie_bench_free(NULL);
    ptie_ctx_free(ctx);
}

static void machine_is_described(void **state) {
    (void)state;
    ptie_machine machine;
    ptie_machine_describe(&machine);
    assert_int_equal(machine.struct_size, sizeof machine);
    assert_true(machine.processor[0] && machine.compiler[0] && machine.commit[0]);
    assert_string_equal(ptie_level_name(0), "scalar");
    assert_null(ptie_level_name(-1));
    assert_null(ptie_level_name((int32_t)ptie_cpu_detect() + 1));
    assert_non_null(ptie_kernel_name(0));
    assert_null(ptie_kernel_name(-1));
}

static int start(void **state) {
    static watch w;
    *state = &w;
    setenv("TMPDIR", support_temporary("."), 1);
    return ptie_engine_start(&w.engine, 2, "auto") != PTIE_OK;
}

static int stop(void **state) {
    watch *w = *state;
    ptie_engine_stop(&w->engine);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spread_is_middle_and_ends),
        cmocka_unit_test(every_kernel_is_measured),
        cmocka_unit_test(operations_are_those_of_the_paper),
        cmocka_unit_test(groups_give_what_they_announce),
        cmocka_unit_test(lists_of_groups),
        cmocka_unit_test(arguments_are_checked),
        cmocka_unit_test(machine_is_described),
    };
    return cmocka_run_group_tests_name("bench", tests, start, stop);
}
