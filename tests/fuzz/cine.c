/* SPDX-License-Identifier: BSD-3-Clause */
/* Phantom CINE files. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes) {
    const char *path = fuzz_file("input.cine", data, bytes);
    fuzz_recording(path, path);
    return 0;
}
