/* SPDX-License-Identifier: BSD-3-Clause */
/* Headers of Phantom CINE files, as far as a recording needs them.  Files of all ages have the same
 * fixed parts; the SETUP block grew with the cameras and says its own length. */
#ifndef PTIE_IO_CINE_H
#define PTIE_IO_CINE_H

#include <stdio.h>

#include "base/status.h"

/* How pixels are stored (biCompression). */
enum { PTIE_CINE_PLAIN = 0, PTIE_CINE_PACKED_10 = 256, PTIE_CINE_PACKED_12 = 1024 };

/* 0 or "" where the file does not say. */
typedef struct ptie_cine {
    int64_t images;      /* in the file */
    int64_t first_image; /* number of the first, the trigger is 0 */
    uint64_t offsets_at; /* table of 64-bit offsets, one per image */
    int64_t width, height;
    int compression; /* of the file: 0 grey, 2 uninterpreted mosaic, others are refused */
    int packing, bits_per_pixel; /* PTIE_CINE_...; 8 or 16 */
    int64_t pixels_per_metre;
    uint64_t trigger_s; /* Unix time */
    /* from SETUP */
    bool flip_vertical;
    int64_t real_bits;
    bool has_levels;
    int64_t black_level, white_level;
    double nominal_rate_hz; /* of the camera; files may hold every n-th image of it */
    double exposure_s;
    int64_t serial, camera_version;
    char model[64], description[256];
    double true_rate_hz; /* of the images in the file, from their time stamps */
} ptie_cine;

/* Is it a CINE file, by its first 84 bytes? */
bool ptie_cine_probe(const unsigned char *head);

/* Reads the headers of an open file.  PTIE_EFORMAT, PTIE_EIO, PTIE_ENOMEM. */
ptie_status ptie_cine_read(ptie_cine *cine, FILE *stream, uint64_t file_bytes, const char *path);

#endif
