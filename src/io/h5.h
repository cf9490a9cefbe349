/* SPDX-License-Identifier: BSD-3-Clause */
/* HDF5 files with numeric data sets [N, ...] and attributes: what data sets and results are kept
 * in. One lock serialises all HDF5 calls of the process (the library itself is not parallel), so
 * any thread may call; one ptie_h5 is used by one thread at a time.
 */
#ifndef PTIE_IO_H5_H
#define PTIE_IO_H5_H

#include "base/file.h"
#include "base/text.h"
#include "io/place.h"

typedef struct ptie_h5 ptie_h5;

typedef enum ptie_h5_type {
    PTIE_H5_F32,
    PTIE_H5_F64,
    PTIE_H5_U8,
    PTIE_H5_U16,
    PTIE_H5_U32,
    PTIE_H5_U64,
    PTIE_H5_LINE /* text of at most PTIE_H5_LINE_BYTES, filled up with NUL */
} ptie_h5_type;

#define PTIE_H5_LINE_BYTES 240

/* Creates "<path>.part"; ptie_h5_close renames it to `path`.  Bytes depend only on what is written
   (no time stamps). */
ptie_status ptie_h5_create(ptie_h5 **out, const char *path, bool overwrite);
ptie_status ptie_h5_open(ptie_h5 **out, const char *path); /* read-only */
/* Completes a created file, or closes an opened one; frees in any case.  NULL is fine. */
ptie_status ptie_h5_close(ptie_h5 *h5);
/* Frees; a created file disappears.  NULL is fine. */
void ptie_h5_discard(ptie_h5 *h5);

/* Creates a data set of the given shape, its parent groups included.  dims[0] == 0: unlimited,
   grows with ptie_h5_write.  chunk_rows: rows (along dims[0]) per chunk; 0 = in one piece, which takes its
   place in the file at once and reads as zeros until it is written. */
ptie_status ptie_h5_dataset(ptie_h5 *h5, const char *path, ptie_h5_type type, int32_t rank,
                            const uint64_t *dims, uint64_t chunk_rows);
/* The same with one row per chunk, shuffled and deflated: rows are packed on any thread (io/pack.h) and
   handed to ptie_h5_write_chunk; ptie_h5_write packs, too, but on its own thread and slowly. */
ptie_status ptie_h5_dataset_packed(ptie_h5 *h5, const char *path, ptie_h5_type type, int32_t rank,
                                   const uint64_t *dims);
/* Shape of a data set; rank 1..4. */
ptie_status ptie_h5_shape(ptie_h5 *h5, const char *path, int32_t *rank, uint64_t dims[4]);
bool ptie_h5_exists(ptie_h5 *h5, const char *path);
/* How the samples are stored: "u16", "f32", ...  PTIE_EUNSUPPORTED for text, compounds and the
 * like. */
ptie_status ptie_h5_sample(ptie_h5 *h5, const char *path, char name[16]);
/* Appends the paths of all data sets, one to a line, in order of their names. */
ptie_status ptie_h5_list(ptie_h5 *h5, ptie_text *lines);

/* Rows first .. first+count-1 along the first dimension.  `type` is that of the memory; HDF5
 * converts. */
ptie_status ptie_h5_write(ptie_h5 *h5, const char *path, ptie_h5_type type, uint64_t first,
                          uint64_t count, const void *data);
/* One row of a data set with one row per chunk, as it is to stand in the file: little-endian, and packed
   if the data set is. */
ptie_status ptie_h5_write_chunk(ptie_h5 *h5, const char *path, uint64_t row, const void *chunk,
                                size_t bytes);
ptie_status ptie_h5_read(ptie_h5 *h5, const char *path, ptie_h5_type type, uint64_t first,
                         uint64_t count, void *data);

/* Where a data set lies that is in one piece (io/place.h). */
ptie_status ptie_h5_place(ptie_h5 *h5, const char *path, ptie_place *place);
/* Completes the structure of a created file and leaves HDF5: from here on rows are written in place, to
   file->lock, so the file is valid at any moment; the caller commits it.  Frees in any case. */
ptie_status ptie_h5_detach(ptie_h5 *h5, ptie_output_file *file);

/* Attributes of a group or data set ("/" is the root; groups are made as needed). */
ptie_status ptie_h5_set_text(ptie_h5 *h5, const char *object, const char *name, const char *value);
ptie_status ptie_h5_set_texts(ptie_h5 *h5, const char *object, const char *name,
                              const char *const *values, size_t count); /* a list of strings */
ptie_status ptie_h5_set_number(ptie_h5 *h5, const char *object, const char *name, double value);
ptie_status ptie_h5_set_numbers(ptie_h5 *h5, const char *object, const char *name,
                                const double *values, size_t count); /* a list of numbers */
ptie_status ptie_h5_set_integer(ptie_h5 *h5, const char *object, const char *name, int64_t value);
/* *value is NUL-terminated, freed with ptie_free.  PTIE_EFORMAT when absent or of another kind. */
ptie_status ptie_h5_get_text(ptie_h5 *h5, const char *object, const char *name, char **value);
ptie_status ptie_h5_get_number(ptie_h5 *h5, const char *object, const char *name, double *value);
ptie_status ptie_h5_get_integer(ptie_h5 *h5, const char *object, const char *name, int64_t *value);

#endif
