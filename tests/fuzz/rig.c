/* SPDX-License-Identifier: BSD-3-Clause */
/* Rigs: what is read prints as text that reads back to the same rig. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "rig/rig.h"

static char *read_and_print(const void *text, size_t bytes) {
    const char *path = fuzz_file("input.ini", text, bytes);
    ptie_rig rig;
    ptie_rig_defaults(&rig);
    ptie_status status = ptie_rig_read(&rig, path);
    fuzz_status(status, path);
    return status == PTIE_OK ? ptie_rig_print(&rig) : NULL;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes) {
    char *once = read_and_print(data, bytes);
    if (!once) return 0;
    char *twice = read_and_print(once, strlen(once));
    FUZZ_CHECK(twice != NULL && strcmp(once, twice) == 0);
    ptie_free(once);
    ptie_free(twice);
    return 0;
}
