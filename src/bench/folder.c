/* SPDX-License-Identifier: BSD-3-Clause */
#include "bench/folder.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

ptie_status ptie_folder_create(ptie_folder *folder) {
    const char *parent = getenv("TMPDIR");
    if (!parent || !*parent) parent = "/tmp";
    int length = snprintf(folder->path, sizeof folder->path, "%s/ptie-bench-XXXXXX", parent);
    if (length < (int)sizeof folder->path && mkdtemp(folder->path)) return PTIE_OK;
    folder->path[0] = 0;
    return PTIE_FAIL(PTIE_EIO, "%s: cannot create a temporary folder: %s", parent, strerror(errno));
}

void ptie_folder_remove(ptie_folder *folder) {
    DIR *files = folder->path[0] ? opendir(folder->path) : NULL;
    if (!files) return;
    for (const struct dirent *entry; (entry = readdir(files));)
        if (entry->d_name[0] != '.') unlinkat(dirfd(files), entry->d_name, 0);
    closedir(files);
    rmdir(folder->path);
    folder->path[0] = 0;
}

const char *ptie_folder_file(const ptie_folder *folder, char path[PTIE_FOLDER_FILE_BYTES],
                             const char *name) {
    snprintf(path, PTIE_FOLDER_FILE_BYTES, "%s/%s", folder->path, name);
    return path;
}
