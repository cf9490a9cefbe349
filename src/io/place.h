/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of a data set that lies in one piece: written and read at their place, by the file's descriptor
 * alone.  Writing them changes nothing that describes the file, so a file whose structure is complete
 * stays valid whenever its writer dies, and others may read it meanwhile.
 */
#ifndef PTIE_IO_PLACE_H
#define PTIE_IO_PLACE_H

#include "base/status.h"

typedef struct ptie_place {
    uint64_t offset, row_bytes, rows; /* of the first row in the file; size and number of rows */
} ptie_place;

/* The file rows are written to. */
typedef struct ptie_place_file {
    int descriptor;
    const char *path; /* what messages call it */
} ptie_place_file;

/* Rows first .. first+count-1, all of them inside the place.  PTIE_EIO with the system's reason; a file that
   ends early is PTIE_EFORMAT.  Any thread may call. */
ptie_status ptie_place_write(ptie_place_file file, const ptie_place *place, uint64_t first, uint64_t count,
                             const void *data);
ptie_status ptie_place_read(ptie_place_file file, const ptie_place *place, uint64_t first, uint64_t count,
                            void *data);

#endif
