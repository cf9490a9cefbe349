/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers in files are little-endian, whatever the machine is. */
#ifndef PTIE_IO_ENDIAN_H
#define PTIE_IO_ENDIAN_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static inline void ptie_put_le(unsigned char *bytes, uint64_t value, size_t count) {
    for (size_t i = 0; i < count; i++) bytes[i] = (unsigned char)(value >> 8 * i);
}

static inline uint64_t ptie_get_le(const unsigned char *bytes, size_t count) {
    uint64_t value = 0;
    for (size_t i = 0; i < count; i++) value |= (uint64_t)bytes[i] << 8 * i;
    return value;
}

static inline float ptie_get_f32(const unsigned char *bytes) {
    uint32_t bits = (uint32_t)ptie_get_le(bytes, 4);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline bool ptie_machine_is_little(void) {
    const uint16_t one = 1;
    return *(const unsigned char *)&one == 1;
}

/* Errors stay with the stream. */
static inline void ptie_write_le(FILE *stream, uint64_t value, size_t count) {
    unsigned char bytes[8];
    ptie_put_le(bytes, value, count);
    fwrite(bytes, 1, count, stream);
}

static inline void ptie_write_floats(FILE *stream, const float *values, uint64_t count) {
    unsigned char block[4096];
    while (count > 0) {
        size_t now = count < sizeof block / 4 ? (size_t)count : sizeof block / 4;
        for (size_t i = 0; i < now; i++) {
            uint32_t bits;
            memcpy(&bits, values + i, sizeof bits);
            ptie_put_le(block + 4 * i, bits, 4);
        }
        fwrite(block, 4, now, stream);
        values += now;
        count -= now;
    }
}

#endif
