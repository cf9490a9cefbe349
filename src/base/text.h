/* SPDX-License-Identifier: BSD-3-Clause */
/* Words and numbers in text: see <ptie/text.h>; whole numbers; growing strings. */
#ifndef PTIE_BASE_TEXT_H
#define PTIE_BASE_TEXT_H

#include <ptie/text.h>

#include "base/status.h"

/* Parses a whole integer; false if `text` is anything else or out of range. */
bool ptie_parse_integer(const char *text, int64_t low, int64_t high, int64_t *value);

/* A string that grows.  Start with {0}; after a failed append `failed` is true and stays so. */
typedef struct ptie_text {
    char *data; /* NUL-terminated; NULL while empty */
    size_t length, capacity;
    bool failed;
} ptie_text;

void ptie_text_append(ptie_text *text, const char *format, ...) PTIE_PRINTF(2, 3);
void ptie_text_free(ptie_text *text);

#endif
