/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/mat_source.h"

#include <string.h>

ptie_status ptie_mat_source_open(ptie_mat_source *source, FILE *stream, const char *path,
                                 uint64_t start, uint64_t bytes, bool deflated) {
    memset(source, 0, sizeof *source);
    source->stream = stream;
    source->path = path;
    source->start = start;
    source->end = start + bytes;
    if (deflated && inflateInit(&source->z) != Z_OK)
        return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", path);
    source->deflated = deflated;
    return PTIE_OK;
}

void ptie_mat_source_close(ptie_mat_source *source) {
    if (source->deflated) inflateEnd(&source->z);
    source->deflated = false;
}

static bool read_file(const ptie_mat_source *source, uint64_t at, void *bytes, size_t count) {
    const uint64_t size = source->end - source->start;
    return at <= size && count <= size - at &&
           fseeko(source->stream, (off_t)(source->start + at), SEEK_SET) == 0 &&
           fread(bytes, 1, count, source->stream) == count;
}

static void refill(ptie_mat_source *source) {
    const uint64_t left = source->end - source->start - source->taken;
    const size_t now = left < sizeof source->input ? (size_t)left : sizeof source->input;
    if (!read_file(source, source->taken, source->input, now)) return;
    source->taken += now;
    source->z.next_in = source->input;
    source->z.avail_in = (uInt)now;
}

/* The next `count` inflated bytes. */
static bool inflate_next(ptie_mat_source *source, unsigned char *bytes, size_t count) {
    source->at += count;
    while (count > 0) {
        const size_t now = count < 1u << 30 ? count : 1u << 30;
        if (source->z.avail_in == 0) refill(source); /* without more, what zlib still holds */
        source->z.next_out = bytes;
        source->z.avail_out = (uInt)now;
        const int result = inflate(&source->z, Z_NO_FLUSH);
        const size_t done = now - source->z.avail_out;
        bytes += done;
        count -= done;
        if (result != Z_OK && (result != Z_STREAM_END || count > 0)) return false;
    }
    return true;
}

static bool skip_to(ptie_mat_source *source, uint64_t at) {
    unsigned char block[16384];
    if (at < source->at) {
        if (inflateReset(&source->z) != Z_OK) return false;
        source->z.avail_in = 0;
        source->at = source->taken = 0;
    }
    while (source->at < at) {
        const uint64_t left = at - source->at;
        if (!inflate_next(source, block, left < sizeof block ? (size_t)left : sizeof block))
            return false;
    }
    return true;
}

ptie_status ptie_mat_source_read(ptie_mat_source *source, uint64_t at, void *bytes, size_t count) {
    const bool read = source->deflated ? skip_to(source, at) && inflate_next(source, bytes, count)
                                       : read_file(source, at, bytes, count);
    if (read) return PTIE_OK;
    source->at = UINT64_MAX; /* whatever is read next, from the beginning */
    return PTIE_FAIL(PTIE_EFORMAT, "%s: a variable is damaged or cut short", source->path);
}
