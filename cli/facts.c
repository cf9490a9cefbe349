/* SPDX-License-Identifier: BSD-3-Clause */
#include "facts.h"

#include <stdarg.h>
#include <stdio.h>
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

void add_to_list(facts *f, const char *name, const char *text) {
    if (f->count == 0 || strcmp(f->fact[f->count - 1].name, name) != 0) {
        add_text(f, name, "%s", text);
        f->fact[f->count - 1].is_list = true;
        return;
    }
    char *list = f->fact[f->count - 1].text;
    const size_t used = strlen(list);
    snprintf(list + used, FACT_BYTES - used, ", %s", text);
}

void add_quantity(facts *f, const char *name, double value, ptie_quantity quantity) {
    char text[PTIE_QUANTITY_BYTES];
    add_number(f, name, value, "%s", ptie_print_rounded(text, value, quantity));
}

/* "a, b" as ["a", "b"] */
static void print_list(const char *list) {
    char text[FACT_BYTES], *rest = text;
    snprintf(text, sizeof text, "%s", list);
    printf("[");
    for (char *end; (end = strstr(rest, ", ")); rest = end + 2) {
        *end = 0;
        json_text(stdout, rest);
        printf(", ");
    }
    json_text(stdout, rest);
    printf("]");
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
        else if (f->fact[i].is_list)
            print_list(f->fact[i].text);
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
