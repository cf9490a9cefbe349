/* SPDX-License-Identifier: BSD-3-Clause */
/* HDF5 files: what goes in comes out, the same bytes every time, whole or not at all. */
#include "support/support.h"

#include <stdlib.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/pool.h"
#include "io/h5.h"
#include "support/files.h"

static void write_example(ptie_h5 *h5) {
    float rows[5][3][2];
    for (size_t i = 0; i < 30; i++) ((float *)rows)[i] = (float)i / 4;
    const uint64_t counts[2] = {1ull << 40, 7};
    assert_ok(ptie_h5_dataset(h5, "/entry/data/phase", PTIE_H5_F32, 3, (uint64_t[]){0, 3, 2}, 2));
    assert_ok(ptie_h5_dataset(h5, "/counts", PTIE_H5_U64, 1, (uint64_t[]){2}, 0));
    assert_ok(ptie_h5_write(h5, "/entry/data/phase", PTIE_H5_F32, 0, 2, rows[0]));
    assert_ok(ptie_h5_write(h5, "/entry/data/phase", PTIE_H5_F32, 2, 3, rows[2]));
    assert_ok(ptie_h5_write(h5, "/counts", PTIE_H5_U64, 0, 2, counts));
    assert_ok(ptie_h5_set_text(h5, "/", "preset", "size = 3 µm\nname = paper\n"));
    assert_ok(ptie_h5_set_text(h5, "/", "empty", ""));
    assert_ok(ptie_h5_set_texts(h5, "/entry/data", "axes", (const char *[]){"time", "y", "x"}, 3));
    assert_ok(ptie_h5_set_number(h5, "/entry/data/phase", "scale", 0.1));
    assert_ok(ptie_h5_set_number(h5, "/entry/data/phase", "scale", 0.25)); /* replaces */
    assert_ok(ptie_h5_set_integer(h5, "/made/on/the/way", "seed", -12345678901234));
}

static const char *example(const char *name) {
    const char *path = support_temporary(name);
    ptie_h5 *h5;
    assert_ok(ptie_h5_create(&h5, path, false));
    write_example(h5);
    assert_false(support_exists(path));
    assert_ok(ptie_h5_close(h5));
    return path;
}

static void what_is_written_is_read(void **state) {
    (void)state;
    ptie_h5 *h5;
    int32_t rank;
    uint64_t dims[4], counts[2];
    double number, rows[3][3][2];
    int64_t integer;
    char *text;
    assert_ok(ptie_h5_open(&h5, example("round.h5")));
    assert_ok(ptie_h5_shape(h5, "/entry/data/phase", &rank, dims));
    assert_int_equal(rank, 3);
    assert_int_equal(dims[0], 5);
    assert_int_equal(dims[2], 2);
    assert_true(ptie_h5_exists(h5, "/") && ptie_h5_exists(h5, "/entry/data"));
    assert_false(ptie_h5_exists(h5, "/none/at/all"));
    assert_ok(ptie_h5_read(h5, "/entry/data/phase", PTIE_H5_F64, 1, 3, rows)); /* HDF5 converts */
    for (size_t i = 0; i < 18; i++) assert_true(((double *)rows)[i] == (double)(i + 6) / 4);
    assert_ok(ptie_h5_read(h5, "/counts", PTIE_H5_U64, 0, 2, counts));
    assert_true(counts[0] == 1ull << 40 && counts[1] == 7);
    assert_ok(ptie_h5_get_text(h5, "/", "preset", &text));
    assert_string_equal(text, "size = 3 µm\nname = paper\n");
    ptie_free(text);
    assert_ok(ptie_h5_get_text(h5, "/", "empty", &text));
    assert_string_equal(text, "");
    ptie_free(text);
    assert_ok(ptie_h5_get_number(h5, "/entry/data/phase", "scale", &number));
    assert_true(number == 0.25);
    assert_ok(ptie_h5_get_integer(h5, "/made/on/the/way", "seed", &integer));
    assert_true(integer == -12345678901234);
    assert_ok(ptie_h5_close(h5));
}

static void what_is_not_there_is_named(void **state) {
    (void)state;
    ptie_h5 *h5;
    uint64_t dims[4];
    float values[6];
    double number;
    int32_t rank;
    char *text;
    assert_ok(ptie_h5_open(&h5, example("absent.h5")));
    assert_fails(ptie_h5_shape(h5, "/none", &rank, dims), PTIE_EFORMAT, "/none");
    assert_fails(ptie_h5_read(h5, "/entry/data/phase", PTIE_H5_F32, 5, 1, values), PTIE_EFORMAT,
                 "expected 6, found 5");
    assert_fails(ptie_h5_read(h5, "/entry", PTIE_H5_F32, 0, 1, values), PTIE_EFORMAT, "/entry");
    assert_fails(ptie_h5_get_text(h5, "/", "none", &text), PTIE_EFORMAT, "no attribute 'none'");
    assert_null(text);
    assert_fails(ptie_h5_get_text(h5, "/made/on/the/way", "seed", &text), PTIE_EFORMAT, "not text");
    assert_fails(ptie_h5_get_number(h5, "/", "preset", &number), PTIE_EFORMAT, "not a number");
    assert_fails(ptie_h5_get_text(h5, "/entry/data", "axes", &text), PTIE_EFORMAT, "a list");
    assert_ok(ptie_h5_close(h5));
    assert_ok(ptie_h5_close(NULL));
    ptie_h5_discard(NULL);
}

static void the_same_content_is_the_same_bytes(void **state) {
    (void)state;
    size_t sizes[2];
    unsigned char *first = support_read(example("first.h5"), &sizes[0]);
    sleep(1); /* a time stamp would differ now */
    unsigned char *second = support_read(example("second.h5"), &sizes[1]);
    assert_int_equal(sizes[0], sizes[1]);
    assert_memory_equal(first, second, sizes[0]);
    free(first);
    free(second);
}

/* Each task writes, reads and checks a file of its own. */
static ptie_status use_own_file(void *context, size_t index, int32_t worker) {
    char path[1100];
    uint32_t rows[64] = {0};
    ptie_h5 *h5;
    (void)worker;
    snprintf(path, sizeof path, "%s%zu.h5", (const char *)context, index);
    PTIE_TRY(ptie_h5_create(&h5, path, false));
    PTIE_TRY(ptie_h5_dataset(h5, "/rows", PTIE_H5_U32, 1, (uint64_t[]){64}, 8));
    for (uint32_t i = 0; i < 64; i++)
        PTIE_TRY(ptie_h5_write(h5, "/rows", PTIE_H5_U32, i, 1, &(uint32_t){(uint32_t)index + i}));
    PTIE_TRY(ptie_h5_close(h5));
    PTIE_TRY(ptie_h5_open(&h5, path));
    PTIE_TRY(ptie_h5_read(h5, "/rows", PTIE_H5_U32, 0, 64, rows));
    for (uint32_t i = 0; i < 64; i++)
        if (rows[i] != index + i)
            return ptie_fail(PTIE_ENUMERIC, "%s: row %u is %u", path, i, rows[i]);
    return ptie_h5_close(h5);
}

static void any_thread_may_call(void **state) {
    (void)state;
    ptie_pool *pool;
    char path[1024];
    snprintf(path, sizeof path, "%s", support_temporary("thread"));
    assert_ok(ptie_pool_create(&pool, 8));
    assert_ok(ptie_pool_run(pool, 32, use_own_file, path));
    ptie_pool_free(pool);
}

static void a_discarded_file_is_gone(void **state) {
    (void)state;
    ptie_h5 *h5;
    const char *path = support_temporary("discarded.h5");
    assert_ok(ptie_h5_create(&h5, path, false));
    write_example(h5);
    ptie_h5_discard(h5);
    support_assert_nothing_left(path);
}

static void an_existing_file_is_kept(void **state) {
    (void)state;
    ptie_h5 *h5;
    const char *path = example("kept.h5");
    assert_fails(ptie_h5_create(&h5, path, false), PTIE_EEXIST, "kept.h5");
    assert_null(h5);
    assert_ok(ptie_h5_create(&h5, path, true));
    ptie_h5_discard(h5);
    assert_true(support_exists(path));
}

static ptie_status write_frames(const char *path) {
    ptie_h5 *h5;
    const float frame[16] = {1};
    PTIE_TRY(ptie_h5_create(&h5, path, true));
    ptie_status status = ptie_h5_dataset(h5, "/a/b", PTIE_H5_F32, 2, (uint64_t[]){0, 16}, 1);
    for (uint64_t t = 0; t < 80 && status == PTIE_OK; t++)
        status = ptie_h5_write(h5, "/a/b", PTIE_H5_F32, t, 1, frame);
    if (status == PTIE_OK) return ptie_h5_close(h5);
    ptie_h5_discard(h5);
    return status;
}

static void a_full_disk_is_reported(void **state) {
    (void)state;
    support_check_full_disk(support_temporary("full.h5"), write_frames);
}

static void no_other_file_is_opened(void **state) {
    (void)state;
    ptie_h5 *h5;
    assert_fails(ptie_h5_open(&h5, support_temporary("missing.h5")), PTIE_EIO, "No such file");
    assert_fails(ptie_h5_open(&h5, support_temporary("..")), PTIE_EIO, "directory");
    const char *path = support_temporary("text.h5");
    support_write(path, "hello", 5);
    assert_fails(ptie_h5_open(&h5, path), PTIE_EFORMAT, "text.h5: cannot open as HDF5");
    assert_null(h5);
}

static ptie_status open_and_read(const char *path) {
    ptie_h5 *h5;
    float row[6];
    PTIE_TRY(ptie_h5_open(&h5, path));
    ptie_status status = ptie_h5_read(h5, "/entry/data/phase", PTIE_H5_F32, 4, 1, row);
    ptie_h5_discard(h5);
    return status;
}

static void every_truncation_is_refused(void **state) {
    (void)state;
    support_check_truncations(example("whole.h5"), open_and_read, 0);
}

static void python_reads_it(void **state) {
    (void)state;
    support_python(
        "import h5py, sys\n"
        "f = h5py.File(sys.argv[1])\n"
        "assert f['entry/data/phase'].shape == (5, 3, 2) and f['entry/data/phase'].dtype == '<f4'\n"
        "assert f['entry/data/phase'][4, 2, 1] == 29 / 4 and f['counts'][0] == 2**40\n"
        "assert f.attrs['preset'] == 'size = 3 µm\\nname = paper\\n'\n"
        "assert f.attrs['empty'] == ''\n"
        "assert list(f['entry/data'].attrs['axes']) == ['time', 'y', 'x']\n",
        example("python.h5"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_is_read),
        cmocka_unit_test(what_is_not_there_is_named),
        cmocka_unit_test(the_same_content_is_the_same_bytes),
        cmocka_unit_test(any_thread_may_call),
        cmocka_unit_test(a_discarded_file_is_gone),
        cmocka_unit_test(an_existing_file_is_kept),
        cmocka_unit_test(a_full_disk_is_reported),
        cmocka_unit_test(no_other_file_is_opened),
        cmocka_unit_test(every_truncation_is_refused),
        cmocka_unit_test(python_reads_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
