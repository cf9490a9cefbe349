/* SPDX-License-Identifier: BSD-3-Clause */
/* Data set files: what is written, by how many threads, what is read, and what is refused. */
#include "support/files.h"
#include "train/tiny.h"

#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "train/dataset.h"

enum { SIDE = 32, PIXELS = SIDE * SIDE, COUNT = 70 }; /* more than one block */

static const ptie_progress silent = {0};

static void write_dataset(const char *path, int32_t threads, uint64_t count) {
    ptie_preset *preset = tiny_preset(SIDE, "2 % .. 12 %");
    ptie_ctx *ctx = tiny_context(threads);
    assert_ok(ptie_dataset_write(ctx, path, preset, 5, count, false, silent));
    ptie_ctx_free(ctx);
    ptie_preset_free(preset);
}

/* For the tests in which neither size nor threads matter. */
static ptie_ctx *shared_ctx;
static ptie_preset *shared_preset;

static int make_shared(void **state) {
    (void)state;
    shared_ctx = tiny_context(1);
    shared_preset = tiny_preset(16, "2 %");
    return 0;
}

static int free_shared(void **state) {
    (void)state;
    ptie_ctx_free(shared_ctx);
    ptie_preset_free(shared_preset);
    return 0;
}

static void splits_are_80_10_10_by_index(void **state) {
    (void)state;
    static const uint64_t cases[][4] = {/* count, train, validation, test */
                                        {25000, 20000, 2500, 2500},
                                        {1000, 800, 100, 100},
                                        {19, 17, 1, 1},
                                        {10, 8, 1, 1},
                                        {3, 1, 1, 1},
                                        {2, 2, 0, 0},
                                        {1, 1, 0, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        uint64_t next = 0;
        for (int split = 0; split < 3; split++) {
            const ptie_span span = ptie_split_span(cases[i][0], (ptie_split)split);
            assert_int_equal(span.first, next);
            assert_int_equal(span.count, cases[i][1 + split]);
            next += span.count;
        }
        assert_int_equal(next, cases[i][0]);
        assert_int_equal(ptie_split_span(cases[i][0], PTIE_ALL).count, cases[i][0]);
    }
}

static void assert_same_bytes(const char *path, const char *other_path) {
    size_t bytes, other_bytes;
    unsigned char *data = support_read(path, &bytes), *other = support_read(other_path, &other_bytes);
    assert_int_equal(other_bytes, bytes);
    assert_memory_equal(other, data, bytes);
    free(other);
    free(data);
}

static void bytes_do_not_depend_on_threads(void **state) {
    (void)state;
    const char *path = support_temporary("one.h5");
    write_dataset(path, 1, COUNT);
    for (int32_t threads = 2; threads <= 3; threads++) {
        const char *other_path = support_temporary(threads == 2 ? "two.h5" : "three.h5");
        write_dataset(other_path, threads, COUNT);
        assert_same_bytes(other_path, path);
    }
}

static void a_file_reads_as_the_preset_draws(void **state) {
    (void)state;
    static float from_file[2][PIXELS], drawn[2][PIXELS];
    static const struct {
        ptie_split split;
        uint64_t index, sample;
    } cases[] = {{PTIE_TRAIN, 0, 0},       {PTIE_TRAIN, 55, 55}, {PTIE_VALIDATION, 0, 56},
                 {PTIE_VALIDATION, 6, 62}, {PTIE_TEST, 0, 63},   {PTIE_TEST, 6, 69},
                 {PTIE_ALL, 69, 69}};
    const char *path = support_temporary("read.h5");
    write_dataset(path, 2, COUNT);
    ptie_preset *preset = tiny_preset(SIDE, "2 % .. 12 %");
    ptie_dataset *file, *live;
    assert_ok(ptie_dataset_open(&file, path));
    assert_ok(ptie_dataset_from_preset(&live, preset, 5, COUNT));
    int32_t width, height;
    ptie_dataset_size(file, &width, &height);
    assert_int_equal(width, SIDE);
    assert_int_equal(height, SIDE);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ptie_sample_info info[3];
        const ptie_split split = cases[i].split;
        assert_ok(
            ptie_dataset_read(file, split, cases[i].index, from_file[0], from_file[1], &info[0]));
        assert_ok(ptie_dataset_read(live, split, cases[i].index, drawn[0], drawn[1], &info[1]));
        assert_memory_equal(from_file, drawn, sizeof drawn);
        assert_memory_equal(&info[0], &info[1], sizeof info[0]);
        assert_ok(ptie_preset_sample(preset, 5, cases[i].sample, drawn[0], drawn[1], &info[2]));
        assert_memory_equal(from_file, drawn, sizeof drawn);
        assert_memory_equal(&info[0], &info[2], sizeof info[0]);
    }
    assert_fails(ptie_dataset_read(file, PTIE_TEST, 7, drawn[0], drawn[1], NULL), PTIE_EINVAL,
                 "expected below 7, found 7");
    ptie_dataset_free(file);
    ptie_dataset_free(live);
    ptie_preset_free(preset);
}

static void h5py_reads_the_file(void **state) {
    (void)state;
    static const char program[] =
        "import sys, h5py, numpy as np\n"
        "f = h5py.File(sys.argv[1])\n"
        "assert f['clean'].shape == f['noisy'].shape == (70, 32, 32), f['clean'].shape\n"
        "assert f['clean'].dtype == f['noisy'].dtype == np.float32\n"
        "for name in 'clean_offset_rad clean_scale_rad noisy_offset_rad noisy_scale_rad "
        "sigma'.split():\n"
        "    assert f[name].shape == (70,) and f[name].dtype == np.float32, name\n"
        "assert f['morphologies'].dtype == np.uint32 and (f['morphologies'][:] > 0).all()\n"
        "assert f.attrs['seed'] == 5 and f.attrs['count'] == 70\n"
        "text = lambda v: v.decode() if isinstance(v, bytes) else str(v)\n"
        "assert '[optics]' in text(f.attrs['preset']) and text(f.attrs['version'])\n"
        "assert [text(s) for s in f.attrs['split']] == ['train 0:56', 'validation 56:63', 'test "
        "63:70']\n"
        "clean, noisy = f['clean'][:], f['noisy'][:]\n"
        "assert clean.min() == 0 and clean.max() == 1 and noisy.min() == 0 and noisy.max() == 1\n"
        "sigma = f['sigma'][:]\n"
        "assert 0.02 <= sigma.min() < sigma.max() <= 0.12\n"
        "rad = f['noisy_offset_rad'][:] + f['noisy_scale_rad'][:] * noisy.mean((1, 2), "
        "dtype=float)\n"
        "assert abs(rad).max() < 1e-6, abs(rad).max() # zero mean, rounded\n";
    const char *path = support_temporary("h5py.h5");
    write_dataset(path, 1, COUNT);
    support_python(program, path);
}

/* Stops after `limit` reports. */
static int stop_after(void *user, uint64_t done, uint64_t total, const char *note) {
    (void)note;
    assert_true(done <= total);
    return --*(int *)user <= 0;
}

/* SIGKILL while the file grows: what stands under its name, if anything, is whole, and the next
   attempt succeeds. */
static void kill_9_leaves_no_half_file(void **state) {
    (void)state;
    const char *path = support_temporary("killed.h5"), *whole = support_temporary("whole.h5");
    write_dataset(whole, 1, COUNT);
    for (useconds_t life_us = 500; life_us < 60000; life_us *= 2) {
        const pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0) {
            write_dataset(path, 1, COUNT);
            _exit(0);
        }
        usleep(life_us);
        kill(child, SIGKILL);
        int result;
        assert_int_equal(waitpid(child, &result, 0), child);
        if (support_exists(path)) assert_same_bytes(path, whole);
        remove(path);
    }
    write_dataset(path, 1, COUNT);
    assert_same_bytes(path, whole);
}

static void cancelling_leaves_no_file(void **state) {
    (void)state;
    const char *path = support_temporary("cancelled.h5");
    int limit = 1;
    const ptie_progress stopping = {stop_after, &limit};
    assert_fails(ptie_dataset_write(shared_ctx, path, shared_preset, 5, COUNT, false, stopping),
                 PTIE_ECANCELLED, "cancelled after 32 of 70");
    support_assert_nothing_left(path);
}

static ptie_status write_shared(const char *path, uint64_t seed, uint64_t count, bool overwrite) {
    return ptie_dataset_write(shared_ctx, path, shared_preset, seed, count, overwrite, silent);
}

static ptie_status write_three(const char *path) {
    return write_shared(path, 5, 3, true);
}

static void a_full_disk_leaves_no_file(void **state) {
    (void)state;
    support_check_full_disk(support_temporary("full.h5"), write_three);
}

static void an_existing_file_is_kept_unless_overwritten(void **state) {
    (void)state;
    const char *path = support_temporary("kept.h5");
    support_write(path, "mine", 4);
    assert_fails(write_shared(path, 5, 3, false), PTIE_EEXIST, "kept.h5");
    size_t bytes;
    unsigned char *data = support_read(path, &bytes);
    assert_int_equal(bytes, 4);
    free(data);
    assert_ok(write_shared(path, 5, 3, true));
    ptie_dataset *dataset;
    assert_ok(ptie_dataset_open(&dataset, path));
    assert_int_equal(ptie_dataset_count(dataset, PTIE_ALL), 3);
    ptie_dataset_free(dataset);
    assert_fails(write_shared("/tmp", 5, 3, true), PTIE_EIO, "/tmp");
    assert_fails(write_shared("/absent/x.h5", 5, 3, true), PTIE_EIO, "/absent");
    assert_fails(write_shared(path, 5, 0, true), PTIE_EINVAL, "count");
    assert_fails(write_shared(path, UINT64_MAX, 3, true), PTIE_EINVAL, "seed");
}

static ptie_status open_file(const char *path) {
    ptie_dataset *dataset;
    ptie_status status = ptie_dataset_open(&dataset, path);
    ptie_dataset_free(dataset);
    return status;
}

static void truncated_files_are_refused(void **state) {
    (void)state;
    const char *path = support_temporary("whole.h5");
    assert_ok(write_three(path));
    support_check_truncations(path, open_file, 0);
}

/* Writes /clean of `clean` and /noisy of `noisy` dimensions, and attributes. */
static void write_foreign(const char *path, int32_t rank, const uint64_t clean[3],
                          const uint64_t noisy[3], bool columns, int64_t count) {
    ptie_h5 *h5;
    assert_ok(ptie_h5_create(&h5, path, true));
    assert_ok(ptie_h5_dataset(h5, "/clean", PTIE_H5_F32, rank, clean, 0));
    assert_ok(ptie_h5_dataset(h5, "/noisy", PTIE_H5_F32, rank, noisy, 0));
    for (int i = 0; columns && i < PTIE_INFO_COLUMNS; i++)
        assert_ok(ptie_h5_dataset(h5, ptie_info_columns[i].path, PTIE_H5_F32, 1, clean, 0));
    assert_ok(ptie_h5_set_text(h5, "/", "preset", ""));
    assert_ok(ptie_h5_set_integer(h5, "/", "seed", 0));
    if (count >= 0) assert_ok(ptie_h5_set_integer(h5, "/", "count", count));
    assert_ok(ptie_h5_close(h5));
}

static void refuse_foreign(ptie_status status, const char *fragment, int32_t rank,
                           const uint64_t clean[3], const uint64_t noisy[3], bool columns,
                           int64_t count) {
    const char *path = support_temporary("foreign.h5");
    ptie_dataset *dataset;
    write_foreign(path, rank, clean, noisy, columns, count);
    assert_fails(ptie_dataset_open(&dataset, path), status, fragment);
    assert_null(dataset);
}

static void files_of_another_shape_are_refused(void **state) {
    (void)state;
    static const uint64_t good[3] = {4, 16, 16}, wide[3] = {4, 16, 17}, fewer[3] = {3, 16, 16};
    const char *path = support_temporary("foreign.h5");
    ptie_dataset *dataset;
    write_foreign(path, 3, good, good, true, 4);
    assert_ok(ptie_dataset_open(&dataset, path));
    ptie_dataset_free(dataset);
    refuse_foreign(PTIE_EFORMAT, "/clean: expected 3 dimensions [N, H, W], found 2", 2, good, good,
                   true, 4);
    refuse_foreign(PTIE_EFORMAT, "/noisy: shape", 3, good, wide, true, 4);
    refuse_foreign(PTIE_EFORMAT, "/noisy: shape", 3, good, fewer, true, 4);
    refuse_foreign(PTIE_EFORMAT, "clean_offset_rad", 3, good, good, false, 4);
    refuse_foreign(PTIE_EFORMAT, "expected 4, found 5", 3, good, good, true, 5);
    refuse_foreign(PTIE_EFORMAT, "count", 3, good, good, true, -1);
    support_write(path, "no HDF5 at all", 14);
    assert_fails(ptie_dataset_open(&dataset, path), PTIE_EFORMAT, "foreign.h5");
    assert_fails(ptie_dataset_open(&dataset, "/tmp"), PTIE_EIO, "/tmp");
    assert_fails(ptie_dataset_open(&dataset, "/absent.h5"), PTIE_EIO, "/absent.h5");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(splits_are_80_10_10_by_index),
        cmocka_unit_test(bytes_do_not_depend_on_threads),
        cmocka_unit_test(a_file_reads_as_the_preset_draws),
        cmocka_unit_test(h5py_reads_the_file),
        cmocka_unit_test(kill_9_leaves_no_half_file),
        cmocka_unit_test(cancelling_leaves_no_file),
        cmocka_unit_test(a_full_disk_leaves_no_file),
        cmocka_unit_test(an_existing_file_is_kept_unless_overwritten),
        cmocka_unit_test(truncated_files_are_refused),
        cmocka_unit_test(files_of_another_shape_are_refused),
    };
    return cmocka_run_group_tests_name("train/dataset", tests, make_shared, free_shared);
}
