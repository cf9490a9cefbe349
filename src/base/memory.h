/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory: 64-byte aligned, zeroed, with overflow-checked sizes; and one block carved into slices. */
#ifndef PTIE_BASE_MEMORY_H
#define PTIE_BASE_MEMORY_H

#include "base/status.h"

#define PTIE_ALIGNMENT 64

/* count * size zeroed bytes, 64-byte aligned; NULL when the product overflows or memory is short.
   A size of 0 gives a valid pointer. */
void *ptie_alloc(size_t count, size_t size);
void ptie_free(void *pointer); /* NULL is fine */

/* Copy of a string; NULL when memory is short. */
char *ptie_strdup(const char *text);

/* The same with a status: *(type **)out = ..., PTIE_ENOMEM naming `what` on failure. */
ptie_status ptie_alloc_status(void *out, size_t count, size_t size, const char *what);

/* Slices of a caller's scratch block.  With base NULL it only counts: the first pass sizes the block
   (ptie_slicer.used), the second hands out the slices. */
typedef struct ptie_slicer {
    unsigned char *base;
    size_t used; /* bytes, a multiple of the alignment */
} ptie_slicer;

void *ptie_slice(ptie_slicer *slicer, size_t count, size_t size);

#endif
