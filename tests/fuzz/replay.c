/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs a fuzz target over the files in folders, one TAP case per folder: good ones, bad ones, and inputs that
 * once were too much for it.  A failure ends the program.  usage: TARGET FOLDER... */
#include "fuzz.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>

#include "support/support.h"

#define MEMORY_LIMIT (320 << 20) /* bytes, the program itself included: files here are small, whatever they claim */

/* Sanitizers map terabytes. */
static void limit_memory(void) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    const struct rlimit limit = {MEMORY_LIMIT, MEMORY_LIMIT};
    FUZZ_CHECK(setrlimit(RLIMIT_AS, &limit) == 0);
#endif
}

static void replay_file(const char *path) {
    size_t bytes;
    unsigned char *data = support_read(path, &bytes);
    LLVMFuzzerTestOneInput(data, bytes);
    free(data);
}

/* Returns how many files it has. */
static int replay_folder(const char *folder) {
    struct dirent **entries;
    int files = 0;
    const int count = scandir(folder, &entries, NULL, alphasort);
    FUZZ_CHECK(count >= 0);
    for (int i = 0; i < count; i++) {
        char path[4096];
        snprintf(path, sizeof path, "%s/%s", folder, entries[i]->d_name);
        if (entries[i]->d_type == DT_REG) replay_file(path), files++;
        free(entries[i]);
    }
    free(entries);
    return files;
}

int main(int argc, char **argv) {
    limit_memory();
    printf("1..%d\n", argc - 1);
    for (int i = 1; i < argc; i++) {
        const int files = replay_folder(argv[i]);
        printf("ok %d - %d files of %s\n", i, files, argv[i]);
    }
    return 0;
}
