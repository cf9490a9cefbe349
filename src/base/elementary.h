/* SPDX-License-Identifier: BSD-3-Clause */
/* Elementary functions in single precision without a branch or a call, so that loops over them
 * vectorise, and the same bits on every machine.  Their largest errors, measured by tests/base
 * against double precision over the stated ranges:
 *
 *     ptie_expf              1.2 ulp   clamped to |x| <= 87
 *     ptie_logf              1.2 ulp   normal x > 0
 *     ptie_turnf             1.2e-7    absolute, |turns| <= 2^20
 *     ptie_sinf, ptie_cosf   1.2e-7    absolute, |x| <= 1e4
 *     ptie_anglef            4e-7      absolute, everywhere
 */
#ifndef PTIE_BASE_ELEMENTARY_H
#define PTIE_BASE_ELEMENTARY_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "base/clones.h"

#define PTIE_ROUND 12582912.0f /* 1.5 * 2^23: adding it rounds to an integer, in the low bits */

PTIE_INLINE float ptie_minf(float a, float b) {
    return a < b ? a : b;
}

PTIE_INLINE float ptie_maxf(float a, float b) {
    return a > b ? a : b;
}

/* |x| < 2^31 */
PTIE_INLINE float ptie_floorf(float x) {
    const float whole = (float)(int32_t)x;
    return whole - (x < whole);
}

PTIE_INLINE int32_t ptie_bits_of(float value) {
    int32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

PTIE_INLINE float ptie_float_of(int32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* 2^n exp(r), n = round(x / ln 2), |r| <= ln 2 / 2: ln 2 in two parts, exp(r) as its Taylor
   polynomial of degree 7, whose rest is below 1e-8 there. */
PTIE_INLINE float ptie_expf(float x) {
    x = ptie_maxf(ptie_minf(x, 87), -87);
    const float shifted = x * 1.44269504f + PTIE_ROUND, n = shifted - PTIE_ROUND;
    const float r = x - n * 0.693359375f + n * 2.12194440e-4f;
    float p = 1.0f / 5040;
    p = p * r + 1.0f / 720;
    p = p * r + 1.0f / 120;
    p = p * r + 1.0f / 24;
    p = p * r + 1.0f / 6;
    p = p * r + 0.5f;
    p = p * (r * r) + r; /* exp(r) - 1, so that the 1 is added last */
    return (p + 1) * ptie_float_of((ptie_bits_of(shifted) - ptie_bits_of(PTIE_ROUND) + 127) * (1 << 23));
}

/* e ln 2 + 2 atanh(s), s = (m - 1) / (m + 1), x = 2^e m with m in [sqrt(1/2), sqrt(2)): the series of
   atanh up to s^9, |s| <= 0.172, leaves 1e-9. */
PTIE_INLINE float ptie_logf(float x) {
    const int32_t bits = ptie_bits_of(x), scale = (bits - 0x3f3504f3) & ~0x7fffff;
    const float m = ptie_float_of(bits - scale), e = (float)(scale / (1 << 23));
    const float f = m - 1, s = f / (m + 1), s2 = s * s;
    float p = 2.0f / 9;
    p = p * s2 + 2.0f / 7;
    p = p * s2 + 2.0f / 5;
    p = p * s2 + 2.0f / 3;
    /* 2 atanh(s) = f - s (f - s^2 p): exact in its leading term */
    return (f - s * (f - s2 * p)) + (e * -2.12194440e-4f) + e * 0.693359375f;
}

/* Sine and cosine of r + quarter * pi / 2 for |r| <= pi / 4; Taylor up to r^9 and r^10. */
PTIE_INLINE void ptie_sincos_reduced(float r, int32_t quarter, float *sine, float *cosine) {
    const float r2 = r * r;
    float s = 1.0f / 362880, c = -1.0f / 3628800;
    s = s * r2 - 1.0f / 5040;
    s = s * r2 + 1.0f / 120;
    s = s * r2 - 1.0f / 6;
    s = s * r2 * r + r;
    c = c * r2 + 1.0f / 40320;
    c = c * r2 - 1.0f / 720;
    c = c * r2 + 1.0f / 24;
    c = c * r2 - 0.5f;
    c = c * r2 + 1;
    /* Bits instead of choices, which the compiler would turn into branches. */
    const int32_t swap = -(quarter & 1) & (ptie_bits_of(s) ^ ptie_bits_of(c)), sign = INT32_MIN;
    *sine = ptie_float_of(ptie_bits_of(s) ^ swap ^ ((int32_t)((uint32_t)quarter << 30) & sign));
    *cosine = ptie_float_of(ptie_bits_of(c) ^ swap ^ ((int32_t)((uint32_t)(quarter + 1) << 30) & sign));
}

/* Of 2 pi times `turns`. */
PTIE_INLINE void ptie_turnf(float turns, float *sine, float *cosine) {
    const float shifted = 4 * turns + PTIE_ROUND, quarters = shifted - PTIE_ROUND;
    ptie_sincos_reduced((4 * turns - quarters) * 1.57079633f, ptie_bits_of(shifted) & 3, sine, cosine);
}

/* pi / 2 in three parts, the first two short enough for exact products (Cody and Waite). */
PTIE_INLINE void ptie_sincosf(float x, float *sine, float *cosine) {
    const float shifted = x * 0.636619772f + PTIE_ROUND, n = shifted - PTIE_ROUND;
    const float r = ((x - n * 1.5703125f) - n * 4.83751297e-4f) - n * 7.54978942e-8f;
    ptie_sincos_reduced(r, ptie_bits_of(shifted) & 3, sine, cosine);
}

PTIE_INLINE float ptie_sinf(float x) {
    float sine, cosine;
    ptie_sincosf(x, &sine, &cosine);
    return sine;
}

PTIE_INLINE float ptie_cosf(float x) {
    float sine, cosine;
    ptie_sincosf(x, &sine, &cosine);
    return cosine;
}

/* atan2(y, x): atan(t) for t = small / large by its polynomial (Abramowitz and Stegun
   4.4.49), unfolded by octants.  0 at the origin. */
PTIE_INLINE float ptie_anglef(float y, float x) {
    const float ax = fabsf(x), ay = fabsf(y), large = ptie_maxf(ax, ay);
    const float t = ptie_minf(ax, ay) / ptie_maxf(large, 1e-30f), t2 = t * t;
    float p = 0.0028662257f;
    p = p * t2 - 0.0161657367f;
    p = p * t2 + 0.0429096138f;
    p = p * t2 - 0.0752896400f;
    p = p * t2 + 0.1065626393f;
    p = p * t2 - 0.1420889944f;
    p = p * t2 + 0.1999355085f;
    p = p * t2 - 0.3333314528f;
    float angle = p * t2 * t + t;
    angle = ay > ax ? 1.57079633f - angle : angle;
    angle = x < 0 ? 3.14159265f - angle : angle;
    return y < 0 ? -angle : angle;
}

#endif
