/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/ini.h"

#include <assert.h>
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"

#define MAX_KEYS 96

typedef struct reading {
    void *target;
    const ptie_ini_key *keys;
    size_t count;
    bool seen[MAX_KEYS];
    ptie_status status; /* of the first bad line */
    char message[PTIE_MESSAGE_BYTES / 2];
} reading;

static const char *const booleans[] = {"no", "yes", "false", "true", "off", "on", NULL};

static int word_index(const char *word, const char *const *words) {
    for (int i = 0; words[i]; i++)
        if (strcmp(word, words[i]) == 0) return i;
    return -1;
}

/* "a .. b": both ends in one unit or each in its own; "a": both ends the same. */
static const char *parse_range(const char *text, ptie_quantity quantity, ptie_range *range) {
    char low[64], high[64];
    const char *dots = strstr(text, "..");
    if (!dots) {
        const char *wrong = ptie_parse_quantity(text, quantity, &range->low);
        range->high = range->low;
        return wrong;
    }
    snprintf(high, sizeof high, "%s", dots + 2);
    snprintf(low, sizeof low, "%.*s", (int)(dots - text), text);
    const char *wrong = ptie_parse_quantity(high, quantity, &range->high);
    if (wrong) return wrong;
    /* "2 .. 5 mm": the unit of the second number serves both. */
    static const char digits[] = " \t+-.0123456789eE";
    if (low[strspn(low, digits)]) return ptie_parse_quantity(low, quantity, &range->low);
    char both[132];
    snprintf(both, sizeof both, "%s %s", low, high + strspn(high, digits));
    return ptie_parse_quantity(both, quantity, &range->low);
}

static ptie_status complain(reading *r, const ptie_ini_key *key, const char *expected,
                            const char *found) {
    snprintf(r->message, sizeof r->message, "%s: expected %s, found '%.80s'", key->name, expected, found);
    return PTIE_EFORMAT;
}

static ptie_status out_of_range(reading *r, const ptie_ini_key *key, const char *found) {
    ptie_print(r->message, sizeof r->message, "%s: out of range (expected %g to %g in SI units, found '%.60s')",
             key->name, key->low, key->high, found);
    return PTIE_EFORMAT;
}

static ptie_status set_range(reading *r, const ptie_ini_key *key, ptie_range *field, const char *text) {
    ptie_range range;
    const char *wrong = parse_range(text, key->quantity, &range);
    if (wrong) return complain(r, key, wrong, text);
    if (range.low > range.high) return complain(r, key, "a range from low to high", text);
    if (range.low < key->low || range.high > key->high) return out_of_range(r, key, text);
    *field = range;
    return PTIE_OK;
}

static ptie_status set_choice(reading *r, const ptie_ini_key *key, int *field, const char *text) {
    int which = word_index(text, key->choices);
    if (which >= 0) {
        *field = which;
        return PTIE_OK;
    }
    snprintf(r->message, sizeof r->message, "%s: unknown value '%.60s' (did you mean '%s'?)", key->name,
             text, ptie_nearest_word(text, key->choices));
    return PTIE_ENAME;
}

static ptie_status set_field(reading *r, const ptie_ini_key *key, const char *text) {
    char *field = (char *)r->target + key->offset;
    switch (key->kind) {
    case PTIE_INI_QUANTITY: {
        double value;
        const char *wrong = ptie_parse_quantity(text, key->quantity, &value);
        if (wrong) return complain(r, key, wrong, text);
        if (value < key->low || value > key->high) return out_of_range(r, key, text);
        memcpy(field, &value, sizeof value);
        return PTIE_OK;
    }
    case PTIE_INI_RANGE: return set_range(r, key, (ptie_range *)(void *)field, text);
    case PTIE_INI_INTEGER: {
        int64_t value;
        if (!ptie_parse_integer(text, INT32_MIN, INT32_MAX, &value))
            return complain(r, key, "a whole number", text);
        if ((double)value < key->low || (double)value > key->high) return out_of_range(r, key, text);
        int32_t number = (int32_t)value;
        memcpy(field, &number, sizeof number);
        return PTIE_OK;
    }
    case PTIE_INI_BOOLEAN: {
        int which = word_index(text, booleans);
        if (which < 0) return complain(r, key, "yes or no", text);
        bool value = which % 2 == 1;
        memcpy(field, &value, sizeof value);
        return PTIE_OK;
    }
    case PTIE_INI_CHOICE: return set_choice(r, key, (int *)(void *)field, text);
    case PTIE_INI_TEXT:
        if (strlen(text) >= key->text_bytes) return complain(r, key, "a shorter text", text);
        memcpy(field, text, strlen(text) + 1);
        return PTIE_OK;
    case PTIE_INI_OWN: {
        const char *wrong = key->type->parse(field, text);
        return wrong ? complain(r, key, wrong, text) : PTIE_OK;
    }
    }
    return PTIE_EFORMAT;
}

static ptie_status unknown_name(reading *r, const char *section, const char *name) {
    const char *words[MAX_KEYS + 1];
    size_t n = 0;
    for (size_t i = 0; i < r->count; i++)
        if (strcmp(r->keys[i].section, section) == 0) words[n++] = r->keys[i].name;
    words[n] = NULL;
    if (n > 0) {
        snprintf(r->message, sizeof r->message, "unknown key '%.60s' in [%s] (did you mean '%s'?)", name,
                 section, ptie_nearest_word(name, words));
        return PTIE_ENAME;
    }
    for (size_t i = 0; i < r->count; i++) words[i] = r->keys[i].section;
    words[r->count] = NULL;
    snprintf(r->message, sizeof r->message, "unknown section [%.60s] (did you mean [%s]?)", section,
             ptie_nearest_word(section, words));
    return PTIE_ENAME;
}

static ptie_status set_key(reading *r, const char *section, const char *name, const char *value) {
    for (size_t i = 0; i < r->count; i++) {
        const ptie_ini_key *key = &r->keys[i];
        if (strcmp(key->section, section) != 0 || strcmp(key->name, name) != 0) continue;
        r->seen[i] = true;
        return set_field(r, key, value);
    }
    return unknown_name(r, section, name);
}

/* The text without white space around it; cuts it in place. */
static char *trimmed(char *text) {
    while (isspace((unsigned char)*text)) text++;
    size_t length = strlen(text);
    while (length > 0 && isspace((unsigned char)text[length - 1])) length--;
    text[length] = 0;
    return text;
}

/* A comment begins the line, or stands behind white space and a semicolon. */
static void cut_comment(char *line) {
    if (*line == '#') *line = 0;
    for (char *c = line; *c; c++)
        if (*c == ';' && (c == line || isspace((unsigned char)c[-1]))) *c = 0;
}

static ptie_status not_a_line(reading *r) {
    snprintf(r->message, sizeof r->message, "expected '[section]', 'key = value' or a comment");
    return PTIE_EFORMAT;
}

/* "[section]", "key = value", "key: value", a comment, or nothing. */
static ptie_status read_line(reading *r, char **section, char *line) {
    line = trimmed(line);
    cut_comment(line);
    line = trimmed(line);
    if (!*line) return PTIE_OK;
    if (*line == '[') {
        char *end = line + strlen(line) - 1;
        if (*end != ']') return not_a_line(r);
        *end = 0;
        *section = line + 1;
        return PTIE_OK;
    }
    char *separator = strpbrk(line, "=:");
    if (!separator) return not_a_line(r);
    *separator = 0;
    char *value = trimmed(separator + 1);
    if (*value == ';') *value = 0; /* "key =; a comment" */
    return set_key(r, *section, trimmed(line), value);
}

/* Up to the first bad line, whose number is returned, or 0.  text is cut to pieces. */
static int read_lines(reading *r, char *text) {
    char nowhere[] = "", *section = nowhere;
    if (strncmp(text, "\xef\xbb\xbf", 3) == 0) text += 3; /* the byte order mark of Windows' editors */
    for (int number = 1; text; number++) {
        char *line = text, *end = strchr(text, '\n');
        if (end) *end = 0;
        text = end ? end + 1 : NULL;
        r->status = read_line(r, &section, line);
        if (r->status != PTIE_OK) return number;
    }
    return 0;
}

ptie_status ptie_ini_read(void *target, const ptie_ini_key *keys, size_t count, const char *text,
                          const char *where) {
    assert(count <= MAX_KEYS);
    reading r = {.target = target, .keys = keys, .count = count};
    char *copy = ptie_strdup(text);
    if (!copy) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", where);
    const int line = read_lines(&r, copy);
    ptie_free(copy);
    if (line > 0) return PTIE_FAIL(r.status, "%s:%d: %s", where, line, r.message);
    for (size_t i = 0; i < count; i++)
        if (keys[i].required && !r.seen[i])
            return PTIE_FAIL(PTIE_EINVAL, "%s: missing key '%s' in [%s] (expected %s)", where,
                             keys[i].name, keys[i].section,
                             keys[i].quantity == PTIE_LENGTH ? "a length such as 532 nm or 10 mm"
                                                             : "a value");
    return PTIE_OK;
}

/* Appends nothing when the field is not set. */
static void print_field(ptie_text *out, const ptie_ini_key *key, const void *field) {
    char low[PTIE_QUANTITY_BYTES], high[PTIE_QUANTITY_BYTES];
    switch (key->kind) {
    case PTIE_INI_QUANTITY:
        if (!isnan(*(const double *)field))
            ptie_text_append(out, "%s", ptie_print_quantity(low, *(const double *)field, key->quantity));
        break;
    case PTIE_INI_RANGE: {
        const ptie_range *range = field;
        ptie_text_append(out, "%s .. %s", ptie_print_quantity(low, range->low, key->quantity),
                         ptie_print_quantity(high, range->high, key->quantity));
        break;
    }
    case PTIE_INI_INTEGER: ptie_text_append(out, "%d", *(const int32_t *)field); break;
    case PTIE_INI_BOOLEAN: ptie_text_append(out, "%s", *(const bool *)field ? "yes" : "no"); break;
    case PTIE_INI_CHOICE: ptie_text_append(out, "%s", key->choices[*(const int *)field]); break;
    case PTIE_INI_TEXT: ptie_text_append(out, "%s", (const char *)field); break;
    case PTIE_INI_OWN: key->type->print(out, field); break;
    }
}

static void print_section(ptie_text *out, const char **section, const ptie_ini_key *key) {
    if (strcmp(*section, key->section) == 0) return;
    ptie_text_append(out, "%s[%s]\n", **section ? "\n" : "", key->section);
    *section = key->section;
}

void ptie_ini_print(ptie_text *out, const void *target, const ptie_ini_key *keys, size_t count) {
    const char *section = "";
    for (size_t i = 0; i < count; i++) {
        ptie_text value = {0};
        print_field(&value, &keys[i], (const char *)target + keys[i].offset);
        out->failed |= value.failed;
        if (value.length > 0) {
            print_section(out, &section, &keys[i]);
            ptie_text_append(out, "%s = %s\n", keys[i].name, value.data);
        }
        ptie_text_free(&value);
    }
}

void ptie_ini_print_helped(ptie_text *out, const void *target, const ptie_ini_key *keys, size_t count) {
    const char *section = "";
    for (size_t i = 0; i < count; i++) {
        ptie_text line = {0}, value = {0};
        print_field(&value, &keys[i], (const char *)target + keys[i].offset);
        const char *example = keys[i].example ? keys[i].example : "";
        print_section(out, &section, &keys[i]);
        ptie_text_append(&line, "%s%s = %s", value.length > 0 ? "" : "; ", keys[i].name,
                         value.length > 0 ? value.data : example);
        ptie_text_append(out, "%-32s ; %s\n", line.data ? line.data : "", keys[i].help ? keys[i].help : "");
        out->failed |= value.failed || line.failed;
        ptie_text_free(&value);
        ptie_text_free(&line);
    }
}
