/* SPDX-License-Identifier: BSD-3-Clause */
/* Presets: what is read prints as text that reads back to the same preset. */
#include "fuzz.h"

#include <string.h>

#include "train/preset.h"

static ptie_preset *read_preset(const void *text, size_t bytes) {
    const char *path = fuzz_file("input.ini", text, bytes);
    ptie_preset *preset;
    ptie_status status = ptie_preset_read(&preset, path);
    fuzz_status(status, path);
    FUZZ_CHECK((status == PTIE_OK) == (preset != NULL));
    return preset;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes) {
    ptie_preset *once = read_preset(data, bytes);
    if (!once) return 0;
    const char *text = ptie_preset_text(once);
    ptie_preset *twice = read_preset(text, strlen(text));
    FUZZ_CHECK(twice != NULL && strcmp(ptie_preset_text(twice), text) == 0);
    ptie_preset_free(once);
    ptie_preset_free(twice);
    return 0;
}
