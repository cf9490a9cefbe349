/* SPDX-License-Identifier: BSD-3-Clause */
/* What a number that was measured needs beside it: on what, built with what, from what. */
#ifndef PTIE_MACHINE_H
#define PTIE_MACHINE_H

#include <ptie/export.h>

typedef struct ptie_machine {
    uint32_t struct_size; /* set by ptie_machine_describe */
    char processor[96];   /* as it names itself; its architecture where it has no name */
    char compiler[96];    /* that built the library, "gcc 12.2.0" */
    char commit[64]; /* of the sources, with "-dirty" after changes; "unknown" outside a repository
                      */
    bool half; /* whether it computes in half precision, as ptie_denoiser_params.fast asks for */
} ptie_machine;

/* Thread-safe. */
PTIE_API void ptie_machine_describe(ptie_machine *machine);

/* The kernel levels this machine runs, slowest first, as ptie_ctx_params.cpu takes them; NULL after
   the last.  Static.  Thread-safe. */
PTIE_API const char *ptie_level_name(int32_t which);

/* The kernels, of which every level has its own; NULL after the last.  Static.  Thread-safe. */
PTIE_API const char *ptie_kernel_name(int32_t which);

#endif
