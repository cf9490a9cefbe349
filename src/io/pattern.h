/* SPDX-License-Identifier: BSD-3-Clause */
/* Names of numbered files: "folder/flow_%02d.png". */
#ifndef PTIE_IO_PATTERN_H
#define PTIE_IO_PATTERN_H

#include "base/status.h"

typedef struct ptie_pattern {
    const char *text;     /* the whole pattern */
    size_t before, after; /* where the number begins, and where the text behind it does */
    int32_t digits;       /* least number of digits */
} ptie_pattern;

/* Is there one %d or %0Nd (N = 1..9) in the file name of `path`?  The pattern points into `path`.
 */
bool ptie_pattern_find(ptie_pattern *pattern, const char *path);
/* The name of file `number`. */
ptie_status ptie_pattern_name(const ptie_pattern *pattern, int64_t number, char *path,
                              size_t bytes);
/* The number of the file if its name is one of the pattern's, else -1. */
int64_t ptie_pattern_number(const ptie_pattern *pattern, const char *path);

#endif
