/* SPDX-License-Identifier: BSD-3-Clause */
/* Text found in files of unknown encoding, made fit for a line on a terminal and for JSON. */
#ifndef PTIE_IO_CLEAN_H
#define PTIE_IO_CLEAN_H

#include <stddef.h>

/* Every byte that belongs to no UTF-8 character becomes '?'. */
void ptie_clean_utf8(char *text, size_t bytes);

/* Copies at most `length` bytes, up to a NUL: without spaces at the ends, on one line, in UTF-8,
   cut between characters where `out` is too small. */
void ptie_clean_copy(char *out, size_t capacity, const char *text, size_t length);

#endif
