/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/memory.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

static bool padded_bytes(size_t count, size_t size, size_t *bytes) {
    if (size != 0 && count > (SIZE_MAX - PTIE_ALIGNMENT) / size) return false;
    *bytes = (count * size + PTIE_ALIGNMENT - 1) / PTIE_ALIGNMENT * PTIE_ALIGNMENT;
    return true;
}

void *ptie_alloc(size_t count, size_t size) {
    size_t bytes;
    if (!padded_bytes(count, size, &bytes)) return NULL;
    if (bytes == 0) bytes = PTIE_ALIGNMENT;
    void *pointer = aligned_alloc(PTIE_ALIGNMENT, bytes);
    if (pointer) memset(pointer, 0, bytes);
    return pointer;
}

void ptie_free(void *pointer) {
    free(pointer);
}

char *ptie_strdup(const char *text) {
    size_t bytes = strlen(text) + 1;
    char *copy = ptie_alloc(bytes, 1);
    if (copy) memcpy(copy, text, bytes);
    return copy;
}

ptie_status ptie_alloc_status(void *out, size_t count, size_t size, const char *what) {
    void *pointer = ptie_alloc(count, size);
    memcpy(out, &pointer, sizeof pointer);
    if (!pointer) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory (%zu x %zu bytes)", what, count, size);
    return PTIE_OK;
}

void *ptie_slice(ptie_slicer *slicer, size_t count, size_t size) {
    size_t bytes = 0;
    bool fits = padded_bytes(count, size, &bytes);
    assert(fits && bytes <= SIZE_MAX - slicer->used); /* callers bound sizes when they plan */
    (void)fits;
    void *slice = slicer->base ? slicer->base + slicer->used : NULL;
    slicer->used += bytes;
    return slice;
}
