/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"

static ptie_status system_failure(const char *path, const char *what) {
    return PTIE_FAIL(PTIE_EIO, "%s: %s: %s", path, what, strerror(errno));
}

void ptie_output_unlock(ptie_output_file *file) {
    if (file->path && file->lock >= 0) close(file->lock);
    file->lock = -1;
}

static void forget(ptie_output_file *file) {
    ptie_output_unlock(file);
    ptie_free(file->path);
    ptie_free(file->part);
    *file = (ptie_output_file){0};
}

static ptie_status may_write(const char *path, bool overwrite) {
    struct stat info;
    if (stat(path, &info) != 0) return PTIE_OK; /* absent; a bad folder shows when `part` is created */
    if (S_ISDIR(info.st_mode))
        return PTIE_FAIL(PTIE_EIO, "%s: cannot write (expected a file name, found a directory)", path);
    if (!S_ISREG(info.st_mode)) /* a rename would replace /dev/null */
        return PTIE_FAIL(PTIE_EIO, "%s: cannot write (expected a file name, found a device)", path);
    if (!overwrite)
        return PTIE_FAIL(PTIE_EEXIST, "%s: exists already (use -f to overwrite)", path);
    return PTIE_OK;
}

/* Same device and inode, or, for a file that is not there yet, the same name in the same folder. */
static bool same_file(const char *a, const char *b) {
    struct stat x, y;
    const bool a_exists = stat(a, &x) == 0, b_exists = stat(b, &y) == 0;
    if (a_exists != b_exists) return false;
    if (a_exists) return x.st_dev == y.st_dev && x.st_ino == y.st_ino;
    const char *a_slash = strrchr(a, '/'), *b_slash = strrchr(b, '/');
    if (strcmp(a_slash ? a_slash + 1 : a, b_slash ? b_slash + 1 : b) != 0) return false;
    char a_folder[PATH_MAX], b_folder[PATH_MAX];
    snprintf(a_folder, sizeof a_folder, "%.*s", a_slash ? (int)(a_slash - a) + 1 : 1, a_slash ? a : ".");
    snprintf(b_folder, sizeof b_folder, "%.*s", b_slash ? (int)(b_slash - b) + 1 : 1, b_slash ? b : ".");
    return stat(a_folder, &x) == 0 && stat(b_folder, &y) == 0 && x.st_dev == y.st_dev &&
           x.st_ino == y.st_ino;
}

ptie_status ptie_output_differs(const char *output, const char *other) {
    if (!other) return PTIE_OK;
    char file[PATH_MAX];
    const char *inside = strstr(other, ":/");
    snprintf(file, sizeof file, "%.*s", inside ? (int)(inside - other) : (int)strnlen(other, PATH_MAX), other);
    if (!same_file(output, other) && !same_file(output, file)) return PTIE_OK;
    return PTIE_FAIL(PTIE_EINVAL, "%s: would be written over %s (expected a name of its own)", output, other);
}

static bool is_named(int descriptor, const char *path) {
    struct stat x, y;
    return fstat(descriptor, &x) == 0 && stat(path, &y) == 0 && x.st_dev == y.st_dev &&
           x.st_ino == y.st_ino;
}

/* Of the open file, not of the process, and of another kind than HDF5's own (flock), so that other programs may
   look at what is being written.  It goes with the process; file systems without locks do without. */
static bool taken(int descriptor) {
    struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    return fcntl(descriptor, F_OFD_SETLK, &whole) != 0 && (errno == EAGAIN || errno == EACCES);
}

/* Opens `part` as the only writer. */
static ptie_status lock_part(ptie_output_file *file, int create) {
    for (;;) {
        file->lock = open(file->part, O_RDWR | O_CLOEXEC | create, 0666);
        if (file->lock < 0)
            return create ? system_failure(file->path, "cannot create") : system_failure(file->part, "cannot open");
        if (taken(file->lock))
            return PTIE_FAIL(PTIE_EIO, "%s: is being written by someone else (expected %s to be free)", file->path,
                             file->part);
        if (is_named(file->lock, file->part)) return PTIE_OK;
        ptie_output_unlock(file); /* meanwhile the writer before renamed or removed it */
    }
}

static ptie_status empty_part(const ptie_output_file *file) {
    if (ftruncate(file->lock, 0) == 0 || errno == EINVAL /* a link to a device */) return PTIE_OK;
    const ptie_status status = system_failure(file->path, "cannot create");
    unlink(file->part);
    return status;
}

static ptie_status name_and_lock(ptie_output_file *file, const char *path, bool overwrite, int create) {
    *file = (ptie_output_file){0};
    PTIE_TRY(may_write(path, overwrite));
    size_t bytes = strlen(path) + sizeof ".part";
    file->lock = -1;
    file->path = ptie_strdup(path);
    file->part = ptie_alloc(bytes, 1);
    if (!file->path || !file->part) {
        forget(file);
        return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", path);
    }
    snprintf(file->part, bytes, "%s.part", path);
    ptie_status status = lock_part(file, create);
    if (status != PTIE_OK) forget(file);
    return status;
}

ptie_status ptie_output_open(ptie_output_file *file, const char *path, bool overwrite) {
    PTIE_TRY(name_and_lock(file, path, overwrite, O_CREAT));
    ptie_status status = empty_part(file);
    if (status != PTIE_OK) forget(file);
    return status;
}

ptie_status ptie_output_resume(ptie_output_file *file, const char *path, bool overwrite) {
    return name_and_lock(file, path, overwrite, 0);
}

void ptie_output_keep(ptie_output_file *file) {
    forget(file);
}

static ptie_status sync_to_disk(const char *path) {
    int descriptor = open(path, O_RDONLY);
    if (descriptor < 0) return system_failure(path, "cannot open to sync");
    int failed = fsync(descriptor);
    ptie_status status = failed ? system_failure(path, "cannot sync") : PTIE_OK;
    close(descriptor);
    return status;
}

ptie_status ptie_output_commit(ptie_output_file *file) {
    ptie_status status = sync_to_disk(file->part);
    if (status == PTIE_OK && rename(file->part, file->path) != 0)
        status = system_failure(file->path, "cannot rename");
    if (status != PTIE_OK) unlink(file->part);
    forget(file);
    return status;
}

void ptie_output_discard(ptie_output_file *file) {
    if (file->part) unlink(file->part);
    forget(file);
}

ptie_status ptie_output_stream(const ptie_output_file *file, FILE **out) {
    *out = fopen(file->part, "w+b");
    return *out ? PTIE_OK : system_failure(file->path, "cannot create");
}

ptie_status ptie_close_written(FILE *stream, const char *path) {
    int failed = ferror(stream); /* errno still holds the reason */
    if (!failed) errno = 0;
    failed |= fclose(stream);
    return failed ? system_failure(path, "cannot write") : PTIE_OK;
}

ptie_status ptie_write_file(const char *path, const void *data, size_t bytes, bool overwrite) {
    ptie_output_file file;
    FILE *stream;
    PTIE_TRY(ptie_output_open(&file, path, overwrite));
    ptie_status status = ptie_output_stream(&file, &stream);
    if (status == PTIE_OK) {
        fwrite(data, 1, bytes, stream);
        status = ptie_close_written(stream, path);
    }
    if (status == PTIE_OK) return ptie_output_commit(&file);
    ptie_output_discard(&file);
    return status;
}

/* Reads until the end, so that pipes work too; the limit bounds the memory. */
static ptie_status read_stream(char **data, size_t *bytes, FILE *stream, const char *path,
                               size_t limit) {
    size_t capacity = 1 << 16, used = 0;
    char *buffer;
    PTIE_TRY(ptie_alloc_status(&buffer, capacity, 1, path));
    for (;;) {
        used += fread(buffer + used, 1, capacity - 1 - used, stream);
        if (used < capacity - 1) break;
        char *larger = used < limit ? ptie_alloc(capacity, 2) : NULL;
        if (!larger) {
            ptie_free(buffer);
            return used < limit ? PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", path)
                                : PTIE_FAIL(PTIE_EFORMAT, "%s: file too large (expected at most %zu bytes)",
                                            path, limit);
        }
        memcpy(larger, buffer, used);
        ptie_free(buffer);
        buffer = larger;
        capacity *= 2;
    }
    if (ferror(stream)) {
        ptie_free(buffer);
        return system_failure(path, "cannot read");
    }
    if (used > limit) {
        ptie_free(buffer);
        return PTIE_FAIL(PTIE_EFORMAT, "%s: file too large (expected at most %zu bytes)", path, limit);
    }
    buffer[used] = 0;
    *data = buffer;
    *bytes = used;
    return PTIE_OK;
}

ptie_status ptie_read_file(char **data, size_t *bytes, const char *path, size_t limit) {
    *data = NULL;
    *bytes = 0;
    FILE *stream = fopen(path, "rb");
    if (!stream) return system_failure(path, "cannot open");
    ptie_status status = read_stream(data, bytes, stream, path, limit);
    fclose(stream);
    return status;
}
