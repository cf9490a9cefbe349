/* SPDX-License-Identifier: BSD-3-Clause */
/* Words and numbers in text: see <ptie/text.h>; whole numbers; growing strings. */
#ifndef PTIE_BASE_TEXT_H
#define PTIE_BASE_TEXT_H

#include <stdarg.h>

#include <ptie/text.h>

#include "base/status.h"

/* Parses a whole integer; false if `text` is anything else or out of range. */
bool ptie_parse_integer(const char *text, int64_t low, int64_t high, int64_t *value);

/* Numbers in files and messages are written with a point, whatever setlocale the host program has called: these
   are vsnprintf, snprintf and strtod in the C locale.  Thread-safe. */
int ptie_vprint(char *text, size_t bytes, const char *format, va_list arguments);
int ptie_print(char *text, size_t bytes, const char *format, ...) PTIE_PRINTF(3, 4);
double ptie_scan_number(const char *text, char **end);

/* A string that grows.  Start with {0}; after a failed append `failed` is true and stays so. */
typedef struct ptie_text {
    char *data; /* NUL-terminated; NULL while empty */
    size_t length, capacity;
    bool failed;
} ptie_text;

void ptie_text_append(ptie_text *text, const char *format, ...) PTIE_PRINTF(2, 3);
void ptie_text_free(ptie_text *text);

#endif
