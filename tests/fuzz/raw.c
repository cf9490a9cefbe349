/* SPDX-License-Identifier: BSD-3-Clause */
/* Raw frames with a JSON file beside them: two bytes say how large the frames' file is, then the JSON. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes) {
    if (bytes < 2) return 0;
    const char *path = fuzz_frames("input.raw", data);
    const char *header = fuzz_file("input.json", data + 2, bytes - 2);
    fuzz_pair(path, header);
    return 0;
}
