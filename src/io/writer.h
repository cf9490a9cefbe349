/* SPDX-License-Identifier: BSD-3-Clause */
/* What a file format must bring to be written. */
#ifndef PTIE_IO_WRITER_H
#define PTIE_IO_WRITER_H

#include <ptie/recording.h>

#include "base/pool.h"
#include "io/sample.h"

/* What is to be written; strings live as long as the writer. */
typedef struct ptie_writer_job {
    const char *path, *name;
    ptie_recording_info info; /* frames 0: not known yet */
    bool overwrite;
    const char *source, *command; /* the recording it was made from, and how; NULL: not told */
    bool compress;                /* HDF5: shuffled and deflated */
    ptie_pool *pool;              /* compresses on its threads; NULL: on the caller's */
    double low, high;             /* images, video: values of black and white; equal: see the format */
    const uint32_t *colours;      /* video: 256 of 0xRRGGBB; NULL: grey */
    double played_hz;             /* video: frames per second when shown; 0 means 25 */
    ptie_sample stored;           /* f32, u8 or u16, from info.sample; set by ptie_io_create */
} ptie_writer_job;

/* Bytes of a frame as stored. */
size_t ptie_job_bytes(const ptie_writer_job *job);
/* A frame as it is stored, little-endian.  PTIE_ENUMERIC names the first pixel whose value the sample
   type does not have. */
ptie_status ptie_job_encode(const ptie_writer_job *job, unsigned char *bytes, const float *frame);

typedef struct ptie_writer_format {
    const char *endings[3];                                          /* NULL after the last */
    ptie_status (*create)(void **state, const ptie_writer_job *job); /* on failure *state is NULL */
    ptie_status (*append)(void *state, const float *frame);
    /* Before the first frame: one value per frame, named as in HDF5 ("/entry/metrics/phase/mgm").  NULL: no place. */
    ptie_status (*add_column)(void *state, const char *path, const double *values, int64_t count);
    /* After `frames` successful appends: completes the file or leaves none; frees in any case. */
    ptie_status (*complete)(void *state, int64_t frames);
    void (*discard)(void *state); /* leaves no file; frees */
    bool needs_range;             /* all frames share low and high */
} ptie_writer_format;

extern const ptie_writer_format ptie_write_h5, ptie_write_mat, ptie_write_mp4, ptie_write_mraw,
    ptie_write_npy, ptie_write_png, ptie_write_tiff, ptie_write_y4m;

#endif
