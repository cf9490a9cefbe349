/* SPDX-License-Identifier: BSD-3-Clause */
/* An output file written through stdio: whole at ptie_stream_complete, or not at all. */
#ifndef PTIE_IO_STREAM_H
#define PTIE_IO_STREAM_H

#include "base/file.h"

typedef struct ptie_stream {
    ptie_output_file file;
    FILE *out;
} ptie_stream;

ptie_status ptie_stream_open(ptie_stream *stream, const char *path, bool overwrite);
/* PTIE_EIO if a write has failed; call it right after writing. */
ptie_status ptie_stream_check(const ptie_stream *stream);
/* Goes back to the start of `out`, to write what was not known before.  rewind would forget writes that failed. */
ptie_status ptie_stream_restart(FILE *out, const char *path);
/* Closes; on failure the file is gone. */
ptie_status ptie_stream_complete(ptie_stream *stream);
void ptie_stream_discard(ptie_stream *stream); /* fine on one that is not open */

#endif
