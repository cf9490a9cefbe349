/* SPDX-License-Identifier: BSD-3-Clause */
/* Photron headers: two bytes say how large the MRAW file is, the third whether the rest is CIH or CIHX. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes) {
    if (bytes < 3) return 0;
    const bool xml = data[2] == 'x';
    const char *path = fuzz_frames(xml ? "xml.mraw" : "text.mraw", data);
    const char *header = fuzz_file(xml ? "xml.cihx" : "text.cih", data + 3, bytes - 3);
    fuzz_pair(path, header);
    return 0;
}
