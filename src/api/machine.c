/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/machine.h>. */
#include <ptie/machine.h>

#include <stdio.h>
#include <string.h>

#include "api/commit.h"
#include "base/cpu.h"
#include "kernel/kernel.h"

#ifdef __clang__
#define COMPILER __VERSION__ /* names itself */
#else
#define COMPILER "gcc " __VERSION__
#endif

void ptie_machine_describe(ptie_machine *machine) {
    *machine = (ptie_machine){.struct_size = sizeof *machine};
    ptie_cpu_describe(machine->processor, sizeof machine->processor);
    snprintf(machine->compiler, sizeof machine->compiler, "%s", COMPILER);
    snprintf(machine->commit, sizeof machine->commit, "%s", PTIE_COMMIT);
    machine->half = ptie_cpu_has_half();
}

const char *ptie_level_name(int32_t which) {
    return which >= 0 && which <= (int32_t)ptie_cpu_detect() ? ptie_cpu_name((ptie_cpu_level)which)
                                                             : NULL;
}

const char *ptie_kernel_name(int32_t which) {
    static const char *const names[] = {
#define PTIE_KERNEL(name, parameters) #name,
#include "kernel/kernels.inc"
#undef PTIE_KERNEL
    };
    return which >= 0 && which < (int32_t)(sizeof names / sizeof *names) ? names[which] : NULL;
}
