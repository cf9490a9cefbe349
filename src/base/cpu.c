/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/cpu.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>

#if defined(__x86_64__) && defined(__GNUC__)
#include <cpuid.h>
#endif

#include "base/text.h"

static const char *const names[] = {"scalar", "avx2", "avx512", NULL};

const char *ptie_cpu_name(ptie_cpu_level level) {
    return names[level];
}

ptie_cpu_level ptie_cpu_detect(void) {
#ifdef PTIE_VEC_LEVELS
    /* The compiler's run time also asks XGETBV whether the system saves the wide registers. */
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
        return PTIE_CPU_AVX512;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return PTIE_CPU_AVX2;
#endif
    return PTIE_CPU_SCALAR;
}

bool ptie_cpu_has_half(void) {
#if defined(__x86_64__) && defined(__GNUC__)
    /* Asked directly: not every compiler's __builtin_cpu_supports knows it. */
    unsigned eax, ebx, ecx, edx;
    return ptie_cpu_detect() == PTIE_CPU_AVX512 && __get_cpuid_count(7, 0, &eax, &ebx, &ecx, &edx) &&
           (edx >> 23 & 1);
#else
    return false;
#endif
}

void ptie_cpu_describe(char *text, size_t bytes) {
    struct utsname system;
    char line[256];
    snprintf(text, bytes, "%s", uname(&system) == 0 ? system.machine : "unknown");
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file && fgets(line, sizeof line, file)) {
        const char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) != 0 || !colon) continue;
        const char *name = colon + 1 + strspn(colon + 1, " \t");
        snprintf(text, bytes, "%.*s", (int)strcspn(name, "\n"), name);
        break;
    }
    if (file) fclose(file);
}

ptie_status ptie_cpu_choose(ptie_cpu_level *out, const char *name) {
    ptie_cpu_level best = ptie_cpu_detect();
    if (!name || strcmp(name, "auto") == 0) name = getenv("PTIE_CPU");
    *out = best;
    if (!name || !*name || strcmp(name, "auto") == 0) return PTIE_OK;
    for (int level = 0; level < PTIE_CPU_LEVELS; level++) {
        if (strcmp(name, names[level]) != 0) continue;
        if (level > (int)best)
            return PTIE_FAIL(PTIE_ENAME, "cpu: level '%s' is not available here (this machine has up to '%s')",
                             name, names[best]);
        *out = (ptie_cpu_level)level;
        return PTIE_OK;
    }
    return PTIE_FAIL(PTIE_ENAME, "cpu: unknown level '%s' (expected auto, scalar, avx2 or avx512)", name);
}
