/* SPDX-License-Identifier: BSD-3-Clause */
/* safetensors: named float32 tensors and string metadata in one file.  8-byte little-endian header
 * length, JSON header, data; no holes, no overlap, offsets relative to the data. */
#ifndef PTIE_IO_SAFETENSORS_H
#define PTIE_IO_SAFETENSORS_H

#include "base/status.h"

typedef struct ptie_tensor_view {
    const char *name;
    int32_t rank; /* 0..4 */
    int64_t shape[4];
    const float *data;
} ptie_tensor_view;

typedef struct ptie_note {
    const char *key, *value;
} ptie_note;

/* Written whole or not at all. */
ptie_status ptie_safetensors_write(const char *path, const ptie_tensor_view *tensors,
                                   size_t tensor_count, const ptie_note *notes, size_t note_count,
                                   bool overwrite);

typedef struct ptie_safetensors ptie_safetensors;

/* Reads and checks the whole file.  PTIE_EFORMAT says what is wrong and where; PTIE_EUNSUPPORTED
   for a type other than F32. */
ptie_status ptie_safetensors_read(ptie_safetensors **out, const char *path);
void ptie_safetensors_free(ptie_safetensors *file); /* NULL is fine */
size_t ptie_safetensors_count(const ptie_safetensors *file);
/* Views point into the file object. */
const ptie_tensor_view *ptie_safetensors_tensor(const ptie_safetensors *file, size_t index);
const ptie_tensor_view *ptie_safetensors_find(const ptie_safetensors *file,
                                              const char *name); /* or NULL */
size_t ptie_safetensors_notes(const ptie_safetensors *file, const ptie_note **notes);
const char *ptie_safetensors_note(const ptie_safetensors *file, const char *key); /* or NULL */

#endif
