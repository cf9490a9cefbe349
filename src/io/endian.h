/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers in files are little-endian, whatever the machine is. */
#ifndef PTIE_IO_ENDIAN_H
#define PTIE_IO_ENDIAN_H

#include <endian.h>
#include <stdint.h>
#include <string.h>

static inline void ptie_put_u64(unsigned char *bytes, uint64_t value) {
    value = htole64(value);
    memcpy(bytes, &value, sizeof value);
}

static inline uint64_t ptie_get_u64(const unsigned char *bytes) {
    uint64_t value;
    memcpy(&value, bytes, sizeof value);
    return le64toh(value);
}

static inline void ptie_put_f32(unsigned char *bytes, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    bits = htole32(bits);
    memcpy(bytes, &bits, sizeof bits);
}

static inline float ptie_get_f32(const unsigned char *bytes) {
    uint32_t bits;
    float value;
    memcpy(&bits, bytes, sizeof bits);
    bits = le32toh(bits);
    memcpy(&value, &bits, sizeof value);
    return value;
}

#endif
