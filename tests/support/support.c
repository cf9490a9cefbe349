/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/support.h"

#include <ftw.h>
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

/* Takes the place of cmocka's: version 1.1.5 reports a skipped case as "not ok", which counts as a failure. */
void print_message(const char *const format, ...) {
    static const char wrong[] = "not ok %u # SKIP";
    const bool skipped = strncmp(format, wrong, sizeof wrong - 1) == 0;
    va_list arguments;
    va_start(arguments, format);
    vprintf(skipped ? format + strlen("not ") : format, arguments);
    va_end(arguments);
    fflush(stdout);
}

void support_assert_ok(ptie_status status, const char *call, const char *file, int line) {
    if (status == PTIE_OK) return;
    print_error("%s:%d: %s\n    expected ok, found %s: %s\n", file, line, call, ptie_status_name(status),
                ptie_last_error());
    _fail(file, line);
}

void support_assert_fails(ptie_status status, ptie_status expected, const char *fragment,
                          const char *call, const char *file, int line) {
    if (status == expected && strstr(ptie_last_error(), fragment)) return;
    print_error("%s:%d: %s\n    expected %s with '%s', found %s: %s\n", file, line, call,
                ptie_status_name(expected), fragment, ptie_status_name(status), ptie_last_error());
    _fail(file, line);
}

void support_assert_near(double found, double expected, double bound, const char *what,
                         const char *file, int line) {
    double off = fabs(found - expected);
    if (off <= bound) return; /* false for NaN */
    print_error("%s:%d: %s\n    expected %.9g, found %.9g, off by %.3g, bound %.3g (%.3g times)\n", file,
                line, what, expected, found, off, bound, off / bound);
    _fail(file, line);
}

double support_relative_error(const float *a, const float *b, size_t count) {
    double difference = 0, norm = 0;
    for (size_t i = 0; i < count; i++) {
        double d = (double)a[i] - (double)b[i];
        difference += d * d;
        norm += (double)b[i] * (double)b[i];
    }
    return sqrt(difference / norm);
}

static char folder[256];

static int remove_entry(const char *path, const struct stat *info, int type, struct FTW *walk) {
    (void)info, (void)type, (void)walk;
    return remove(path);
}

static void remove_folder(void) {
    nftw(folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
}

static const char *joined(const char *base, const char *name) {
    static char paths[8][1024];
    static int next;
    char *path = paths[next++ % 8];
    snprintf(path, sizeof paths[0], "%s/%s", base, name);
    return path;
}

const char *support_temporary(const char *name) {
    if (!folder[0]) {
        const char *base = getenv("TMPDIR");
        snprintf(folder, sizeof folder, "%.200s/ptie-test-XXXXXX", base ? base : "/tmp");
        assert_non_null(mkdtemp(folder));
        atexit(remove_folder);
    }
    return joined(folder, name);
}

const char *support_source(const char *name) {
    const char *root = getenv("PTIE_TEST_SOURCE");
    return joined(root ? root : ".", name);
}

const char *support_data(const char *name) {
    const char *root = getenv("PTIE_TEST_DATA");
    if (!root) return NULL;
    const char *path = joined(root, name);
    return support_exists(path) ? path : NULL;
}

bool support_exists(const char *path) {
    return access(path, F_OK) == 0;
}

unsigned char *support_read(const char *path, size_t *bytes) {
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    *bytes = (size_t)ftell(file);
    rewind(file);
    unsigned char *data = malloc(*bytes + 1);
    assert_non_null(data);
    assert_int_equal(fread(data, 1, *bytes, file), *bytes);
    data[*bytes] = 0;
    fclose(file);
    return data;
}

void support_write(const char *path, const void *data, size_t bytes) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, bytes, file), bytes);
    assert_int_equal(fclose(file), 0);
}
