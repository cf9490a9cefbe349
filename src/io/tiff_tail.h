/* SPDX-License-Identifier: BSD-3-Clause */
/* The parts of a TIFF behind its frames: ImageJ's description, the directories, and the header that
 * leads to them.  The frames follow each other without gaps from byte PTIE_TIFF_DATA on,
 * little-endian.
 */
#ifndef PTIE_IO_TIFF_TAIL_H
#define PTIE_IO_TIFF_TAIL_H

#include <stdio.h>

#include "io/writer.h"

#define PTIE_TIFF_DATA 16               /* both kinds of header fit in front */
#define PTIE_TIFF_LARGEST 0xffffffffull /* bytes of a file with 32-bit offsets */

/* Writes them for job->info.frames frames.  A file larger than `largest` becomes BigTIFF.  Errors of
   writing stay with the stream.  PTIE_ENOMEM. */
ptie_status ptie_tiff_write_tail(FILE *out, const ptie_writer_job *job, uint64_t largest);

#endif
