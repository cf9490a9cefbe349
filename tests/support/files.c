/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/files.h"

#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

void support_assert_nothing_left(const char *path) {
    char part[1100];
    snprintf(part, sizeof part, "%s.part", path);
    assert_false(support_exists(path));
    assert_false(support_exists(part));
}

static void set_file_size(rlim_t bytes) {
    struct rlimit limit;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    limit.rlim_cur = bytes;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
}

void support_check_full_disk(const char *path, support_file_fn write) {
    size_t bytes;
    assert_ok(write(path));
    free(support_read(path, &bytes));
    remove(path);
    signal(SIGXFSZ, SIG_IGN); /* the write fails with EFBIG instead */
    for (size_t part = 0; part < 64; part++) {
        set_file_size(bytes * part / 64);
        ptie_status status = write(path);
        set_file_size(RLIM_INFINITY);
        assert_fails(status, PTIE_EIO, "File too large");
        assert_non_null(strstr(ptie_last_error(), path));
        support_assert_nothing_left(path);
    }
}

void support_check_truncations(const char *path, support_file_fn read, size_t padding) {
    size_t bytes;
    unsigned char *data = support_read(path, &bytes);
    const char *cut = support_temporary("cut");
    assert_ok(read(path));
    support_write(cut, data, bytes);
    for (size_t length = bytes; length-- > 0;) {
        assert_int_equal(truncate(cut, (off_t)length), 0);
        ptie_status status = read(cut);
        bool refused =
            (status == PTIE_EFORMAT || status == PTIE_EIO || status == PTIE_EUNSUPPORTED) &&
            strstr(ptie_last_error(), cut);
        if (refused || (status == PTIE_OK && length >= bytes - padding)) continue;
        fail_msg("%s cut to %zu of %zu bytes: found %s: %s", path, length, bytes,
                 ptie_status_name(status), status ? ptie_last_error() : "");
    }
    remove(cut);
    free(data);
}

void support_check_changes(const char *path, support_file_fn read) {
    size_t bytes;
    unsigned char *data = support_read(path, &bytes);
    const char *changed = support_temporary("changed");
    support_write(changed, data, bytes);
    FILE *file = fopen(changed, "r+b");
    assert_non_null(file);
    setbuf(file, NULL);
    for (size_t i = 0; i < bytes; i++) {
        const unsigned char values[] = {0, 255, (unsigned char)(data[i] ^ 1), data[i]};
        for (int k = 0; k < 4; k++) { /* the last one puts it back */
            assert_int_equal(fseek(file, (long)i, SEEK_SET), 0);
            assert_int_equal(fwrite(values + k, 1, 1, file), 1);
            if (read(changed) != PTIE_OK) assert_non_null(strstr(ptie_last_error(), changed));
        }
    }
    fclose(file);
    remove(changed);
    free(data);
}

uint32_t support_crc32(const unsigned char *data, size_t bytes) {
    uint32_t crc = ~0u;
    for (size_t i = 0; i < bytes; i++) {
        crc ^= data[i];
        for (int bit = 0; bit < 8; bit++) crc = crc >> 1 ^ (0xedb88320u & (0u - (crc & 1u)));
    }
    return ~crc;
}

void support_put_be32(unsigned char *bytes, uint32_t value) {
    for (int i = 0; i < 4; i++) bytes[i] = (unsigned char)(value >> (24 - 8 * i));
}

typedef struct interpreter {
    const char *name, *test, *command; /* is it there?  how is it called? */
    int success;                       /* its exit status then */
} interpreter;

static void run_with(const interpreter *with, const char *program, const char *path) {
    char command[2200];
    snprintf(command, sizeof command, "%s >/dev/null 2>&1", with->test);
    if (system(command) != 0) {
        print_message("# %s is not installed\n", with->name);
        skip();
    }
    const char *script = support_temporary("program");
    support_write(script, program, strlen(program));
    snprintf(command, sizeof command, "%s '%s' '%s' 1>&2", with->command, script, path);
    int result = system(command);
    if (!WIFEXITED(result) || WEXITSTATUS(result) != with->success)
        fail_msg("%s: %s disagrees", path, with->name);
}

void support_python(const char *program, const char *path) {
    run_with(&(interpreter){"/usr/bin/python3", "test -x /usr/bin/python3", "/usr/bin/python3", 0}, program,
             path);
}

void support_octave(const char *program, const char *path) {
    run_with(&(interpreter){"octave-cli", "command -v octave-cli", "octave-cli --norc --no-history --quiet", 0},
             program, path);
}

/* As its library: the program itself wants a display.  BeanShell's exit status is 0 after an exception, too: so the end
 * of the program has one of its own. */
void support_imagej(const char *program, const char *path) {
#define JARS "/usr/share/java/ij.jar:/usr/share/java/bsh.jar"
    char whole[4096];
    int length = snprintf(whole, sizeof whole,
                          "check(boolean right, what) { if (!right) throw new Exception(\"\" + what); }\n"
                          "%s\nSystem.exit(77);\n", program);
    assert_true(length > 0 && (size_t)length < sizeof whole);
    run_with(&(interpreter){"ImageJ (ij.jar, bsh.jar) or java",
                            "test -e /usr/share/java/ij.jar -a -e /usr/share/java/bsh.jar && command -v java",
                            "java -Djava.awt.headless=true -cp " JARS " bsh.Interpreter", 77},
             whole, path);
}
