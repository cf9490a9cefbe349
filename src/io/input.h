/* SPDX-License-Identifier: BSD-3-Clause */
/* Input files: the first bytes and the size, with the system's reason when they cannot be had. */
#ifndef PTIE_IO_INPUT_H
#define PTIE_IO_INPUT_H

#include <stdio.h>

#include "base/status.h"

/* Opens a regular file for reading; *bytes (may be NULL) is its size.  PTIE_EIO, also for a
 * directory. */
ptie_status ptie_input_open(FILE **out, const char *path, uint64_t *bytes);

/* The same without keeping it open, for libraries that open by name. */
ptie_status ptie_input_check(const char *path, uint64_t *bytes);

/* The first `capacity` bytes of a file, the rest of `head` zeroed when it is shorter. */
ptie_status ptie_input_head(const char *path, unsigned char *head, size_t capacity);

#endif
