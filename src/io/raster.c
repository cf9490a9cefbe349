/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/raster.h"

#include <errno.h>
#include <string.h>

#include "io/unpack.h"

#define BLOCK 8192 /* samples converted at a time; packed, a whole number of bytes */

static size_t bytes_of(const ptie_raster *raster, size_t samples) {
    return raster->packed_bits ? PTIE_PACKED_BYTES(samples, raster->packed_bits)
                               : samples * raster->sample.bytes;
}

uint64_t ptie_raster_bytes(const ptie_raster *raster) {
    const size_t width = (size_t)raster->width, height = (size_t)raster->height;
    return raster->row_bytes ? raster->row_bytes * height : bytes_of(raster, width * height);
}

static void convert(const ptie_raster *raster, float *out, unsigned char *block, size_t count) {
    if (raster->packed_bits) {
        ptie_unpack(out, block, count, raster->packed_bits);
        return;
    }
    if (raster->swapped) ptie_sample_swap(block, count, raster->sample);
    ptie_sample_convert(out, block, count, raster->sample);
}

/* `count` samples that follow each other. */
static bool read_run(const ptie_raster *raster, FILE *stream, uint64_t at, float *out,
                     size_t count) {
    unsigned char block[BLOCK * PTIE_SAMPLE_BYTES];
    if (fseeko(stream, (off_t)at, SEEK_SET) != 0) return false;
    for (size_t done = 0; done < count; done += BLOCK) {
        const size_t now = count - done < BLOCK ? count - done : BLOCK;
        const size_t bytes = bytes_of(raster, now);
        if (fread(block, 1, bytes, stream) != bytes) return false;
        convert(raster, out + done, block, now);
    }
    return true;
}

static bool read_rows(const ptie_raster *raster, FILE *stream, uint64_t at, float *data) {
    const size_t width = (size_t)raster->width, height = (size_t)raster->height;
    if (raster->row_bytes == 0) return read_run(raster, stream, at, data, width * height);
    for (size_t y = 0; y < height; y++)
        if (!read_run(raster, stream, at + y * raster->row_bytes, data + y * width, width))
            return false;
    return true;
}

static void flip_rows(float *data, size_t width, size_t height) {
    for (size_t y = 0; y < height / 2; y++) {
        float *above = data + y * width, *below = data + (height - 1 - y) * width;
        for (size_t x = 0; x < width; x++) {
            const float kept = above[x];
            above[x] = below[x];
            below[x] = kept;
        }
    }
}

ptie_status ptie_raster_read(const ptie_raster *raster, FILE *stream, uint64_t at, float *data,
                             const char *path, int64_t frame) {
    if (!read_rows(raster, stream, at, data))
        return PTIE_FAIL(PTIE_EIO, "%s: cannot read frame %lld: %s", path, (long long)frame,
                         ferror(stream) ? strerror(errno) : "the file ends");
    if (raster->bottom_up) flip_rows(data, (size_t)raster->width, (size_t)raster->height);
    return PTIE_OK;
}
