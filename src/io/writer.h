/* SPDX-License-Identifier: BSD-3-Clause */
/* What a file format must bring to be written. */
#ifndef PTIE_IO_WRITER_H
#define PTIE_IO_WRITER_H

#include <ptie/recording.h>

#include "base/status.h"

/* What is to be written; strings live as long as the writer. */
typedef struct ptie_writer_job {
    const char *path, *name;
    ptie_recording_info info; /* frames 0: not known yet */
    bool overwrite;
} ptie_writer_job;

typedef struct ptie_writer_format {
    const char *endings[3];                                          /* NULL after the last */
    ptie_status (*create)(void **state, const ptie_writer_job *job); /* on failure *state is NULL */
    ptie_status (*append)(void *state, const float *frame);
    /* After `frames` successful appends: completes the file or leaves none; frees in any case. */
    ptie_status (*complete)(void *state, int64_t frames);
    void (*discard)(void *state); /* leaves no file; frees */
} ptie_writer_format;

extern const ptie_writer_format ptie_write_mraw, ptie_write_npy, ptie_write_png, ptie_write_tiff, ptie_write_h5;

#endif
