/* SPDX-License-Identifier: BSD-3-Clause */
/* Stopping and going on: the same bits whatever interrupts a run, and clean errors when it cannot
 * go on. */
#include "support/files.h"
#include "train/tiny.h"

#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/random.h"
#include "io/safetensors.h"

static const ptie_progress silent = {0};

static const char *side_file(const char *path, const char *suffix) {
    static char names[4][1100];
    static int next;
    char *name = names[next++ % 4];
    snprintf(name, sizeof names[0], "%s%s", path, suffix);
    return name;
}

static void assert_same_file(const char *path, const char *expected_path) {
    size_t bytes, expected_bytes;
    unsigned char *data = support_read(path, &bytes);
    unsigned char *expected = support_read(expected_path, &expected_bytes);
    assert_int_equal(bytes, expected_bytes);
    assert_memory_equal(data, expected, bytes);
    free(data);
    free(expected);
}

static size_t tensor_bytes(const ptie_tensor_view *tensor) {
    size_t count = sizeof(float);
    for (int32_t i = 0; i < tensor->rank; i++) count *= (size_t)tensor->shape[i];
    return count;
}

/* Weights, running statistics and moments; the notes differ in seconds. */
static void assert_same_tensors(const char *path, const char *expected_path) {
    ptie_safetensors *found, *expected;
    assert_ok(ptie_safetensors_read(&found, path));
    assert_ok(ptie_safetensors_read(&expected, expected_path));
    assert_int_equal(ptie_safetensors_count(found), ptie_safetensors_count(expected));
    for (size_t i = 0; i < ptie_safetensors_count(expected); i++) {
        const ptie_tensor_view *tensor = ptie_safetensors_tensor(expected, i);
        const ptie_tensor_view *other = ptie_safetensors_find(found, tensor->name);
        assert_non_null(other);
        assert_int_equal(tensor_bytes(other), tensor_bytes(tensor));
        assert_memory_equal(other->data, tensor->data, tensor_bytes(tensor));
    }
    ptie_safetensors_free(found);
    ptie_safetensors_free(expected);
}

static void assert_same_history(const char *path, const char *expected_path) {
    ptie_epoch *rows, *expected;
    size_t count, expected_count;
    assert_ok(ptie_history_read(&rows, &count, path));
    assert_ok(ptie_history_read(&expected, &expected_count, expected_path));
    assert_int_equal(count, expected_count);
    for (size_t i = 0; i < count; i++) {
        rows[i].seconds = expected[i].seconds; /* all that may differ */
        assert_memory_equal(&rows[i], &expected[i], sizeof rows[i]);
    }
    ptie_history_free(rows);
    ptie_history_free(expected);
}

static void assert_same_run(const char *path, const char *expected_path) {
    assert_same_file(path, expected_path);
    assert_same_tensors(side_file(path, ".last"), side_file(expected_path, ".last"));
    assert_same_history(path, expected_path);
}

static ptie_train_params params_with(uint64_t steps_limit, bool resume) {
    ptie_train_params params = tiny_params();
    params.steps_limit = steps_limit;
    params.resume = resume;
    return params;
}

static void train_steps(const char *path, int32_t threads, uint64_t steps_limit, bool resume) {
    const ptie_train_params params = params_with(steps_limit, resume);
    assert_ok(tiny_train(path, threads, &params, silent));
}

/* 6 steps an epoch: 10 and 20 lie within one, 6 and 12 are ends. */
static void twenty_steps_are_ten_and_ten(void **state) {
    (void)state;
    const char *whole = support_temporary("whole");
    train_steps(whole, 1, 20, false);
    for (uint64_t first = 1; first < 20; first += first == 10 ? 2 : 1) {
        const char *parts = support_temporary("parts");
        train_steps(parts, 1, first, false);
        train_steps(parts, 1, 20, true);
        assert_same_run(parts, whole);
        for (int i = 0; i < 4; i++) {
            static const char *const suffixes[] = {"", ".last", ".history.csv", ".history.json"};
            assert_int_equal(remove(side_file(parts, suffixes[i])), 0);
        }
    }
}

static void threads_do_not_change_a_bit(void **state) {
    (void)state;
    const char *one = support_temporary("one");
    train_steps(one, 1, 0, false);
    for (int32_t threads = 2; threads <= 3; threads++) {
        const char *more = support_temporary(threads == 2 ? "two" : "three");
        train_steps(more, threads, 0, false);
        assert_same_run(more, one);
    }
}

/* Goes on at `path` with samples of a data set file; `edit`, or NULL, changes the file first. */
static ptie_status resume_from_file(const char *path, const char *file, const char *edit) {
    ptie_ctx *ctx = tiny_context(2);
    ptie_preset *preset = tiny_preset(TINY_SIDE, "3 % .. 10 %");
    ptie_model *model = tiny_model();
    ptie_dataset *dataset;
    const ptie_train_params params = params_with(0, true);
    assert_ok(ptie_dataset_write(ctx, file, preset, 1, TINY_SAMPLES, false, silent));
    if (edit) support_python(edit, file);
    assert_ok(ptie_dataset_open(&dataset, file));
    const ptie_status status = ptie_train(ctx, model, dataset, path, &params, silent);
    ptie_dataset_free(dataset);
    ptie_model_free(model);
    ptie_preset_free(preset);
    ptie_ctx_free(ctx);
    return status;
}

/* A finished run resumes to nothing; a data set file goes on where its preset stopped. */
static void a_file_continues_what_its_preset_began(void **state) {
    (void)state;
    const char *whole = support_temporary("drawn"), *path = support_temporary("mixed");
    train_steps(whole, 1, 0, false);
    train_steps(whole, 1, 0, true);
    train_steps(path, 1, 9, false);
    assert_ok(resume_from_file(path, support_temporary("samples.h5"), NULL));
    assert_same_run(path, whole);
}

static void assert_note(const char *path, const char *key, const char *expected) {
    ptie_model *model;
    assert_ok(ptie_model_load(&model, path));
    assert_non_null(ptie_model_note(model, key));
    assert_string_equal(ptie_model_note(model, key), expected);
    ptie_model_free(model);
}

static ptie_status train_with_kernels(const char *path, const char *cpu, uint64_t steps_limit) {
    ptie_ctx *ctx;
    ptie_ctx_params c;
    ptie_ctx_params_init(&c);
    c.cpu = cpu;
    assert_ok(ptie_ctx_create(&ctx, &c));
    const ptie_train_params params = params_with(steps_limit, support_exists(path));
    return tiny_train_with(ctx, path, &params, silent);
}

static void kernels_and_generator_are_noted(void **state) {
    (void)state;
    char path[256], both[64];
    ptie_ctx *ctx = tiny_context(1);
    const char *best = ptie_ctx_cpu(ctx);
    snprintf(path, sizeof path, "%s", support_temporary("kernels"));
    assert_ok(train_with_kernels(path, best, 6));
    assert_note(path, "ptie.kernels", best);
    assert_note(path, "ptie.generator", "1");
    assert_int_equal(PTIE_GENERATOR, 1);
    assert_ok(train_with_kernels(path, best, 7));
    assert_note(side_file(path, ".last"), "ptie.kernels", best);
    snprintf(both, sizeof both, strcmp(best, "scalar") ? "%s, scalar" : "%s", best);
    for (uint64_t steps = 8; steps <= 9; steps++) {
        assert_ok(train_with_kernels(path, "scalar", steps));
        assert_note(side_file(path, ".last"), "ptie.kernels", both);
    }
    ptie_ctx_free(ctx);
}

/* As a data set file of a later revision would. */
static void samples_of_another_generator_are_other_samples(void **state) {
    (void)state;
    char path[256];
    snprintf(path, sizeof path, "%s", support_temporary("generator"));
    train_steps(path, 1, 6, false);
    assert_fails(resume_from_file(path, support_temporary("generator.h5"),
                                  "import h5py, sys\n"
                                  "h5py.File(sys.argv[1], 'a').attrs['generator'] = 7\n"),
                 PTIE_EINVAL, "expected 'generator = 1', found 'generator = 7'");
}

static int stop_at_report(void *user, uint64_t done, uint64_t total, const char *note) {
    assert_true(done <= total);
    assert_non_null(note);
    return --*(int *)user == 0;
}

/* Seven reports an epoch after its steps and end, and one in validation. */
static void cancelling_anywhere_leaves_a_state_to_go_on_from(void **state) {
    (void)state;
    const char *whole = support_temporary("uncancelled"), *path = support_temporary("cancelled");
    train_steps(whole, 1, 0, false);
    int reports = 0, cancelled = 0;
    for (bool finished = false; !finished;) {
        int left = 3;
        const ptie_train_params params = params_with(0, reports++ > 0);
        ptie_status status = tiny_train(path, 1, &params, (ptie_progress){stop_at_report, &left});
        assert_true(status == PTIE_OK || status == PTIE_ECANCELLED);
        finished = status == PTIE_OK;
        cancelled += status == PTIE_ECANCELLED;
    }
    assert_true(cancelled >= 8);
    assert_same_run(path, whole);
}

static double now_s(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* Goes on from the last state, or begins. */
static ptie_status go_on(const char *path) {
    ptie_train_params params = params_with(0, support_exists(side_file(path, ".last")));
    params.overwrite = true; /* killed between the best model and the first state */
    params.checkpoint_steps = 1;
    return tiny_train(path, 2, &params, silent);
}

/* Trains in a child that is killed after `life_s`; true if it had finished before. */
static bool train_and_kill(const char *path, double life_s) {
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) _exit(go_on(path) == PTIE_OK ? 0 : 1);
    usleep((useconds_t)(1e6 * life_s));
    kill(child, SIGKILL);
    int result;
    assert_int_equal(waitpid(child, &result, 0), child);
    if (WIFSIGNALED(result)) return false;
    assert_int_equal(WEXITSTATUS(result), 0); /* it could always go on */
    return true;
}

static void kill_9_at_any_moment_loses_nothing(void **state) {
    (void)state;
    const char *whole = support_temporary("unkilled"), *path = support_temporary("killed");
    const double start_s = now_s();
    train_steps(whole, 2, 0, false);
    const double whole_s = now_s() - start_s;
    ptie_random random;
    ptie_random_init(&random, (uint64_t)getpid(), 0,
                     0); /* other moments in every run of the test */
    int kills = 0;
    while (kills < 12 && !train_and_kill(path, ptie_random_uniform(&random, 0, whole_s / 3)))
        kills++;
    print_message("# killed %d times\n", kills);
    assert_true(kills > 0);
    if (kills == 12) assert_ok(go_on(path));
    assert_same_run(path, whole);
}

static void resume_fails(const char *path, ptie_status status, const char *fragment) {
    const ptie_train_params params = params_with(0, true);
    assert_fails(tiny_train(path, 1, &params, silent), status, fragment);
}

static void other_settings_are_named(void **state) {
    (void)state;
    const char *path = support_temporary("settings");
    train_steps(path, 1, 3, false);
    ptie_train_params params = params_with(0, true);
    params.batch = 5;
    assert_fails(tiny_train(path, 1, &params, silent), PTIE_EINVAL,
                 "expected 'batch = 4', found 'batch = 5'");
    params = params_with(0, true);
    params.seed = 10;
    assert_fails(tiny_train(path, 1, &params, silent), PTIE_EINVAL,
                 "expected 'seed = 9', found 'seed = 10'");
    params = params_with(0, true);
    params.patience = 1; /* may change */
    params.steps_limit = 4;
    assert_ok(tiny_train(path, 1, &params, silent));

    ptie_ctx *ctx = tiny_context(1);
    ptie_preset *preset = tiny_preset(TINY_SIDE, "4 % .. 10 %");
    ptie_model *model = tiny_model();
    ptie_dataset *dataset;
    assert_ok(ptie_dataset_from_preset(&dataset, preset, 1, TINY_SAMPLES));
    assert_fails(ptie_train(ctx, model, dataset, path, &params, silent), PTIE_EINVAL,
                 "found 'noise = 0.04");
    ptie_model_free(model);
    ptie_model_params shape;
    ptie_model_params_init(&shape);
    assert_ok(ptie_model_create(&model, &shape));
    assert_fails(ptie_train(ctx, model, dataset, path, &params, silent), PTIE_EINVAL,
                 "found 'ptie.arch = ");
    ptie_model_free(model);
    ptie_dataset_free(dataset);
    ptie_preset_free(preset);
    ptie_ctx_free(ctx);
    resume_fails(support_temporary("never"), PTIE_EIO, "never.last");
}

static void a_damaged_state_is_refused_and_kept(void **state) {
    (void)state;
    const char *path = support_temporary("damaged");
    char last[1100];
    snprintf(last, sizeof last, "%s.last", path);
    train_steps(path, 1, 3, false);
    size_t bytes, kept_bytes;
    unsigned char *data = support_read(last, &bytes);
    for (size_t length = 0; length < bytes; length += 1 + bytes / 40) {
        support_write(last, data, length);
        resume_fails(path, PTIE_EFORMAT, "damaged.last");
        free(support_read(last, &kept_bytes));
        assert_int_equal(kept_bytes, length);
        support_assert_nothing_left(path);
    }
    free(data);
}

/* Rewrites a state without tensor `drop`, and with note `key` set to `value` (NULL: without the
 * note). */
static void rewrite(const char *last, const char *drop, const char *key, const char *value) {
    enum { MOST = 256 };
    ptie_safetensors *file;
    ptie_tensor_view tensors[MOST];
    ptie_note changed[MOST];
    const ptie_note *notes;
    size_t tensor_count = 0, note_count = 0;
    assert_ok(ptie_safetensors_read(&file, last));
    assert_true(ptie_safetensors_count(file) < MOST);
    for (size_t i = 0; i < ptie_safetensors_count(file); i++) {
        const ptie_tensor_view *tensor = ptie_safetensors_tensor(file, i);
        if (!drop || strcmp(tensor->name, drop) != 0) tensors[tensor_count++] = *tensor;
    }
    const size_t all_notes = ptie_safetensors_notes(file, &notes);
    for (size_t i = 0; i < all_notes; i++) {
        const bool hit = key && strcmp(notes[i].key, key) == 0;
        if (!hit) changed[note_count++] = notes[i];
        if (hit && value) changed[note_count++] = (ptie_note){key, value};
    }
    assert_true(tensor_count < ptie_safetensors_count(file) || key);
    assert_ok(ptie_safetensors_write(last, tensors, tensor_count, changed, note_count, true));
    ptie_safetensors_free(file);
}

static void a_state_that_contradicts_itself_is_refused(void **state) {
    (void)state;
    static const struct {
        const char *drop, *key, *value;
        ptie_status status;
        const char *fragment;
    } cases[] = {
        {"opt.m.out.weight", NULL, NULL, PTIE_EFORMAT, "opt.m.out.weight"},
        {"out.weight", NULL, NULL, PTIE_ESIZE, "out.weight"},
        {NULL, "ptie.train.position", NULL, PTIE_EFORMAT, "not a training checkpoint"},
        {NULL, "ptie.train.position", "3 12", PTIE_EFORMAT, "expected 7 numbers"},
        {NULL, "ptie.train.position", "4 12 1 1 1 1 1", PTIE_EFORMAT, "step 4 does not fit"},
        {NULL, "ptie.train.position", "30 12 1 1 1 1 1", PTIE_EFORMAT, "step 30 does not fit"},
        {NULL, "ptie.train.history", "epoch\n1\n", PTIE_EFORMAT, "unknown columns"},
        {NULL, "ptie.train.settings", NULL, PTIE_EFORMAT, "not a training checkpoint"},
    };
    const char *path = support_temporary("altered");
    char last[1100];
    snprintf(last, sizeof last, "%s.last", path);
    train_steps(path, 1, 3, false);
    size_t bytes;
    unsigned char *data = support_read(last, &bytes);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        support_write(last, data, bytes);
        rewrite(last, cases[i].drop, cases[i].key, cases[i].value);
        resume_fails(path, cases[i].status, cases[i].fragment);
    }
    free(data);
}

static void a_time_limit_stops_with_a_state(void **state) {
    (void)state;
    const char *whole = support_temporary("unlimited"), *path = support_temporary("limited");
    train_steps(whole, 1, 0, false);
    ptie_train_params params = params_with(0, false);
    params.time_limit_s = 1e-9;
    assert_ok(tiny_train(path, 1, &params, silent));
    assert_true(support_exists(side_file(path, ".last")));
    assert_false(support_exists(path));
    ptie_epoch *epochs;
    size_t count;
    assert_ok(ptie_history_read(&epochs, &count, path)); /* no epoch is complete, and it says so */
    assert_int_equal(count, 0);
    ptie_history_free(epochs);
    train_steps(path, 1, 0, true);
    assert_same_run(path, whole);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(twenty_steps_are_ten_and_ten),
        cmocka_unit_test(threads_do_not_change_a_bit),
        cmocka_unit_test(a_file_continues_what_its_preset_began),
        cmocka_unit_test(kernels_and_generator_are_noted),
        cmocka_unit_test(samples_of_another_generator_are_other_samples),
        cmocka_unit_test(cancelling_anywhere_leaves_a_state_to_go_on_from),
        cmocka_unit_test(kill_9_at_any_moment_loses_nothing),
        cmocka_unit_test(other_settings_are_named),
        cmocka_unit_test(a_damaged_state_is_refused_and_kept),
        cmocka_unit_test(a_state_that_contradicts_itself_is_refused),
        cmocka_unit_test(a_time_limit_stops_with_a_state),
    };
    return cmocka_run_group_tests_name("train/resume", tests, NULL, NULL);
}
