/* SPDX-License-Identifier: BSD-3-Clause */
/* What a file format must bring to be read. */
#ifndef PTIE_IO_READER_H
#define PTIE_IO_READER_H

#include <ptie/recording.h>

#include "base/status.h"

/* Enough for the HDF5 signature behind a user block of 2048 bytes. */
#define PTIE_HEAD_BYTES 2056

#define PTIE_LONGEST_SIDE 32768 /* px */

typedef struct ptie_reader {
    const char *name; /* "PNG" */
    /* Is it this format?  One of the two, the other is NULL.  probe: by the file's first PTIE_HEAD_BYTES bytes, zeros
       behind its end.  claims: by the path, for what has no beginning of its own; asked first. */
    bool (*probe)(const unsigned char *head);
    bool (*claims)(const char *path);
    /* Opens the file and fills `info` (zeroed; `format` is done already).  `inside` names a data
       set in the file, or is "".  On failure *state is NULL. */
    ptie_status (*open)(void **state, ptie_recording_info *info, const char *path,
                        const char *inside);
    /* Describes a recording whose frames are missing, from the header they should lie beside; NULL where frames have
       none of their own. */
    ptie_status (*describe)(ptie_recording_info *info, const char *path);
    /* Frame 0 .. info->frames-1 as stored. */
    ptie_status (*read)(void *state, int64_t frame, float *data);
    void (*close)(void *state); /* NULL is fine */
    bool has_data_sets;         /* a file may hold several recordings */
    bool takes_inside;          /* `inside` may be other than "" */
} ptie_reader;

extern const ptie_reader ptie_read_sequence, ptie_read_mraw, ptie_read_raw, ptie_read_cine,
    ptie_read_npy, ptie_read_png, ptie_read_tiff, ptie_read_h5, ptie_read_mat;

/* Stores a frame size that was read from a file: 1 .. PTIE_LONGEST_SIDE px each. */
ptie_status ptie_info_set_size(ptie_recording_info *info, const char *path, uint64_t width,
                               uint64_t height);

/* Of `announced` frames the first `there` are in the file: fewer are a warning. */
void ptie_info_set_frames(ptie_recording_info *info, int64_t there, int64_t announced);

/* A frame that needs `needed` bytes cannot be in a file of `found`.  `densest`: how many bytes one
   byte of the file can stand for (1 without compression). */
ptie_status ptie_check_fits(const char *path, uint64_t needed, uint64_t found, uint64_t densest);

#endif
