/* SPDX-License-Identifier: BSD-3-Clause */
#include "facts.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "json.h"

static void add(facts *f, const char *name, const char *format, va_list arguments) {
    if (f->count == MOST_FACTS) return;
    f->fact[f->count].name = name;
    vsnprintf(f->fact[f->count].text, FACT_BYTES, format, arguments);
    f->count++;
}

void add_text(facts *f, const char *name, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    add(f, name, format, arguments);
    va_end(arguments);
}

void add_number(facts *f, const char *name, double number, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    add(f, name, format, arguments);
    va_end(arguments);
    f->fact[f->count - 1].number = number;
    f->fact[f->count - 1].is_number = true;
}

const char *rounded_quantity(char text[PTIE_QUANTITY_BYTES], double value, ptie_quantity quantity) {
    char digits[32];
    snprintf(digits, sizeof digits, "%.5g", value);
    return ptie_print_quantity(text, strtod(digits, NULL), quantity);
}

void add_quantity(facts *f, const char *name, double value, ptie_quantity quantity) {
    char text[PTIE_QUANTITY_BYTES];
    add_number(f, name, value, "%s", rounded_quantity(text, value, quantity));
}

static void print_json(const facts *f) {
    for (int i = 0; i < f->count; i++) {
        char key[64];
        snprintf(key, sizeof key, "%s", f->fact[i].name);
        for (char *c = key; *c; c++)
            if (*c == ' ') *c = '_';
        printf("%s\n  \"%s\": ", i ? "," : "{", key);
        if (f->fact[i].is_number)
            json_number(stdout, f->fact[i].number);
        else
            json_text(stdout, f->fact[i].text);
    }
    printf("\n}\n");
}

void print_facts(const facts *f, bool json) {
    int width = 0;
    if (json) {
        print_json(f);
        return;
    }
    for (int i = 0; i < f->count; i++) {
        int length = (int)strlen(f->fact[i].name);
        if (length > width) width = length;
    }
    for (int i = 0; i < f->count; i++)
        printf("%-*s  %s\n", width, f->fact[i].name, f->fact[i].text);
}

const char *with_separators(char text[32], uint64_t number) {
    char digits[24];
    int length = snprintf(digits, sizeof digits, "%llu", (unsigned long long)number), used = 0;
    for (int i = 0; i < length; i++) {
        if (i > 0 && (length - i) % 3 == 0) text[used++] = ',';
        text[used++] = digits[i];
    }
    text[used] = 0;
    return text;
}
