/* SPDX-License-Identifier: BSD-3-Clause */
/* The bytes of one element of a MAT file, plain or deflated, read from any position. */
#ifndef PTIE_IO_MAT_SOURCE_H
#define PTIE_IO_MAT_SOURCE_H

#include <stdio.h>
#include <zlib.h>

#include "base/status.h"

typedef struct ptie_mat_source {
    FILE *stream;        /* the caller's */
    const char *path;    /* the caller's */
    uint64_t start, end; /* of the element in the file */
    bool deflated;
    uint64_t at;    /* next byte, as inflated */
    uint64_t taken; /* of the deflated bytes */
    z_stream z;
    unsigned char input[16384];
} ptie_mat_source;

/* The source must stay where it is (zlib points into it) until it is closed.  PTIE_ENOMEM. */
ptie_status ptie_mat_source_open(ptie_mat_source *source, FILE *stream, const char *path,
                                 uint64_t start, uint64_t bytes, bool deflated);
void ptie_mat_source_close(ptie_mat_source *source); /* fine on a zeroed one */

/* `count` bytes from position `at` on; going back in a deflated element starts it again.
   PTIE_EFORMAT when the element ends before. */
ptie_status ptie_mat_source_read(ptie_mat_source *source, uint64_t at, void *bytes, size_t count);

#endif
