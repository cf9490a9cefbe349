/* SPDX-License-Identifier: BSD-3-Clause */
/* Which kernel levels this processor and operating system can run. */
#ifndef PTIE_BASE_CPU_H
#define PTIE_BASE_CPU_H

#include <stdbool.h>

#include "base/status.h"

typedef enum ptie_cpu_level {
    PTIE_CPU_SCALAR = 0, /* any processor */
    PTIE_CPU_AVX2 = 1,   /* AVX2 and FMA */
    PTIE_CPU_AVX512 = 2, /* AVX-512 F, BW, DQ, VL */
    PTIE_CPU_LEVELS = 3
} ptie_cpu_level;

/* Highest level that the processor and the operating system support and this build has kernels for. */
ptie_cpu_level ptie_cpu_detect(void);
/* Whether it also computes with halves (AVX512-FP16, beside PTIE_CPU_AVX512). */
bool ptie_cpu_has_half(void);
const char *ptie_cpu_name(ptie_cpu_level level);
/* The processor as it names itself, or its architecture. */
void ptie_cpu_describe(char *text, size_t bytes);
/* "auto" or NULL: what the environment's PTIE_CPU says, else ptie_cpu_detect().  PTIE_ENAME for an unknown
   name or a level this machine lacks. */
ptie_status ptie_cpu_choose(ptie_cpu_level *out, const char *name);

#endif
