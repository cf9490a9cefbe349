/* SPDX-License-Identifier: BSD-3-Clause */
/* Makes the n-th allocation, or the n-th call that reads or writes, fail.  The linker leads the library's calls
 * here (--wrap, see meson.build); those of other libraries stay as they are. */
#ifndef PTIE_TESTS_INJECT_H
#define PTIE_TESTS_INJECT_H

#include <stdbool.h>
#include <stdint.h>

typedef enum inject_kind {
    INJECT_MEMORY, /* aligned_alloc, calloc, pthread_create: no memory */
    INJECT_FILES,  /* open, read, write, close, sync, rename, stat, ...: EIO */
    INJECT_SHORT,  /* read and write: a part of what was asked for, which is no failure */
    INJECT_NOTHING
} inject_kind;

/* From here on counts the calls of `kind`, and lets number `first` (counted from 1) fail, and with `all` every
   one after it. */
void inject_start(inject_kind kind, int64_t first, bool all);
/* Back to normal; returns how many calls there were. */
int64_t inject_stop(void);

#endif
