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
        bool is_list; /* "a, b, c"; in JSON an array */
    } fact[MOST_FACTS];
    int count;
} facts;

void add_text(facts *facts, const char *name, const char *format, ...) PTIE_PRINTF(3, 4);
/* `format` is what people read; programs get the number. */
void add_number(facts *facts, const char *name, double number, const char *format, ...)
    PTIE_PRINTF(4, 5);
/* One more name of a list, which begins with its first. */
void add_to_list(facts *facts, const char *name, const char *text);
/* Rounded for people; programs get all digits. */
void add_quantity(facts *facts, const char *name, double value, ptie_quantity quantity);
void print_facts(const facts *facts, bool json);

/* "29,777" */
const char *with_separators(char text[32], uint64_t number);

#endif
