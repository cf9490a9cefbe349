/* SPDX-License-Identifier: BSD-3-Clause */
/* Words and numbers in text: the nearest valid word, quantities with units, growing strings. */
#ifndef PTIE_BASE_TEXT_H
#define PTIE_BASE_TEXT_H

#include "base/status.h"

/* The word of `words` (NULL-terminated) with the smallest edit distance to `word`; NULL if `words` is
   empty.  Ties go to the first. */
const char *ptie_nearest_word(const char *word, const char *const *words);

/* What a quantity measures; decides the units it may carry. */
typedef enum ptie_quantity {
    PTIE_NUMBER, /* no unit; "%" allowed: 5 % = 0.05 */
    PTIE_LENGTH, /* nm um µm mm cm m -> m */
    PTIE_TIME,   /* ns us µs ms s -> s */
    PTIE_RATE,   /* Hz kHz MHz fps -> Hz */
    PTIE_ANGLE,  /* rad mrad deg -> rad */
    PTIE_SPEED   /* m/s -> m/s */
} ptie_quantity;

/* Parses "532 nm", "10mm", "-1.5e-3 m", "25 kHz", "0.5 %".  A quantity other than PTIE_NUMBER needs its
   unit (0 does not).  Returns NULL, or what was expected ("a length such as 532 nm or 10 mm"). */
const char *ptie_parse_quantity(const char *text, ptie_quantity quantity, double *value);

/* The shortest text that ptie_parse_quantity reads back to exactly `value`, in the unit a person would
   choose: "532 nm", "0.6".  Returns `text`. */
const char *ptie_print_quantity(char text[48], double value, ptie_quantity quantity);

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
