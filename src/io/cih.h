/* SPDX-License-Identifier: BSD-3-Clause */
/* Headers of Photron recordings: CIH (lines "Key : Value") and CIHX (XML in a binary envelope). */
#ifndef PTIE_IO_CIH_H
#define PTIE_IO_CIH_H

#include "base/status.h"

/* As far as the header says; else 0 or "". */
typedef struct ptie_cih {
    int64_t width, height;
    int64_t frames, recorded; /* in the file; in the camera before it was cut */
    int64_t start, skip;      /* number of the first frame; every skip-th was saved */
    int64_t color_bit, depth; /* bits of a sample as stored, and of them in use */
    int64_t x, y;             /* corner on the sensor */
    double rate_hz, exposure_ns;
    char side[16];              /* "Lower", "Higher": which bits of a sample are in use */
    char color[16], format[16]; /* "Mono", "Raw", "Color"; "MRaw" */
    char shutter[32];           /* "1/800000" (s); CIHX: the reciprocal alone */
    char camera[64], date[24], time[24], trigger[24], comment[128];
} ptie_cih;

/* Reads a .cih or .cihx file.  PTIE_EIO, PTIE_EFORMAT, PTIE_ENOMEM. */
ptie_status ptie_cih_read(ptie_cih *cih, const char *path);

#endif
