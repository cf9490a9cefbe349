/* SPDX-License-Identifier: BSD-3-Clause */
/* The vocabulary the vector kernels are written in, once for all instruction sets.  The build
 * compiles every file of this folder per level with PTIE_VEC_WIDTH (floats per register) and
 * PTIE_VEC_LEVEL (suffix of the symbols); GCC's and Clang's vector extension does the rest.  a * b
 * + c is fused here (-ffp-contract=fast).
 */
#ifndef PTIE_KERNEL_VEC_H
#define PTIE_KERNEL_VEC_H

#ifdef __AVX__
#include <immintrin.h>
#endif

#include "kernel/kernel.h"

#define PTIE_VEC_PASTE_(name, level) ptie_##name##_##level
#define PTIE_VEC_PASTE(name, level) PTIE_VEC_PASTE_(name, level)
#define VEC(name) PTIE_VEC_PASTE(name, PTIE_VEC_LEVEL)

#define PTIE_KERNEL(name, parameters) void VEC(name) parameters;
#include "kernel/kernels.inc"
#undef PTIE_KERNEL

enum { VEC_WIDTH = PTIE_VEC_WIDTH };

#define INLINE static inline __attribute__((always_inline))
/* for (i = 0 .. count - 1), with the body written out `count` times: what lets an array live in
 * registers. */
#ifdef __clang__
#define UNROLL(i, count) _Pragma("clang loop unroll(full)") for (int i = 0; i < (count); i++)
#else
#define UNROLL(i, count) _Pragma("GCC unroll 32") for (int i = 0; i < (count); i++)
#endif

typedef float vf __attribute__((vector_size(4 * PTIE_VEC_WIDTH)));
typedef int32_t vi __attribute__((vector_size(4 * PTIE_VEC_WIDTH)));
typedef float vf_anywhere __attribute__((vector_size(4 * PTIE_VEC_WIDTH), aligned(4), may_alias));

INLINE vf vf_load(const float *from) {
    return *(const vf_anywhere *)(const void *)from;
}

INLINE void vf_store(float *to, vf value) {
    *(vf_anywhere *)(void *)to = value;
}

/* Past the caches where the place is aligned; before others may read it, vf_stream_end. */
INLINE void vf_stream(float *to, vf value) {
    if ((uintptr_t)to % sizeof(vf) != 0) {
        vf_store(to, value);
        return;
    }
#if defined __AVX512F__
    _mm512_stream_ps(to, (__m512)value);
#elif defined __AVX__
    _mm256_stream_ps(to, (__m256)value);
#else
    vf_store(to, value);
#endif
}

INLINE void vf_stream_end(void) {
#if defined __AVX__
    _mm_sfence();
#endif
}

/* The end of a row; out of line, to leave the registers of the loop alone. */
static __attribute__((noinline, unused)) void vf_store_rest(float *to, vf value, int32_t count) {
    for (int32_t i = 0; i < count; i++) to[i] = value[i];
}

/* The first `count` lanes; at most VEC_WIDTH are stored. */
INLINE void vf_store_first(float *to, vf value, int32_t count) {
    if (count >= VEC_WIDTH)
        vf_store(to, value);
    else
        vf_store_rest(to, value, count);
}

/* The end of a row behind which there may be no memory; the other lanes are 0. */
static __attribute__((noinline, unused)) vf vf_load_rest(const float *from, int32_t count) {
    vf value = {0};
    for (int32_t i = 0; i < count; i++) value[i] = from[i];
    return value;
}

INLINE vf vf_load_first(const float *from, int32_t count) {
    return count >= VEC_WIDTH ? vf_load(from) : vf_load_rest(from, count);
}

INLINE vf vf_splat(float value) {
    return value - (vf){0}; /* x - 0 is x even for x = -0, so nothing is computed */
}

/* Bitwise choice: mask lanes are all ones or all zeros. */
INLINE vf vf_select(vi mask, vf yes, vf no) {
    return (vf)((mask & (vi)yes) | (~mask & (vi)no));
}

INLINE vf vf_max(vf a, vf b) {
    return vf_select(a > b, a, b);
}

INLINE vf vf_positive(vf a) {
    return (vf)((a > 0) & (vi)a);
}

/* Lanes first .. of an array of `count` floats that exist; the others 0. */
INLINE vf vf_first(vf value, int32_t count) {
    vi lane;
    UNROLL (i, VEC_WIDTH) lane[i] = i;
    return (vf)((lane < count) & (vi)value);
}

/* Keeps a value in a register where the compiler would rather load it again at every use. */
INLINE vf vf_hold(vf value) {
    __asm__("" : "+v"(value));
    return value;
}

/* Sum of the lanes: halves in single precision down to four, then double. */
INLINE double vf_sum(vf value) {
#if PTIE_VEC_WIDTH == 16
    typedef float half __attribute__((vector_size(32)));
    const half eight = __builtin_shufflevector(value, value, 0, 1, 2, 3, 4, 5, 6, 7) +
                       __builtin_shufflevector(value, value, 8, 9, 10, 11, 12, 13, 14, 15);
#else
    const vf eight = value;
#endif
    typedef float quarter __attribute__((vector_size(16)));
    const quarter four = __builtin_shufflevector(eight, eight, 0, 1, 2, 3) +
                         __builtin_shufflevector(eight, eight, 4, 5, 6, 7);
    return ((double)four[0] + (double)four[1]) + ((double)four[2] + (double)four[3]);
}

/* Even and odd elements of the 2 * VEC_WIDTH floats (a, b), and back. */
#if PTIE_VEC_WIDTH == 16
#define VEC_EVEN 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30
#define VEC_ODD 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31
#define VEC_LOW 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23
#define VEC_HIGH 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31
#elif PTIE_VEC_WIDTH == 8
#define VEC_EVEN 0, 2, 4, 6, 8, 10, 12, 14
#define VEC_ODD 1, 3, 5, 7, 9, 11, 13, 15
#define VEC_LOW 0, 8, 1, 9, 2, 10, 3, 11
#define VEC_HIGH 4, 12, 5, 13, 6, 14, 7, 15
#endif

INLINE vf vf_even(vf a, vf b) {
    return __builtin_shufflevector(a, b, VEC_EVEN);
}
INLINE vf vf_odd(vf a, vf b) {
    return __builtin_shufflevector(a, b, VEC_ODD);
}
INLINE vf vf_interleave_low(vf even, vf odd) {
    return __builtin_shufflevector(even, odd, VEC_LOW);
}
INLINE vf vf_interleave_high(vf even, vf odd) {
    return __builtin_shufflevector(even, odd, VEC_HIGH);
}

/* Sums of the lanes of VEC_WIDTH vectors, as the lanes of one: halves folded onto each other. */
INLINE vf vf_fold(vf *v) {
    for (int count = VEC_WIDTH / 2; count >= 1; count /= 2)
        UNROLL (i, count) v[i] = vf_even(v[2 * i], v[2 * i + 1]) + vf_odd(v[2 * i], v[2 * i + 1]);
    return v[0];
}

/* Sums of the lanes of `count` vectors. */
INLINE void vf_sums(float *sums, const vf *v, const int count) {
    for (int first = 0; first < count; first += VEC_WIDTH) {
        vf part[VEC_WIDTH];
        UNROLL (i, VEC_WIDTH) part[i] = first + i < count ? v[first + i] : (vf){0};
        vf_store_first(sums + first, vf_fold(part), count - first);
    }
}

INLINE float *row_of(const ptie_map *map, int32_t c, int32_t y) {
    return map->data + c * map->plane + y * map->row;
}

INLINE int32_t smaller(int32_t a, int32_t b) {
    return a < b ? a : b;
}

#endif
