/* SPDX-License-Identifier: BSD-3-Clause */
#include "options.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "help.h"

static int wrong_value(const command_usage *u, const option *o, const char *expected,
                       const char *text) {
    return misused("%s: --%s: expected %s, found '%s'", u->name, o->name, expected, text);
}

static bool parse_whole(const char *text, int64_t low, int64_t high, int64_t *value) {
    char *end;
    double approximate = strtod(text, &end); /* catches what strtoll would cut off */
    if (end == text || *end || approximate < (double)low || approximate > (double)high)
        return false;
    *value = strtoll(text, &end, 10);
    return *end == 0 && *value >= low && *value <= high;
}

static int set_whole(const command_usage *u, const option *o, const char *text, int64_t high) {
    int64_t value;
    char expected[96];
    if (!parse_whole(text, o->low, high, &value)) {
        snprintf(expected, sizeof expected, "a whole number from %lld to %lld", (long long)o->low,
                 (long long)high);
        return wrong_value(u, o, expected, text);
    }
    if (o->kind == OPTION_INT32)
        *(int32_t *)o->value = (int32_t)value;
    else
        *(int64_t *)o->value = value;
    return GO_ON;
}

static int set_seed(const command_usage *u, const option *o, const char *text) {
    int64_t value;
    if (!parse_whole(text, 0, INT64_MAX, &value))
        return wrong_value(u, o, "a whole number of 0 or more", text);
    *(uint64_t *)o->value = (uint64_t)value;
    return GO_ON;
}

static int set_quantity(const command_usage *u, const option *o, const char *text) {
    double *value = o->value;
    const char *wrong = ptie_parse_quantity(text, o->quantity, value);
    if (wrong && o->quantity == PTIE_RATE && !ptie_parse_quantity(text, PTIE_NUMBER, value))
        return GO_ON;
    return wrong ? wrong_value(u, o, wrong, text) : GO_ON;
}

static int set_choice(const command_usage *u, const option *o, const char *text) {
    for (int i = 0; o->choices[i]; i++) {
        if (strcmp(o->choices[i], text) != 0) continue;
        *(int *)o->value = i;
        return GO_ON;
    }
    return misused("%s: --%s: unknown value '%s' (did you mean '%s'?)", u->name, o->name, text,
                   ptie_nearest_word(text, o->choices));
}

/* Whole numbers of 0 or more, between separators; how many there are, 0 if anything else is in the
 * text. */
static int32_t parse_numbers(const char *text, char separator, int32_t *value, int32_t most) {
    for (int32_t n = 0; n < most; n++) {
        char *end;
        long number = strtol(text, &end, 10);
        if (end == text || *text == '-' || number > 1000000000) return 0;
        value[n] = (int32_t)number;
        if (!*end) return n + 1;
        if (*end != separator) return 0;
        text = end + 1;
    }
    return 0;
}

static int set_size(const command_usage *u, const option *o, const char *text) {
    int32_t side[2];
    int32_t count = parse_numbers(text, 'x', side, 2);
    if (count == 0) return wrong_value(u, o, "a size such as 256 or 320x240", text);
    *(frame_size *)o->value = (frame_size){side[0], side[count - 1]};
    return GO_ON;
}

static int set_rect(const command_usage *u, const option *o, const char *text) {
    int32_t value[4];
    if (parse_numbers(text, ',', value, 4) != 4)
        return wrong_value(u, o, "a rectangle x,y,width,height in pixels", text);
    *(ptie_rect *)o->value = (ptie_rect){value[0], value[1], value[2], value[3]};
    return GO_ON;
}

/* A number of 0 or more up to a colon or the end; nothing leaves *value.  Returns what follows, NULL if it is
 * something else. */
static const char *take_frame(const char *text, int64_t *value) {
    if (*text < '0' || *text > '9') return text;
    char *end;
    errno = 0;
    *value = strtoll(text, &end, 10);
    return errno ? NULL : end;
}

static int set_frames(const command_usage *u, const option *o, const char *text) {
    ptie_frame_range range = {.step = 1};
    const char *at = take_frame(text, &range.first);
    if (at && at > text && !*at && range.first < INT64_MAX) {
        range.end = range.first + 1; /* one frame */
    } else {
        int64_t end = INT64_MAX;
        at = at && *at == ':' ? take_frame(at + 1, &end) : NULL;
        if (at && *at == ':') at = take_frame(at + 1, &range.step);
        range.end = end == INT64_MAX ? 0 : end;
        if (!at || *at || end <= range.first || range.step < 1) at = NULL;
    }
    if (!at) return wrong_value(u, o, "frames a:b:step, b not included, such as 0:100:2", text);
    *(ptie_frame_range *)o->value = range;
    return GO_ON;
}

static int set_range(const command_usage *u, const option *o, const char *text) {
    char *middle, *end;
    value_range range = {.low = strtod(text, &middle)};
    if (middle > text && *middle == ':') {
        range.high = strtod(middle + 1, &end);
        if (end > middle + 1 && !*end && isfinite(range.low) && isfinite(range.high) &&
            range.low < range.high) {
            *(value_range *)o->value = range;
            return GO_ON;
        }
    }
    return wrong_value(u, o, "values low:high, such as -0.5:2", text);
}

static int set_list(const command_usage *u, const option *o, const char *text) {
    number_list list;
    list.count = parse_numbers(text, ',', list.value, LONGEST_LIST);
    if (list.count == 0) return wrong_value(u, o, "numbers such as 8,16,32", text);
    *(number_list *)o->value = list;
    return GO_ON;
}

static int set_value(const command_usage *u, operand_list *operands, const option *o,
                     const char *text) {
    operands->given |= UINT64_C(1) << (o - u->options);
    switch (o->kind) {
    case OPTION_FLAG: *(bool *)o->value = true; return GO_ON;
    case OPTION_TEXT: *(const char **)o->value = text; return GO_ON;
    case OPTION_INT32: return set_whole(u, o, text, o->high);
    case OPTION_INT64: return set_whole(u, o, text, o->high);
    case OPTION_SEED: return set_seed(u, o, text);
    case OPTION_QUANTITY: return set_quantity(u, o, text);
    case OPTION_CHOICE: return set_choice(u, o, text);
    case OPTION_SIZE: return set_size(u, o, text);
    case OPTION_RECT: return set_rect(u, o, text);
    case OPTION_FRAMES: return set_frames(u, o, text);
    case OPTION_RANGE: return set_range(u, o, text);
    case OPTION_LIST: return set_list(u, o, text);
    }
    return GO_ON;
}

static int unknown_option(const command_usage *u, const char *name) {
    const char *names[64] = {0};
    for (size_t i = 0; i < u->count; i++) names[i] = u->options[i].name;
    names[u->count] = "help";
    return misused("%s: unknown option '--%s' (did you mean '--%s'?)", u->name, name,
                   ptie_nearest_word(name, names));
}

/* "--name", "--name value" or "--name=value"; *i moves to the last argument that was used. */
static int parse_long(const command_usage *u, operand_list *operands, int argc, char **argv,
                      int *i) {
    char name[64];
    const char *text = argv[*i] + 2, *equals = strchr(text, '=');
    size_t length = equals ? (size_t)(equals - text) : strlen(text);
    snprintf(name, sizeof name, "%.*s", (int)length, text);
    if (strcmp(name, "help") == 0) return print_help(u);
    for (size_t k = 0; k < u->count; k++) {
        const option *o = &u->options[k];
        if (strcmp(o->name, name) != 0) continue;
        if (o->kind == OPTION_FLAG && equals)
            return misused("%s: option '--%s' takes no value", u->name, name);
        if (o->kind == OPTION_FLAG) return set_value(u, operands, o, NULL);
        if (!equals && *i + 1 == argc)
            return misused("%s: option '--%s' needs a value (%s)", u->name, name, o->argument);
        return set_value(u, operands, o, equals ? equals + 1 : argv[++*i]);
    }
    return unknown_option(u, name);
}

/* "-f", "-fT 2", "-T2". */
static int parse_short(const command_usage *u, operand_list *operands, int argc, char **argv,
                       int *i) {
    for (const char *letter = argv[*i] + 1; *letter; letter++) {
        if (*letter == 'h') return print_help(u);
        const option *o = NULL;
        for (size_t k = 0; k < u->count && !o; k++)
            if (u->options[k].letter == *letter) o = &u->options[k];
        if (!o)
            return misused("%s: unknown option '-%c' (see 'ptie help %s')", u->name, *letter,
                           u->name);
        if (o->kind == OPTION_FLAG) {
            (void)set_value(u, operands, o, NULL);
            continue;
        }
        if (letter[1]) return set_value(u, operands, o, letter + 1);
        if (*i + 1 == argc)
            return misused("%s: option '-%c' needs a value (%s)", u->name, *letter, o->argument);
        return set_value(u, operands, o, argv[++*i]);
    }
    return GO_ON;
}

static int add_operand(const command_usage *u, operand_list *operands, const char *text) {
    if (operands->count < u->most && operands->count < MOST_OPERANDS) {
        operands->value[operands->count++] = text;
        return GO_ON;
    }
    return misused("%s: too many arguments (expected at most %d, found '%s')", u->name, u->most,
                   text);
}

int parse_options(const command_usage *u, int argc, char **argv, operand_list *operands) {
    bool ended = false;
    operands->count = 0;
    operands->given = 0;
    for (int i = 1; i < argc; i++) {
        int code;
        const char *text = argv[i];
        if (ended || text[0] != '-' || !text[1])
            code = add_operand(u, operands, text);
        else if (strcmp(text, "--") == 0)
            code = GO_ON, ended = true;
        else if (text[1] == '-')
            code = parse_long(u, operands, argc, argv, &i);
        else
            code = parse_short(u, operands, argc, argv, &i);
        if (code != GO_ON) return code;
    }
    if (operands->count >= u->least) return GO_ON;
    return misused("%s: missing %s (see 'ptie help %s')", u->name, u->operand, u->name);
}

bool was_given(const command_usage *u, const operand_list *operands, const char *name) {
    for (size_t i = 0; i < u->count; i++)
        if (strcmp(u->options[i].name, name) == 0) return operands->given >> i & 1;
    return false;
}
