/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/text.h"

#include <ctype.h>
#include <errno.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef __APPLE__
#include <xlocale.h>
#endif

#include "base/memory.h"

#define MAX_WORD 63

/* This thread's locale while it speaks C; without memory it keeps the one it has. */
typedef struct spoken {
    locale_t c, before;
} spoken;

static spoken speak_c(void) {
    locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    return (spoken){c, uselocale(c)};
}

static void speak_as_before(spoken s) {
    uselocale(s.before);
    if (s.c) freelocale(s.c);
}

int ptie_vprint(char *text, size_t bytes, const char *format, va_list arguments) {
    const spoken s = speak_c();
    const int length = vsnprintf(text, bytes, format, arguments);
    speak_as_before(s);
    return length;
}

int ptie_print(char *text, size_t bytes, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = ptie_vprint(text, bytes, format, arguments);
    va_end(arguments);
    return length;
}

double ptie_scan_number(const char *text, char **end) {
    const spoken s = speak_c();
    const double number = strtod(text, end);
    speak_as_before(s);
    return number;
}

/* Levenshtein distance, case-insensitive, over the first MAX_WORD characters. */
static size_t edit_distance(const char *a, const char *b) {
    size_t n = strnlen(b, MAX_WORD), row[MAX_WORD + 1];
    for (size_t j = 0; j <= n; j++) row[j] = j;
    for (size_t i = 0; a[i] && i < MAX_WORD; i++) {
        size_t diagonal = row[0];
        row[0] = i + 1;
        for (size_t j = 0; j < n; j++) {
            bool same = tolower((unsigned char)a[i]) == tolower((unsigned char)b[j]);
            size_t best = diagonal + (same ? 0 : 1);
            if (row[j] + 1 < best) best = row[j] + 1;
            if (row[j + 1] + 1 < best) best = row[j + 1] + 1;
            diagonal = row[j + 1];
            row[j + 1] = best;
        }
    }
    return row[n];
}

const char *ptie_nearest_word(const char *word, const char *const *words) {
    const char *best = NULL;
    size_t best_distance = SIZE_MAX;
    for (; *words; words++) {
        size_t distance = edit_distance(word, *words);
        if (distance < best_distance) best = *words, best_distance = distance;
    }
    return best;
}

/* value = number * factor / divisor: 20 um = 20 / 1e6 rounds once, to the double that 20e-6 is. */
typedef struct unit {
    ptie_quantity quantity;
    const char *name;
    double factor, divisor;
    bool read_only; /* understood, but not chosen for printing */
} unit;

/* Those of a quantity ascend. */
static const unit units[] = {
    {PTIE_NUMBER, "", 1, 1, false},    {PTIE_NUMBER, "%", 1, 1e2, true},
    {PTIE_LENGTH, "nm", 1, 1e9, false}, {PTIE_LENGTH, "um", 1, 1e6, false},
    {PTIE_LENGTH, "µm", 1, 1e6, true}, {PTIE_LENGTH, "mm", 1, 1e3, false},
    {PTIE_LENGTH, "cm", 1, 1e2, true}, {PTIE_LENGTH, "m", 1, 1, false},
    {PTIE_TIME, "ns", 1, 1e9, false},  {PTIE_TIME, "us", 1, 1e6, false},
    {PTIE_TIME, "µs", 1, 1e6, true},   {PTIE_TIME, "ms", 1, 1e3, false},
    {PTIE_TIME, "s", 1, 1, false},     {PTIE_TIME, "min", 60, 1, true},
    {PTIE_TIME, "h", 3600, 1, true},   {PTIE_RATE, "Hz", 1, 1, false},
    {PTIE_RATE, "kHz", 1e3, 1, false}, {PTIE_RATE, "MHz", 1e6, 1, false},
    {PTIE_RATE, "fps", 1, 1, true},    {PTIE_ANGLE, "mrad", 1, 1e3, true},
    {PTIE_ANGLE, "rad", 1, 1, false},  {PTIE_ANGLE, "deg", M_PI, 180, true},
    {PTIE_SPEED, "m/s", 1, 1, false},
};

static const char *const expected[] = {
    [PTIE_NUMBER] = "a number",
    [PTIE_LENGTH] = "a length such as 532 nm or 10 mm",
    [PTIE_TIME] = "a time such as 40 us or 2 ms",
    [PTIE_RATE] = "a rate such as 25 kHz or 25000 fps",
    [PTIE_ANGLE] = "an angle such as 1.5 rad or 30 deg",
    [PTIE_SPEED] = "a speed such as 300 m/s",
};

const char *ptie_parse_quantity(const char *text, ptie_quantity quantity, double *value) {
    char *end;
    double number = ptie_scan_number(text, &end);
    if (end == text || !isfinite(number)) return expected[quantity];
    while (*end == ' ' || *end == '\t') end++;
    size_t length = strlen(end);
    while (length > 0 && isspace((unsigned char)end[length - 1])) length--;
    if (number == 0 && length == 0) {
        *value = 0;
        return NULL;
    }
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        const unit *u = &units[i];
        if (u->quantity != quantity || strlen(u->name) != length) continue;
        if (memcmp(u->name, end, length) != 0) continue;
        const double converted = number * u->factor / u->divisor;
        if (!isfinite(converted)) break; /* "1e308 deg" */
        *value = converted;
        return NULL;
    }
    return expected[quantity];
}

/* The shortest text of `value` in a unit that reads back exactly; false if there is none. */
static bool print_exactly(char text[32], double value, const unit *u) {
    bool found = false;
    for (int digits = 1; digits <= 17; digits++) {
        char trial[32]; /* "2e+01" has fewer digits than "20" and is longer */
        ptie_print(trial, sizeof trial, "%.*g", digits, value / u->factor * u->divisor);
        if (ptie_scan_number(trial, NULL) * u->factor / u->divisor != value) continue;
        if (found && strlen(trial) >= strlen(text)) continue;
        snprintf(text, 32, "%s", trial);
        found = true;
    }
    return found;
}

const char *ptie_print_quantity(char text[PTIE_QUANTITY_BYTES], double value, ptie_quantity quantity) {
    size_t best = SIZE_MAX;
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        const unit *u = &units[i];
        char number[32];
        if (u->quantity != quantity || u->read_only) continue;
        if (!print_exactly(number, value, u)) continue;
        /* Few characters, but a number below 1 only if no unit fits better. */
        size_t cost = strlen(number) + (fabs(value) < u->factor / u->divisor ? sizeof number : 0);
        if (cost >= best) continue;
        best = cost;
        snprintf(text, PTIE_QUANTITY_BYTES, "%s%s%s", number, *u->name ? " " : "", u->name);
    }
    return text; /* the unit of factor 1 is always exact */
}

const char *ptie_print_rounded(char text[PTIE_QUANTITY_BYTES], double value, ptie_quantity quantity) {
    const double size = 1.000001 * fabs(value); /* 0.9999999 mm is 1 mm */
    const unit *best = NULL;
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        const unit *u = &units[i];
        if (u->quantity != quantity || u->read_only) continue;
        if (!best || size >= u->factor / u->divisor) best = u;
    }
    ptie_print(text, PTIE_QUANTITY_BYTES, "%.5g%s%s", value / best->factor * best->divisor, *best->name ? " " : "",
               best->name);
    return text;
}

bool ptie_parse_integer(const char *text, int64_t low, int64_t high, int64_t *value) {
    char *end;
    errno = 0;
    long long number = strtoll(text, &end, 10);
    if (end == text || errno == ERANGE) return false;
    while (isspace((unsigned char)*end)) end++;
    if (*end || number < low || number > high) return false;
    *value = number;
    return true;
}

static bool reserve(ptie_text *text, size_t more) {
    if (more <= text->capacity - text->length) return true;
    size_t capacity = 2 * (text->capacity + more);
    char *data = ptie_alloc(capacity, 1);
    if (!data) return false;
    if (text->data) memcpy(data, text->data, text->length + 1);
    ptie_free(text->data);
    text->data = data;
    text->capacity = capacity;
    return true;
}

void ptie_text_append(ptie_text *text, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    int length = ptie_vprint(NULL, 0, format, arguments);
    va_end(arguments);
    if (text->failed || length < 0 || !reserve(text, (size_t)length + 1)) {
        text->failed = true;
        return;
    }
    va_start(arguments, format);
    ptie_vprint(text->data + text->length, (size_t)length + 1, format, arguments);
    va_end(arguments);
    text->length += (size_t)length;
}

void ptie_text_free(ptie_text *text) {
    ptie_free(text->data);
    *text = (ptie_text){0};
}
