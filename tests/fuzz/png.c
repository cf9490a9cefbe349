/* SPDX-License-Identifier: BSD-3-Clause */
/* PNG files.  The check sums of their chunks are made right first, or nearly no change would come through. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

#include "support/files.h"

#define SIGNATURE 8

static size_t be32(const unsigned char *bytes) {
    size_t value = 0;
    for (int i = 0; i < 4; i++) value = value << 8 | bytes[i];
    return value;
}

/* A chunk: length of the data, type, data, CRC of type and data. */
static void mend(unsigned char *png, size_t bytes) {
    for (size_t at = SIGNATURE; at + 12 <= bytes;) {
        const size_t length = be32(png + at);
        if (length > bytes - at - 12) return;
        unsigned char *chunk = png + at;
        support_put_be32(chunk + 8 + length, support_crc32(chunk + 4, length + 4));
        at += 12 + length;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes) {
    unsigned char *png = malloc(bytes + 1);
    FUZZ_CHECK(png != NULL);
    if (bytes > 0) memcpy(png, data, bytes);
    mend(png, bytes);
    const char *path = fuzz_file("input.png", png, bytes);
    fuzz_recording(path, path);
    free(png);
    return 0;
}
