/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows written in place: the file is a valid one of HDF5 at any moment, whatever happens to the writer. */
#include "support/support.h"

#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/random.h"
#include "io/h5.h"
#include "support/files.h"

enum { ROWS = 4000, COLUMNS = 300 };

/* A file on its way: maps, how many of them are finished, and a line of text. */
typedef struct writing {
    ptie_output_file file;
    ptie_place maps, finished, line;
} writing;

static ptie_status begin(writing *w, const char *path) {
    ptie_h5 *h5;
    PTIE_TRY(ptie_h5_create(&h5, path, true));
    ptie_status status = PTIE_OK;
    PTIE_TRY_DONE(ptie_h5_dataset(h5, "/a/maps", PTIE_H5_F32, 2, (uint64_t[]){ROWS, COLUMNS}, 0));
    PTIE_TRY_DONE(ptie_h5_dataset(h5, "/finished", PTIE_H5_U64, 1, (uint64_t[]){1}, 0));
    PTIE_TRY_DONE(ptie_h5_dataset(h5, "/line", PTIE_H5_LINE, 1, (uint64_t[]){2}, 0));
    PTIE_TRY_DONE(ptie_h5_set_text(h5, "/a", "settings", "all of them"));
    PTIE_TRY_DONE(ptie_h5_place(h5, "/a/maps", &w->maps));
    PTIE_TRY_DONE(ptie_h5_place(h5, "/finished", &w->finished));
    PTIE_TRY_DONE(ptie_h5_place(h5, "/line", &w->line));
    return ptie_h5_detach(h5, &w->file);
done:
    ptie_h5_discard(h5);
    return status;
}

static ptie_place_file out(const writing *w) {
    return (ptie_place_file){w->file.lock, w->file.part};
}

static ptie_status write_row(const writing *w, uint64_t row) {
    float values[COLUMNS];
    for (int i = 0; i < COLUMNS; i++) values[i] = (float)row + (float)i / 1024;
    PTIE_TRY(ptie_place_write(out(w), &w->maps, row, 1, values));
    return ptie_place_write(out(w), &w->finished, 0, 1, &(uint64_t){row + 1});
}

static void what_is_written_in_place_is_in_the_file(void **state) {
    (void)state;
    writing w;
    float row[COLUMNS];
    const char *path = support_temporary("place.h5");
    assert_ok(begin(&w, path));
    assert_int_equal(w.maps.rows, ROWS);
    assert_int_equal(w.maps.row_bytes, COLUMNS * sizeof(float));
    assert_int_equal(w.line.row_bytes, PTIE_H5_LINE_BYTES);
    char line[PTIE_H5_LINE_BYTES] = "too warm: 3 µm";
    assert_ok(ptie_place_write(out(&w), &w.line, 1, 1, line));
    for (uint64_t i = 0; i < 3; i++) assert_ok(write_row(&w, i));
    assert_ok(ptie_place_read(out(&w), &w.maps, 2, 1, row));
    assert_true(row[1] == 2 + 1.0f / 1024);
    assert_ok(ptie_place_read(out(&w), &w.maps, ROWS - 1, 1, row)); /* not written yet */
    assert_true(row[COLUMNS - 1] == 0);
    assert_ok(ptie_output_commit(&w.file));
    support_python("import h5py, sys, numpy as np\n"
                   "f = h5py.File(sys.argv[1])\n"
                   "assert f['a/maps'].shape == (4000, 300) and f['a/maps'].chunks is None\n"
                   "assert (f['a/maps'][2] == 2 + np.arange(300, dtype='f4') / 1024).all()\n"
                   "assert not f['a/maps'][3:].any() and f['finished'][0] == 3\n"
                   "assert f['line'].asstr()[1] == 'too warm: 3 µm' and f['line'].asstr()[0] == ''\n",
                   path);
}

static void others_look_at_it_meanwhile(void **state) {
    (void)state;
    writing w, other;
    const char *path = support_temporary("watched.h5");
    assert_ok(begin(&w, path));
    assert_ok(write_row(&w, 0));
    assert_fails(begin(&other, path), PTIE_EIO, "being written by someone else");
    support_python("import h5py, sys\n"
                   "f = h5py.File(sys.argv[1] + '.part')\n"
                   "assert f['finished'][0] == 1 and f['a/maps'][0, 0] == 0\n",
                   path);
    ptie_output_discard(&w.file);
    support_assert_nothing_left(path);
}

/* Rows that the file says are finished are; then the writing goes on. */
static uint64_t check_and_go_on(const char *path, const writing *places) {
    writing w = *places;
    ptie_h5 *h5;
    float row[COLUMNS];
    uint64_t finished;
    char part[1100];
    snprintf(part, sizeof part, "%s.part", path);
    assert_ok(ptie_h5_open(&h5, part));
    assert_ok(ptie_h5_read(h5, "/finished", PTIE_H5_U64, 0, 1, &finished));
    for (uint64_t i = 0; i < finished; i++) {
        assert_ok(ptie_h5_read(h5, "/a/maps", PTIE_H5_F32, i, 1, row));
        assert_true(row[0] == (float)i && row[COLUMNS - 1] == (float)i + (COLUMNS - 1) / 1024.0f);
    }
    assert_ok(ptie_h5_close(h5));
    assert_ok(ptie_output_resume(&w.file, path, true));
    if (finished < ROWS) assert_ok(write_row(&w, finished));
    ptie_output_keep(&w.file);
    return finished;
}

/* Writes until it is killed; says through `begun` when the structure is complete. */
static void write_all(const char *path, int begun) {
    writing w;
    ptie_status status = begin(&w, path);
    if (write(begun, "!", 1) != 1) status = PTIE_EIO;
    for (uint64_t i = 0; i < ROWS && status == PTIE_OK; i++) status = write_row(&w, i);
    pause();
}

/* Kills a writer after some microseconds, counted from its start or from when its rows begin. */
static void kill_a_writer(const char *path, bool after_begin, useconds_t lifetime) {
    int begun[2];
    char mark;
    assert_int_equal(pipe(begun), 0);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) write_all(path, begun[1]);
    if (after_begin) assert_int_equal(read(begun[0], &mark, 1), 1);
    usleep(lifetime);
    kill(child, SIGKILL);
    assert_int_equal(waitpid(child, NULL, 0), child);
    close(begun[0]), close(begun[1]);
}

static void a_killed_writer_leaves_what_it_finished(void **state) {
    (void)state;
    writing places;
    ptie_random random;
    const char *path = support_temporary("killed.h5");
    uint64_t least = ROWS, most = 0;
    ptie_random_init(&random, 7, PTIE_STREAM_ORDER, 0);
    assert_ok(begin(&places, path));
    ptie_output_discard(&places.file);
    for (int round = 0; round < 16; round++) {
        kill_a_writer(path, true, (useconds_t)ptie_random_uniform(&random, 0, 20000));
        const uint64_t finished = check_and_go_on(path, &places);
        least = finished < least ? finished : least;
        most = finished > most ? finished : most;
    }
    assert_true(least < most); /* the kills came at different moments */
}

/* Before its structure is complete a file is none, or one without a finished row. */
static void a_writer_killed_at_its_beginning_leaves_nothing_finished(void **state) {
    (void)state;
    ptie_random random;
    const char *path = support_temporary("begun.h5");
    char part[1100];
    snprintf(part, sizeof part, "%s.part", path);
    ptie_random_init(&random, 8, PTIE_STREAM_ORDER, 0);
    for (int round = 0; round < 16; round++) {
        ptie_h5 *h5;
        uint64_t finished = 0;
        kill_a_writer(path, false, (useconds_t)ptie_random_uniform(&random, 0, 4000));
        if (ptie_h5_open(&h5, part) != PTIE_OK) continue;
        if (ptie_h5_exists(h5, "/finished"))
            assert_ok(ptie_h5_read(h5, "/finished", PTIE_H5_U64, 0, 1, &finished));
        assert_true(finished <= ROWS);
        assert_ok(ptie_h5_close(h5));
    }
}

static void what_is_in_chunks_has_no_place(void **state) {
    (void)state;
    ptie_h5 *h5;
    ptie_place place;
    assert_ok(ptie_h5_create(&h5, support_temporary("chunks.h5"), false));
    assert_ok(ptie_h5_dataset(h5, "/chunks", PTIE_H5_F32, 1, (uint64_t[]){8}, 2));
    assert_fails(ptie_h5_place(h5, "/chunks", &place), PTIE_EUNSUPPORTED, "not in one piece");
    assert_fails(ptie_h5_place(h5, "/none", &place), PTIE_EFORMAT, "/none");
    ptie_h5_discard(h5);
}

static void only_what_was_kept_is_resumed(void **state) {
    (void)state;
    writing w;
    ptie_output_file file;
    const char *path = support_temporary("kept.h5");
    assert_fails(ptie_output_resume(&file, path, false), PTIE_EIO, "kept.h5.part: cannot open: No such file");
    assert_ok(begin(&w, path));
    assert_fails(ptie_output_resume(&file, path, false), PTIE_EIO, "being written by someone else");
    ptie_output_keep(&w.file);
    assert_ok(ptie_output_resume(&file, path, false));
    assert_ok(ptie_output_commit(&file));
    assert_fails(ptie_output_resume(&file, path, false), PTIE_EEXIST, "exists already");
}

/* Where the file ends, and where writing is refused. */
static void a_short_file_and_a_full_disk_are_reported(void **state) {
    (void)state;
    writing w;
    float row[COLUMNS] = {0};
    const char *path = support_temporary("short.h5");
    assert_ok(begin(&w, path));
    assert_int_equal(ftruncate(w.file.lock, (off_t)(w.maps.offset + 10 * w.maps.row_bytes + 5)), 0);
    assert_ok(ptie_place_read(out(&w), &w.maps, 9, 1, row));
    assert_fails(ptie_place_read(out(&w), &w.maps, 10, 1, row), PTIE_EFORMAT, "ends early");
    const ptie_place_file full = {-1, "/dev/full"};
    assert_fails(ptie_place_write(full, &w.maps, 0, 1, row), PTIE_EIO, "/dev/full: cannot write");
    assert_fails(ptie_place_read(full, &w.maps, 0, 1, row), PTIE_EIO, "/dev/full: cannot read");
    ptie_output_discard(&w.file);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_in_place_is_in_the_file),
        cmocka_unit_test(others_look_at_it_meanwhile),
        cmocka_unit_test(a_killed_writer_leaves_what_it_finished),
        cmocka_unit_test(a_writer_killed_at_its_beginning_leaves_nothing_finished),
        cmocka_unit_test(what_is_in_chunks_has_no_place),
        cmocka_unit_test(only_what_was_kept_is_resumed),
        cmocka_unit_test(a_short_file_and_a_full_disk_are_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
