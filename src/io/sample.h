/* SPDX-License-Identifier: BSD-3-Clause */
/* Sample types of image files, and their conversion to float. */
#ifndef PTIE_IO_SAMPLE_H
#define PTIE_IO_SAMPLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct ptie_sample {
    char kind;    /* 'u' unsigned, 'i' signed, 'f' floating point */
    size_t bytes; /* 1, 2, 4 or 8 */
} ptie_sample;

#define PTIE_SAMPLE_BYTES 8 /* of the largest */

/* Can ptie_sample_convert read it? */
bool ptie_sample_known(ptie_sample sample);
/* "u16", "f32", ... */
void ptie_sample_name(char name[16], ptie_sample sample);

/* Reverses the bytes of each of `count` samples. */
void ptie_sample_swap(void *samples, size_t count, ptie_sample sample);
/* Samples in the machine's byte order, of any alignment, to float. */
void ptie_sample_convert(float *out, const void *samples, size_t count, ptie_sample sample);
/* The other way for u8, u16 and f32, little-endian.  Returns how many were stored: less than `count`
   when values[that] is not a value of the sample type. */
size_t ptie_sample_store(unsigned char *out, const float *values, size_t count, ptie_sample sample);

#endif
