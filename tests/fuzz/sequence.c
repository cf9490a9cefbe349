/* SPDX-License-Identifier: BSD-3-Clause */
/* Names of numbered files.  The first line is a pattern, or empty for the whole folder; each further one
 * names a file in it, all of the same good content. */
#include "fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/pattern.h"
#include "support/support.h"

#define MOST_NAMES 8

/* A frame of 1 x 1 px as numpy.save writes it. */
static const char *good_file(void) {
    static const char npy[] = "\x93NUMPY\x01\0\x3e\0{'descr': '|u1', 'fortran_order': False, 'shape': (1, 1), }  \n*";
    return fuzz_file("good.npy", npy, sizeof npy - 1);
}

static bool is_file_name(const char *name) {
    return *name && !strchr(name, '/') && strcmp(name, ".") != 0 && strcmp(name, "..") != 0;
}

/* A name the pattern makes of a number is one that it finds the number in. */
static void check_pattern(const char *path) {
    ptie_pattern pattern;
    char name[4096];
    if (!ptie_pattern_find(&pattern, path)) return;
    for (int64_t number = 0; number < 3000; number = 7 * number + 1) {
        if (ptie_pattern_name(&pattern, number, name, sizeof name) != PTIE_OK) continue;
        FUZZ_CHECK(ptie_pattern_number(&pattern, name) == number);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes) {
    char folder[1024], path[4096], made[MOST_NAMES][4096], *text = fuzz_text(data, bytes), *rest = text;
    int count = 0;
    const char *good = good_file(), *first = strsep(&rest, "\n");
    snprintf(folder, sizeof folder, "%s", support_temporary("names"));
    mkdir(folder, 0777);
    for (char *name; count < MOST_NAMES && (name = strsep(&rest, "\n"));) {
        snprintf(made[count], sizeof made[count], "%s/%s", folder, name);
        if (is_file_name(name) && link(good, made[count]) == 0) count++;
    }
    snprintf(path, sizeof path, "%s%s%s", folder, *first ? "/" : "", first);
    check_pattern(path);
    fuzz_recording(path, folder);
    for (int i = 0; i < count; i++) unlink(made[i]);
    free(text);
    return 0;
}
