/* SPDX-License-Identifier: BSD-3-Clause */
/* Frames of uncompressed samples at known places of a file: what the formats without a codec share.
 */
#ifndef PTIE_IO_RASTER_H
#define PTIE_IO_RASTER_H

#include <stdio.h>

#include "base/status.h"
#include "io/sample.h"

typedef struct ptie_raster {
    int32_t width, height;
    int packed_bits; /* 10 or 12: packed, most significant bit first; 0: `sample` counts */
    ptie_sample sample;
    bool swapped;       /* samples are in the other byte order */
    bool bottom_up;     /* the bottom row comes first */
    uint64_t row_bytes; /* from row to row; 0: without gaps */
} ptie_raster;

/* Of one frame in the file; below 2^40 for row_bytes up to 2^25. */
uint64_t ptie_raster_bytes(const ptie_raster *raster);

/* Reads the frame that begins at byte `at`, top row first.  PTIE_EIO; `frame` is for the message.
 */
ptie_status ptie_raster_read(const ptie_raster *raster, FILE *stream, uint64_t at, float *data,
                             const char *path, int64_t frame);

#endif
