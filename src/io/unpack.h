/* SPDX-License-Identifier: BSD-3-Clause */
/* Samples of 10 or 12 bits, packed without gaps, most significant bit first: 4 in 5 bytes or 2
 * in 3. */
#ifndef PTIE_IO_UNPACK_H
#define PTIE_IO_UNPACK_H

#include <stddef.h>

/* Bytes of `count` packed samples, the last one begun included. */
#define PTIE_PACKED_BYTES(count, bits) (((size_t)(count) * (size_t)(bits) + 7) / 8)

/* `bits` is 10 or 12; `in` begins with a whole byte's first sample. */
void ptie_unpack(float *out, const unsigned char *in, size_t count, int bits);

#endif
