/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/stream.h"

#include <errno.h>
#include <string.h>

ptie_status ptie_stream_open(ptie_stream *stream, const char *path, bool overwrite) {
    stream->out = NULL;
    PTIE_TRY(ptie_output_open(&stream->file, path, overwrite));
    ptie_status status = ptie_output_stream(&stream->file, &stream->out);
    if (status != PTIE_OK) ptie_output_discard(&stream->file);
    return status;
}

ptie_status ptie_stream_check(const ptie_stream *stream) {
    if (!ferror(stream->out)) return PTIE_OK;
    return PTIE_FAIL(PTIE_EIO, "%s: cannot write: %s", stream->file.path, strerror(errno));
}

ptie_status ptie_stream_restart(FILE *out, const char *path) {
    if (fseeko(out, 0, SEEK_SET) == 0 && !ferror(out)) return PTIE_OK;
    return PTIE_FAIL(PTIE_EIO, "%s: cannot write: %s", path, strerror(errno));
}

ptie_status ptie_stream_complete(ptie_stream *stream) {
    ptie_status status = ptie_close_written(stream->out, stream->file.path);
    stream->out = NULL;
    if (status == PTIE_OK) return ptie_output_commit(&stream->file);
    ptie_output_discard(&stream->file);
    return status;
}

void ptie_stream_discard(ptie_stream *stream) {
    if (stream->out) fclose(stream->out);
    stream->out = NULL;
    ptie_output_discard(&stream->file);
}
