/* SPDX-License-Identifier: BSD-3-Clause */
/* Frames packed as HDF5's own filters would: bytes shuffled, then deflated in a zlib stream.  HDF5 filters under
 * its lock, one frame at a time; packed here, frames are compressed on as many threads as there are.
 */
#ifndef PTIE_IO_PACK_H
#define PTIE_IO_PACK_H

#include "base/status.h"

/* Of deflate; why 1: docs/formats.md. */
#define PTIE_PACK_LEVEL 1

/* One frame at a time, on one thread at a time. */
typedef struct ptie_packer ptie_packer;

ptie_status ptie_packer_create(ptie_packer **out, size_t samples, size_t sample_bytes);
void ptie_packer_free(ptie_packer *packer); /* NULL is fine */
/* Largest size of a packed frame. */
size_t ptie_packer_bound(const ptie_packer *packer);
/* Packs a frame of little-endian samples; returns the bytes used of `packed`, which has room for the bound. */
size_t ptie_pack(ptie_packer *packer, unsigned char *packed, const unsigned char *frame);

#endif
