/* SPDX-License-Identifier: BSD-3-Clause */
/* Learning rate, order of samples, history files. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include <jansson.h>

#include "train/history.h"
#include "train/train.h"

static ptie_train_params defaults(void) {
    ptie_train_params params;
    ptie_train_params_init(&params);
    return params;
}

static void the_cosine_ends_where_the_paper_says(void **state) {
    (void)state;
    const ptie_train_params params = defaults();
    /* Printed in the paper as 1.85e-6 for the last of 20 epochs. */
    assert_near(ptie_learning_rate(&params, 625, 19 * 625), 1.85e-6, 0.005e-6);
    assert_near(ptie_learning_rate(&params, 625, 20 * 625 - 1), 1.85e-6, 0.005e-6);
    assert_near(ptie_learning_rate(&params, 625, 10 * 625), 1.5e-4, 1e-18);
}

static void an_epoch_has_one_rate_after_the_warm_up(void **state) {
    (void)state;
    const ptie_train_params params = defaults();
    for (uint64_t epoch = 1; epoch < 20; epoch++) {
        const double rate = ptie_learning_rate(&params, 625, epoch * 625);
        assert_near(ptie_learning_rate(&params, 625, epoch * 625 + 624), rate, 0);
        assert_true(rate < ptie_learning_rate(&params, 625, epoch * 625 - 1));
    }
}

static void the_warm_up_rises_linearly_and_ends_without_a_jump(void **state) {
    (void)state;
    ptie_train_params params = defaults();
    for (uint64_t step = 0; step < 625; step++)
        assert_near(ptie_learning_rate(&params, 625, step), 3e-4 * (double)(step + 1) / 625, 1e-18);
    /* In the middle of an epoch, where the cosine stands still: 1.5 epochs are 937.5 steps. */
    params.warmup_epochs = 1.5;
    const double full = 3e-4 * 0.5 * (1 + cos(3.14159265358979323846 / 20));
    assert_near(ptie_learning_rate(&params, 625, 936), full * 937 / 937.5, 1e-18);
    assert_near(ptie_learning_rate(&params, 625, 937), full, 1e-18);
    params.warmup_epochs = 0;
    assert_near(ptie_learning_rate(&params, 625, 0), 3e-4, 0);
}

static void an_epochs_order_is_a_permutation_of_its_own(void **state) {
    (void)state;
    enum { COUNT = 1000 };
    uint32_t order[3][COUNT];
    ptie_epoch_order(order[0], COUNT, 7, 0);
    ptie_epoch_order(order[1], COUNT, 7, 1);
    ptie_epoch_order(order[2], COUNT, 8, 0);
    for (int i = 0; i < 3; i++) {
        bool seen[COUNT] = {false};
        uint32_t fixed = 0;
        for (uint32_t j = 0; j < COUNT; j++) {
            assert_true(order[i][j] < COUNT && !seen[order[i][j]]);
            seen[order[i][j]] = true;
            fixed += order[i][j] == j;
        }
        assert_true(fixed <= 6); /* Poisson with mean 1: more than 6 has a chance of 8e-5 */
    }
    uint32_t again[COUNT];
    ptie_epoch_order(again, COUNT, 7, 0);
    assert_memory_equal(again, order[0], sizeof again);
    assert_memory_not_equal(order[1], order[0], sizeof again);
    assert_memory_not_equal(order[2], order[0], sizeof again);
}

enum { ROWS = 3 };

static void fill_rows(ptie_epoch rows[ROWS]) {
    for (int i = 0; i < ROWS; i++)
        rows[i] = (ptie_epoch){
            .epoch = i + 1,
            .learning_rate = 3e-4 / (i + 3),
            .seconds = 1.0 / 3,
            .train =
                {.loss = 0.1 + i, .psnr_db = 20.0 / 3, .mae = 1e-9, .ssim = -0.1, .samples = 20000},
            .validation = {.loss = i == 1 ? 0.1 : 0.2,
                           .psnr_db = (double)INFINITY,
                           .samples = 2500},
        };
}

static void a_history_reads_back_to_the_bit(void **state) {
    (void)state;
    ptie_epoch rows[ROWS], *read;
    size_t count;
    fill_rows(rows);
    const char *path = support_temporary("model");
    assert_ok(ptie_history_write(path, rows, ROWS));
    assert_ok(ptie_history_read(&read, &count, path));
    assert_int_equal(count, ROWS);
    for (int i = 0; i < ROWS; i++) assert_memory_equal(&read[i], &rows[i], sizeof rows[i]);
    ptie_history_free(read);
    assert_int_equal(ptie_history_best(rows, ROWS), 1);
    rows[2].validation.loss = 0.1; /* of equals the first */
    assert_int_equal(ptie_history_best(rows, ROWS), 1);
    assert_int_equal(ptie_history_best(rows, 0), 0);
}

static void the_json_history_has_the_same_numbers(void **state) {
    (void)state;
    ptie_epoch rows[ROWS];
    fill_rows(rows);
    assert_ok(ptie_history_write(support_temporary("model"), rows, ROWS));
    json_t *json = json_load_file(support_temporary("model.history.json"), 0, NULL);
    assert_int_equal(json_array_size(json), ROWS);
    const json_t *row = json_array_get(json, 2);
    assert_int_equal(json_integer_value(json_object_get(row, "epoch")), 3);
    assert_near(json_real_value(json_object_get(row, "train_loss")), 2.1, 0);
    assert_int_equal(json_integer_value(json_object_get(row, "validation_samples")), 2500);
    assert_true(json_is_null(json_object_get(row, "validation_psnr_db")));
    json_decref(json);
}

static void damaged_histories_are_refused(void **state) {
    (void)state;
    ptie_epoch rows[ROWS], *read;
    size_t count, bytes;
    fill_rows(rows);
    const char *path = support_temporary("model"), *cut = support_temporary("cut");
    char name[1100];
    assert_ok(ptie_history_write(path, rows, ROWS));
    snprintf(name, sizeof name, "%s.history.csv", path);
    unsigned char *csv = support_read(name, &bytes);
    snprintf(name, sizeof name, "%s.history.csv", cut);
    size_t whole_rows = 0;
    for (size_t length = 0; length < bytes; length++) {
        support_write(name, csv, length);
        ptie_status status = ptie_history_read(&read, &count, cut);
        if (length > 0 && csv[length - 1] == '\n' && status == PTIE_OK) {
            assert_int_equal(count, whole_rows++);
            ptie_history_free(read);
            continue;
        }
        assert_int_equal(status, PTIE_EFORMAT);
        assert_non_null(strstr(ptie_last_error(), "cut.history.csv:"));
        assert_null(read);
    }
    assert_int_equal(whole_rows, ROWS); /* 0, 1 and 2 rows */
    free(csv);
    assert_fails(ptie_history_read(&read, &count, support_temporary("absent")), PTIE_EIO, "absent");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_cosine_ends_where_the_paper_says),
        cmocka_unit_test(an_epoch_has_one_rate_after_the_warm_up),
        cmocka_unit_test(the_warm_up_rises_linearly_and_ends_without_a_jump),
        cmocka_unit_test(an_epochs_order_is_a_permutation_of_its_own),
        cmocka_unit_test(a_history_reads_back_to_the_bit),
        cmocka_unit_test(the_json_history_has_the_same_numbers),
        cmocka_unit_test(damaged_histories_are_refused),
    };
    return cmocka_run_group_tests_name("train/schedule", tests, NULL, NULL);
}
