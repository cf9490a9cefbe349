/* SPDX-License-Identifier: BSD-3-Clause */
/* Words and quantities as people write them: in rig files, in presets, in options of the command. */
#ifndef PTIE_TEXT_H
#define PTIE_TEXT_H

#include <ptie/export.h>

/* What a quantity measures; decides the units it may carry. */
typedef enum ptie_quantity {
    PTIE_NUMBER, /* no unit; "%" allowed: 5 % = 0.05 */
    PTIE_LENGTH, /* nm um µm mm cm m -> m */
    PTIE_TIME,   /* ns us µs ms s min h -> s */
    PTIE_RATE,   /* Hz kHz MHz fps -> Hz */
    PTIE_ANGLE,  /* rad mrad deg -> rad */
    PTIE_SPEED   /* m/s -> m/s */
} ptie_quantity;

/* Parses "532 nm", "10mm", "-1.5e-3 m", "25 kHz", "0.5 %".  A quantity other than PTIE_NUMBER needs its
   unit (0 does not).  Returns NULL, or what was expected ("a length such as 532 nm or 10 mm").
   "532 nm" gives the same bits as 532e-9.  Thread-safe. */
PTIE_API PTIE_NODISCARD const char *ptie_parse_quantity(const char *text, ptie_quantity quantity,
                                                        double *value);

#define PTIE_QUANTITY_BYTES 48

/* The shortest text that ptie_parse_quantity reads back to exactly `value`, in the unit a person would
   choose: "532 nm", "0.6".  Returns `text`.  Thread-safe. */
PTIE_API const char *ptie_print_quantity(char text[PTIE_QUANTITY_BYTES], double value,
                                         ptie_quantity quantity);

/* For people: five digits in the largest unit that leaves a number of 1 or more: "232.5 nm", "571.43 ms".
   Returns `text`.  Thread-safe. */
PTIE_API const char *ptie_print_rounded(char text[PTIE_QUANTITY_BYTES], double value,
                                        ptie_quantity quantity);

/* The word of `words` (NULL-terminated) with the smallest edit distance to `word`; NULL if `words` is
   empty.  Ties go to the first.  Thread-safe. */
PTIE_API const char *ptie_nearest_word(const char *word, const char *const *words);

#endif
