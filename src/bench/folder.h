/* SPDX-License-Identifier: BSD-3-Clause */
/* A folder for files that nobody keeps. */
#ifndef PTIE_BENCH_FOLDER_H
#define PTIE_BENCH_FOLDER_H

#include "base/status.h"

enum { PTIE_FOLDER_BYTES = 512, PTIE_FOLDER_FILE_BYTES = PTIE_FOLDER_BYTES + 64 };

typedef struct ptie_folder {
    char path[PTIE_FOLDER_BYTES];
} ptie_folder;

/* Below $TMPDIR, or /tmp. */
ptie_status ptie_folder_create(ptie_folder *folder);
/* Removes it with its files; fine if it was never created. */
void ptie_folder_remove(ptie_folder *folder);
/* The path of a file in it. */
const char *ptie_folder_file(const ptie_folder *folder, char path[PTIE_FOLDER_FILE_BYTES],
                             const char *name);

#endif
