/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/place.h"

#include <assert.h>
#include <errno.h>
#include <string.h>
#include <unistd.h>

typedef struct span {
    off_t offset;
    size_t bytes;
} span;

static span span_of(const ptie_place *place, uint64_t first, uint64_t count) {
    assert(first <= place->rows && count <= place->rows - first);
    return (span){(off_t)(place->offset + first * place->row_bytes), (size_t)(count * place->row_bytes)};
}

ptie_status ptie_place_write(ptie_place_file file, const ptie_place *place, uint64_t first, uint64_t count,
                             const void *data) {
    const unsigned char *next = data;
    span left = span_of(place, first, count);
    while (left.bytes > 0) {
        ssize_t now = pwrite(file.descriptor, next, left.bytes, left.offset);
        if (now < 0 && errno == EINTR) continue;
        if (now < 0) return PTIE_FAIL(PTIE_EIO, "%s: cannot write: %s", file.path, strerror(errno));
        next += now;
        left = (span){left.offset + now, left.bytes - (size_t)now};
    }
    return PTIE_OK;
}

ptie_status ptie_place_read(ptie_place_file file, const ptie_place *place, uint64_t first, uint64_t count,
                            void *data) {
    unsigned char *next = data;
    span left = span_of(place, first, count);
    while (left.bytes > 0) {
        ssize_t now = pread(file.descriptor, next, left.bytes, left.offset);
        if (now < 0 && errno == EINTR) continue;
        if (now < 0) return PTIE_FAIL(PTIE_EIO, "%s: cannot read: %s", file.path, strerror(errno));
        if (now == 0)
            return PTIE_FAIL(PTIE_EFORMAT, "%s: file ends early (expected %zu more bytes at %lld)", file.path,
                             left.bytes, (long long)left.offset);
        next += now;
        left = (span){left.offset + now, left.bytes - (size_t)now};
    }
    return PTIE_OK;
}
