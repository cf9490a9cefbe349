/* SPDX-License-Identifier: BSD-3-Clause */
#include "help.h"

#include <stdio.h>
#include <string.h>

#include "cli.h"

#define COLUMNS 79
#define INDENT 28 /* where the help of options begins */

/* Breaks text into lines between `left` and COLUMNS; the cursor is at `column`. */
static void print_wrapped(const char *text, int left, int column) {
    bool first = true;
    while (*text) {
        int word = (int)strcspn(text, " ");
        if (!first && column + 1 + word > COLUMNS) {
            printf("\n%*s", left, "");
            column = left;
        } else if (!first) {
            putchar(' ');
            column++;
        }
        printf("%.*s", word, text);
        column += word;
        text += word;
        text += strspn(text, " ");
        first = false;
    }
    putchar('\n');
}

/* What is used when the option is not given; "" if nothing worth telling. */
static void default_text(char *text, size_t bytes, const option *o) {
    char quantity[PTIE_QUANTITY_BYTES];
    text[0] = 0;
    switch (o->kind) {
    case OPTION_TEXT:
        if (*(const char **)o->value) snprintf(text, bytes, "%s", *(const char **)o->value);
        break;
    case OPTION_INT32: snprintf(text, bytes, "%ld", (long)*(int32_t *)o->value); break;
    case OPTION_INT64: snprintf(text, bytes, "%lld", (long long)*(int64_t *)o->value); break;
    case OPTION_SEED:
        snprintf(text, bytes, "%llu", (unsigned long long)*(uint64_t *)o->value);
        break;
    case OPTION_QUANTITY:
        if (*(double *)o->value == 0)
            snprintf(text, bytes, "0");
        else
            snprintf(text, bytes, "%s",
                     ptie_print_quantity(quantity, *(double *)o->value, o->quantity));
        break;
    case OPTION_CHOICE: snprintf(text, bytes, "%s", o->choices[*(int *)o->value]); break;
    case OPTION_SIZE: {
        const frame_size *size = o->value;
        if (size->width) snprintf(text, bytes, "%dx%d", size->width, size->height);
        break;
    }
    case OPTION_LIST: {
        const number_list *list = o->value;
        size_t used = 0;
        for (int32_t i = 0; i < list->count && used < bytes; i++)
            used +=
                (size_t)snprintf(text + used, bytes - used, "%s%d", i ? "," : "", list->value[i]);
        break;
    }
    case OPTION_FLAG:
    case OPTION_FRAMES:
    case OPTION_RANGE:
    case OPTION_RECT: break;
    }
}

/* " (a, b, c; default: a)" */
static void append_values(char *text, size_t bytes, const option *o) {
    char value[128];
    default_text(value, sizeof value, o);
    if (!value[0]) return;
    size_t used = strlen(text);
    used += (size_t)snprintf(text + used, bytes - used, " (");
    for (int i = 0; o->choices && o->choices[i]; i++)
        used += (size_t)snprintf(text + used, bytes - used, "%s%s", o->choices[i],
                                 o->choices[i + 1] ? ", " : "; ");
    snprintf(text + used, bytes - used, "default: %s)", value);
}

static void print_option(const option *o) {
    char text[1024];
    int column = printf("  %c%c%s--%s%s%s", o->letter ? '-' : ' ', o->letter ? o->letter : ' ',
                        o->letter ? ", " : "  ", o->name, o->argument ? " " : "",
                        o->argument ? o->argument : "");
    if (column > INDENT - 2) column = 0, putchar('\n');
    printf("%*s", INDENT - column, "");
    snprintf(text, sizeof text, "%s", o->help);
    append_values(text, sizeof text, o);
    print_wrapped(text, INDENT, INDENT);
}

int print_help(const command_usage *u) {
    print_wrapped(u->purpose, 0, 0);
    printf("\nExamples:\n%s\nUsage:\n  ptie %s %s\n\nOptions:\n", u->examples, u->name,
           u->synopsis);
    for (size_t i = 0; i < u->count; i++) print_option(&u->options[i]);
    printf("  %-*sthis text\n", INDENT - 2, "-h, --help");
    if (u->notes) printf("\n%s", u->notes);
    return DONE;
}
