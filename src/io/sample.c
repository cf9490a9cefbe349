/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/sample.h"

#include <stdio.h>
#include <string.h>

#include "io/endian.h"

/* One loop per type: a fixed-size memcpy is a plain load, whatever the alignment. */
#define CONVERTER(type)                                                                            \
    static void convert_##type(float *out, const unsigned char *in, size_t count) {                \
        for (size_t i = 0; i < count; i++) {                                                       \
            type value;                                                                            \
            memcpy(&value, in + i * sizeof value, sizeof value);                                   \
            out[i] = (float)value;                                                                 \
        }                                                                                          \
    }

CONVERTER(uint8_t)
CONVERTER(uint16_t)
CONVERTER(uint32_t)
CONVERTER(uint64_t)
CONVERTER(int8_t)
CONVERTER(int16_t)
CONVERTER(int32_t)
CONVERTER(int64_t)
CONVERTER(float)
CONVERTER(double)

typedef void (*converter)(float *out, const unsigned char *in, size_t count);

static converter find(ptie_sample sample) {
    static const struct {
        ptie_sample sample;
        converter convert;
    } known[] = {
        {{'u', 1}, convert_uint8_t},  {{'u', 2}, convert_uint16_t}, {{'u', 4}, convert_uint32_t},
        {{'u', 8}, convert_uint64_t}, {{'i', 1}, convert_int8_t},   {{'i', 2}, convert_int16_t},
        {{'i', 4}, convert_int32_t},  {{'i', 8}, convert_int64_t},  {{'f', 4}, convert_float},
        {{'f', 8}, convert_double},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (known[i].sample.kind == sample.kind && known[i].sample.bytes == sample.bytes)
            return known[i].convert;
    return NULL;
}

bool ptie_sample_known(ptie_sample sample) {
    return find(sample) != NULL;
}

void ptie_sample_name(char name[16], ptie_sample sample) {
    snprintf(name, 16, "%c%zu", sample.kind, 8 * sample.bytes);
}

void ptie_sample_swap(void *samples, size_t count, ptie_sample sample) {
    unsigned char *bytes = samples;
    for (size_t i = 0; i < count; i++, bytes += sample.bytes)
        for (size_t b = 0; b < sample.bytes / 2; b++) {
            unsigned char kept = bytes[b];
            bytes[b] = bytes[sample.bytes - 1 - b];
            bytes[sample.bytes - 1 - b] = kept;
        }
}

void ptie_sample_convert(float *out, const void *samples, size_t count, ptie_sample sample) {
    find(sample)(out, samples, count);
}

static size_t store_floats(unsigned char *out, const float *values, size_t count) {
    if (ptie_machine_is_little()) {
        memcpy(out, values, count * sizeof *values);
        return count;
    }
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, values + i, sizeof bits);
        ptie_put_le(out + 4 * i, bits, 4);
    }
    return count;
}

size_t ptie_sample_store(unsigned char *out, const float *values, size_t count,
                         ptie_sample sample) {
    if (sample.kind == 'f') return store_floats(out, values, count);
    const float largest = sample.bytes == 1 ? UINT8_MAX : UINT16_MAX;
    for (size_t i = 0; i < count; i++) {
        if (!(values[i] >= 0 && values[i] <= largest)) return i; /* NaN, too */
        const uint32_t whole = (uint32_t)values[i];
        if ((float)whole != values[i]) return i;
        ptie_put_le(out + i * sample.bytes, whole, sample.bytes);
    }
    return count;
}
