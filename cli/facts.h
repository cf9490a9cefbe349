/* SPDX-License-Identifier: BSD-3-Clause */
/* Names and values, as lines for people or as one JSON object. */
#ifndef CLI_FACTS_H
#define CLI_FACTS_H

#include <ptie/text.h>

enum { MOST_FACTS = 32, FACT_BYTES = 1024 };

typedef struct facts {
    struct {
        const char *name; /* "frame rate"; in JSON "frame_rate" */
        char text[FACT_BYTES];
        double number;
        bool is_number;
    } fact[MOST_FACTS];
    int count;
} facts;

void add_text(facts *facts, const char *name, const char *format, ...) PTIE_PRINTF(3, 4);
/* `format` is what people read; programs get the number. */
void add_number(facts *facts, const char *name, double number, const char *format, ...)
    PTIE_PRINTF(4, 5);
/* With the digits that people care about: 25 kHz, not 24.999999999999996 kHz. */
const char *rounded_quantity(char text[PTIE_QUANTITY_BYTES], double value, ptie_quantity quantity);
/* The same as a fact; programs get all digits. */
void add_quantity(facts *facts, const char *name, double value, ptie_quantity quantity);
void print_facts(const facts *facts, bool json);

/* "29,777" */
const char *with_separators(char text[32], uint64_t number);

#endif
