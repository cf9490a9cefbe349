/* SPDX-License-Identifier: BSD-3-Clause */
/* NPY files. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes) {
    const char *path = fuzz_file("input.npy", data, bytes);
    fuzz_recording(path, path);
    return 0;
}
