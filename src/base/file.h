/* SPDX-License-Identifier: BSD-3-Clause */
/* Output files appear whole or not at all: written as "<path>.part", synced, renamed. */
#ifndef PTIE_BASE_FILE_H
#define PTIE_BASE_FILE_H

#include <stdio.h>

#include "base/status.h"

/* An output on its way.  Libraries that open by name write to `part`; others take a stream of it. */
typedef struct ptie_output_file {
    char *path, *part; /* both owned; NULL when not open */
    int lock;          /* descriptor of `part`, or -1 */
} ptie_output_file;

/* Checks that `path` may be written (PTIE_EEXIST without overwrite; PTIE_EIO for a directory, a missing folder,
   or while another writer, in this program or another, has it open) and creates an empty `part`. */
ptie_status ptie_output_open(ptie_output_file *file, const char *path, bool overwrite);
/* The same with the content of a `part` that an interrupted run kept.  PTIE_EIO when there is none. */
ptie_status ptie_output_resume(ptie_output_file *file, const char *path, bool overwrite);
/* Closes and leaves `part` for ptie_output_resume. */
void ptie_output_keep(ptie_output_file *file);
/* Syncs `part` to the disk and renames it to `path`.  On failure `part` is removed. */
ptie_status ptie_output_commit(ptie_output_file *file);
/* Lets others open the same output and saves a descriptor: for files whose name one that stays locked guards. */
void ptie_output_unlock(ptie_output_file *file);
/* Removes `part`.  Fine on a file that is not open. */
void ptie_output_discard(ptie_output_file *file);

/* PTIE_EINVAL if writing `output` would write `other`, which may be an input ("file.h5:/inside" too), another
   output, or NULL.  The same file under two names counts. */
ptie_status ptie_output_differs(const char *output, const char *other);

/* Opens `part` for writing. */
ptie_status ptie_output_stream(const ptie_output_file *file, FILE **out);
/* Closes a stream that was written to; reports what stdio kept for later (full disk). */
ptie_status ptie_close_written(FILE *stream, const char *path);

/* Writes a whole small file atomically. */
ptie_status ptie_write_file(const char *path, const void *data, size_t bytes, bool overwrite);

/* Reads a whole file of at most `limit` bytes; *data is NUL-terminated and freed with ptie_free.
   PTIE_EIO with the system's reason (also for a directory), PTIE_EFORMAT when larger. */
ptie_status ptie_read_file(char **data, size_t *bytes, const char *path, size_t limit);

#endif
