/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/input.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

static ptie_status refuse(const char *path, int reason) {
    return PTIE_FAIL(PTIE_EIO, "%s: cannot read: %s", path, strerror(reason));
}

ptie_status ptie_input_open(FILE **out, const char *path, uint64_t *bytes) {
    struct stat info;
    *out = NULL;
    if (stat(path, &info) != 0) return refuse(path, errno);
    if (S_ISDIR(info.st_mode)) return refuse(path, EISDIR);
    if (!S_ISREG(info.st_mode))
        return PTIE_FAIL(PTIE_EIO, "%s: cannot read (expected a regular file)", path);
    *out = fopen(path, "rb");
    if (!*out) return refuse(path, errno);
    if (bytes) *bytes = (uint64_t)info.st_size;
    return PTIE_OK;
}

ptie_status ptie_input_check(const char *path, uint64_t *bytes) {
    FILE *stream;
    PTIE_TRY(ptie_input_open(&stream, path, bytes));
    fclose(stream);
    return PTIE_OK;
}

ptie_status ptie_input_head(const char *path, unsigned char *head, size_t capacity) {
    FILE *stream;
    PTIE_TRY(ptie_input_open(&stream, path, NULL));
    memset(head, 0, capacity);
    size_t found = fread(head, 1, capacity, stream);
    ptie_status status = found < capacity && ferror(stream) ? refuse(path, errno) : PTIE_OK;
    fclose(stream);
    return status;
}
