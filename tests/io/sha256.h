/* SPDX-License-Identifier: BSD-3-Clause */
/* SHA-256 (FIPS 180-4), for tests that compare whole frames. */
#ifndef PTIE_TESTS_IO_SHA256_H
#define PTIE_TESTS_IO_SHA256_H

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* 32 bits behind the point of a root of a prime. */
static inline uint32_t sha256_fraction(long double root) {
    return (uint32_t)((root - floorl(root)) * 4294967296.0L);
}

static inline uint32_t sha256_turn(uint32_t x, int n) {
    return x >> n | x << (32 - n);
}

/* The constants of the 64 rounds and the first state, from the first 64 primes. */
static inline void sha256_begin(uint32_t k[64], uint32_t state[8]) {
    for (int count = 0, n = 2; count < 64; n++) {
        bool prime = true;
        for (int d = 2; d * d <= n; d++) prime = prime && n % d;
        if (!prime) continue;
        k[count] = sha256_fraction(cbrtl(n));
        if (count < 8) state[count] = sha256_fraction(sqrtl(n));
        count++;
    }
}

static inline void sha256_block(uint32_t state[8], const uint32_t k[64],
                                const unsigned char *block) {
    uint32_t w[64], s[8];
    for (int i = 0; i < 16; i++)
        w[i] = (uint32_t)block[4 * i] << 24 | (uint32_t)block[4 * i + 1] << 16 |
               (uint32_t)block[4 * i + 2] << 8 | block[4 * i + 3];
    for (int i = 16; i < 64; i++)
        w[i] = w[i - 16] + w[i - 7] +
               (sha256_turn(w[i - 15], 7) ^ sha256_turn(w[i - 15], 18) ^ w[i - 15] >> 3) +
               (sha256_turn(w[i - 2], 17) ^ sha256_turn(w[i - 2], 19) ^ w[i - 2] >> 10);
    memcpy(s, state, sizeof s);
    for (int i = 0; i < 64; i++) {
        const uint32_t big1 = sha256_turn(s[4], 6) ^ sha256_turn(s[4], 11) ^ sha256_turn(s[4], 25);
        const uint32_t big0 = sha256_turn(s[0], 2) ^ sha256_turn(s[0], 13) ^ sha256_turn(s[0], 22);
        const uint32_t choice = (s[4] & s[5]) ^ (~s[4] & s[6]);
        const uint32_t majority = (s[0] & s[1]) ^ (s[0] & s[2]) ^ (s[1] & s[2]);
        const uint32_t a = s[7] + big1 + choice + k[i] + w[i], b = big0 + majority;
        memmove(s + 1, s, 7 * sizeof *s);
        s[4] += a;
        s[0] = a + b;
    }
    for (int i = 0; i < 8; i++) state[i] += s[i];
}

static inline void sha256_hex(char hex[65], const unsigned char *data, size_t bytes) {
    uint32_t k[64], state[8];
    const size_t blocks = (bytes + 8) / 64 + 1;
    unsigned char *padded = calloc(blocks, 64);
    memcpy(padded, data, bytes);
    padded[bytes] = 0x80;
    for (size_t i = 0; i < 8; i++)
        padded[64 * blocks - 1 - i] = (unsigned char)((uint64_t)bytes * 8 >> 8 * i);
    sha256_begin(k, state);
    for (size_t i = 0; i < blocks; i++) sha256_block(state, k, padded + 64 * i);
    for (int i = 0; i < 8; i++) snprintf(hex + 8 * i, 9, "%08x", state[i]);
    free(padded);
}

#endif
