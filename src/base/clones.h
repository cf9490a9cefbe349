/* SPDX-License-Identifier: BSD-3-Clause */
/* PTIE_CLONES before a function compiles it for several instruction sets; the loader picks one.  For
 * loops over plain C that the compiler vectorises: with strict floating point and no fused
 * multiply-adds (meson.build) every clone computes the same bits. */
#ifndef PTIE_BASE_CLONES_H
#define PTIE_BASE_CLONES_H

/* Sanitisers are not up yet when the loader asks which clone to take; clang (14) gives the clones of
   static functions names that collide. */
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__ELF__) &&         \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PTIE_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define PTIE_CLONES
#endif

/* What a clone calls in its loop has to become part of it. */
#define PTIE_INLINE static inline __attribute__((always_inline))

#endif
