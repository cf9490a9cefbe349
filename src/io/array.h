/* SPDX-License-Identifier: BSD-3-Clause */
/* Arrays that grow by doubling. */
#ifndef PTIE_IO_ARRAY_H
#define PTIE_IO_ARRAY_H

#include <string.h>

#include "base/memory.h"

/* Makes room for one more item: *(type **)items has `count` items of `size` bytes and room for
 * *capacity. */
static inline ptie_status ptie_array_room(void *items, size_t count, size_t *capacity, size_t size,
                                          const char *what) {
    if (count < *capacity) return PTIE_OK;
    void *old, *grown;
    size_t room = *capacity ? 2 * *capacity : 64;
    PTIE_TRY(ptie_alloc_status(&grown, room, size, what));
    memcpy(&old, items, sizeof old);
    if (old) memcpy(grown, old, count * size);
    ptie_free(old);
    memcpy(items, &grown, sizeof grown);
    *capacity = room;
    return PTIE_OK;
}

#endif
