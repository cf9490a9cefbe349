/* SPDX-License-Identifier: BSD-3-Clause */
/* Eight samples at a time: a shuffle puts the two bytes that hold a sample into one 16-bit lane, a
 * multiplication pushes the sample before it out at the top, a shift the one after it at the
 * bottom.
 */
#include "io/unpack.h"

#include <stdint.h>
#include <string.h>

#include "base/clones.h"

enum { LANES = 8, LOADED = 16 /* bytes at a time, of which 10 or 12 are used */ };

/* Sample i; none lies in more than two bytes. */
PTIE_INLINE float unpack_one(const unsigned char *in, size_t i, int bits) {
    const size_t at = i * (size_t)bits, byte = at / 8;
    const unsigned pair = (unsigned)(in[byte] << 8 | in[byte + 1]) << at % 8;
    return (float)((pair & 0xffff) >> (16 - bits));
}

#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ && defined(__has_builtin)
#if __has_builtin(__builtin_shufflevector)
#define PTIE_UNPACK_VECTORS
#endif
#endif

#ifdef PTIE_UNPACK_VECTORS
typedef uint8_t bytes16 __attribute__((vector_size(16)));
typedef uint16_t lanes16 __attribute__((vector_size(16)));
typedef int32_t lanes32 __attribute__((vector_size(32)));
typedef float floats __attribute__((vector_size(32)));

/* Defines a function that unpacks whole groups and returns how many samples those were.  The list
   is the shuffle: for each sample its second byte and its first. */
#define UNPACK_GROUPS(bits, shifts, ...)                                                           \
    PTIE_CLONES static size_t unpack_groups_##bits(float *out, const unsigned char *in,            \
                                                   size_t count) {                                 \
        const size_t bytes = (count * bits + 7) / 8;                                               \
        size_t done = 0;                                                                           \
        for (size_t at = 0; at + LOADED <= bytes; at += bits, done += LANES) {                     \
            bytes16 loaded;                                                                        \
            memcpy(&loaded, in + at, LOADED);                                                      \
            const lanes16 pairs = (lanes16)__builtin_shufflevector(loaded, loaded, __VA_ARGS__);   \
            const lanes16 samples = pairs * (lanes16)shifts >> (16 - bits);                        \
            const floats values =                                                                  \
                __builtin_convertvector(__builtin_convertvector(samples, lanes32), floats);        \
            memcpy(out + done, &values, sizeof values);                                            \
        }                                                                                          \
        return done;                                                                               \
    }

#define SHIFTS_10                                                                                  \
    { 1, 4, 16, 64, 1, 4, 16, 64 }
#define SHIFTS_12                                                                                  \
    { 1, 16, 1, 16, 1, 16, 1, 16 }
UNPACK_GROUPS(10, SHIFTS_10, 1, 0, 2, 1, 3, 2, 4, 3, 6, 5, 7, 6, 8, 7, 9, 8)
UNPACK_GROUPS(12, SHIFTS_12, 1, 0, 2, 1, 4, 3, 5, 4, 7, 6, 8, 7, 10, 9, 11, 10)

static size_t unpack_groups(float *out, const unsigned char *in, size_t count, int bits) {
    return bits == 10 ? unpack_groups_10(out, in, count) : unpack_groups_12(out, in, count);
}
#else
static size_t unpack_groups(float *out, const unsigned char *in, size_t count, int bits) {
    (void)out, (void)in, (void)count, (void)bits;
    return 0;
}
#endif

void ptie_unpack(float *out, const unsigned char *in, size_t count, int bits) {
    for (size_t i = unpack_groups(out, in, count, bits); i < count; i++)
        out[i] = unpack_one(in, i, bits);
}
