/* SPDX-License-Identifier: BSD-3-Clause */
/* MATLAB files of version 5; those of version 7.3 are HDF5. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes) {
    const char *path = fuzz_file("input.mat", data, bytes);
    fuzz_recording(path, path);
    return 0;
}
