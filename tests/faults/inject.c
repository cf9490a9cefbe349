/* SPDX-License-Identifier: BSD-3-Clause */
#include "inject.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static struct {
    inject_kind kind;
    int64_t first;
    bool all;
    _Atomic int64_t calls;
} plan = {.kind = INJECT_NOTHING};

void inject_start(inject_kind kind, int64_t first, bool all) {
    plan.kind = kind;
    plan.first = first;
    plan.all = all;
    plan.calls = 0;
}

int64_t inject_stop(void) {
    plan.kind = INJECT_NOTHING;
    return plan.calls;
}

/* Counts a call of `kind`; is it one of those that fail? */
static bool fails(inject_kind kind) {
    if (plan.kind != kind) return false;
    const int64_t call = ++plan.calls;
    return call == plan.first || (plan.all && call > plan.first);
}

static bool file_fails(void) {
    if (!fails(INJECT_FILES)) return false;
    errno = EIO;
    return true;
}

/* How much of `bytes` a read or write takes now.  (Streams write again themselves, but not those of cookies.) */
static size_t shortened(size_t bytes) {
    return bytes > 1 && fails(INJECT_SHORT) ? bytes / 2 : bytes;
}

#define WRAP(type, name, parameters)                                                               \
    type __real_##name parameters;                                                                 \
    type __wrap_##name parameters;                                                                 \
    type __wrap_##name parameters

/* --- memory and threads ---------------------------------------------------------------------------------- */

WRAP(void *, aligned_alloc, (size_t alignment, size_t bytes)) {
    return fails(INJECT_MEMORY) ? NULL : __real_aligned_alloc(alignment, bytes);
}

WRAP(void *, calloc, (size_t count, size_t bytes)) {
    return fails(INJECT_MEMORY) ? NULL : __real_calloc(count, bytes);
}

WRAP(int, pthread_create,
     (pthread_t *thread, const pthread_attr_t *attributes, void *(*main)(void *), void *argument)) {
    return fails(INJECT_MEMORY) ? EAGAIN : __real_pthread_create(thread, attributes, main, argument);
}

/* --- descriptors ----------------------------------------------------------------------------------------- */

int __real_open64(const char *path, int flags, ...);
int __wrap_open64(const char *path, int flags, ...);
int __wrap_open64(const char *path, int flags, ...) {
    va_list arguments;
    va_start(arguments, flags);
    const mode_t mode = flags & O_CREAT ? va_arg(arguments, mode_t) : 0;
    va_end(arguments);
    return file_fails() ? -1 : __real_open64(path, flags, mode);
}

/* Closes in any case, as the system does. */
WRAP(int, close, (int descriptor)) {
    const int result = __real_close(descriptor);
    return file_fails() ? -1 : result;
}

WRAP(ssize_t, pread64, (int descriptor, void *data, size_t bytes, off_t at)) {
    return file_fails() ? -1 : __real_pread64(descriptor, data, shortened(bytes), at);
}

WRAP(ssize_t, pwrite64, (int descriptor, const void *data, size_t bytes, off_t at)) {
    return file_fails() ? -1 : __real_pwrite64(descriptor, data, shortened(bytes), at);
}

WRAP(off_t, lseek64, (int descriptor, off_t at, int from)) {
    return file_fails() ? -1 : __real_lseek64(descriptor, at, from);
}

WRAP(int, ftruncate64, (int descriptor, off_t bytes)) {
    return file_fails() ? -1 : __real_ftruncate64(descriptor, bytes);
}

WRAP(int, fstat64, (int descriptor, struct stat *info)) {
    return file_fails() ? -1 : __real_fstat64(descriptor, info);
}

/* The disk is not what is tested. */
WRAP(int, fsync, (int descriptor)) {
    (void)descriptor;
    return file_fails() ? -1 : 0;
}

/* --- names ----------------------------------------------------------------------------------------------- */

WRAP(int, stat64, (const char *path, struct stat *info)) {
    return file_fails() ? -1 : __real_stat64(path, info);
}

WRAP(int, rename, (const char *from, const char *to)) {
    return file_fails() ? -1 : __real_rename(from, to);
}

WRAP(DIR *, opendir, (const char *path)) {
    return file_fails() ? NULL : __real_opendir(path);
}

WRAP(struct dirent *, readdir64, (DIR * folder)) {
    return file_fails() ? NULL : __real_readdir64(folder);
}

/* --- streams: over the descriptors above, so that stdio itself tells what failed ------------------------- */

static ssize_t stream_read(void *stream, char *data, size_t bytes) {
    const int *descriptor = stream;
    return file_fails() ? -1 : read(*descriptor, data, shortened(bytes));
}

static ssize_t stream_write(void *stream, const char *data, size_t bytes) {
    const int *descriptor = stream;
    return file_fails() ? 0 /* what fopencookie wants of a failure */ : write(*descriptor, data, bytes);
}

static int stream_seek(void *stream, off64_t *at, int from) {
    const int *descriptor = stream;
    if (file_fails()) return -1;
    *at = __real_lseek64(*descriptor, *at, from);
    return *at < 0 ? -1 : 0;
}

static int stream_close(void *stream) {
    int *descriptor = stream;
    const int result = __real_close(*descriptor);
    free(descriptor);
    return file_fails() ? -1 : result;
}

static int flags_of(const char *mode) {
    const int access = strchr(mode, '+') ? O_RDWR : mode[0] == 'r' ? O_RDONLY : O_WRONLY;
    const int create = mode[0] == 'w' ? O_CREAT | O_TRUNC : mode[0] == 'a' ? O_CREAT | O_APPEND : 0;
    return access | create | O_CLOEXEC;
}

WRAP(FILE *, fopen64, (const char *path, const char *mode)) {
    const cookie_io_functions_t functions = {stream_read, stream_write, stream_seek, stream_close};
    const int descriptor = file_fails() ? -1 : __real_open64(path, flags_of(mode), 0666);
    if (descriptor < 0) return NULL;
    int *cookie = __real_calloc(1, sizeof *cookie);
    *cookie = descriptor;
    return fopencookie(cookie, mode, functions);
}
