/* SPDX-License-Identifier: BSD-3-Clause */
/* Options of a command as a table: the table parses the command line and prints the help. */
#ifndef CLI_OPTIONS_H
#define CLI_OPTIONS_H

#include <ptie/run.h>
#include <ptie/text.h>

typedef enum option_kind {
    OPTION_FLAG,     /* bool */
    OPTION_TEXT,     /* const char * */
    OPTION_INT32,    /* int32_t, low..high */
    OPTION_INT64,    /* int64_t, low..high */
    OPTION_SEED,     /* uint64_t */
    OPTION_QUANTITY, /* double with the unit of `quantity`; a plain number is a rate in Hz */
    OPTION_CHOICE,   /* int: index into `choices` */
    OPTION_SIZE,     /* frame_size: "256" or "320x240" */
    OPTION_RECT,     /* ptie_rect: "x,y,w,h" */
    OPTION_FRAMES,   /* ptie_frame_range: "a:b:step" as Python slices, "7" for one frame */
    OPTION_RANGE,    /* value_range: "low:high" */
    OPTION_LIST      /* number_list: "8,16,32" */
} option_kind;

typedef struct frame_size {
    int32_t width, height;
} frame_size;

typedef struct value_range {
    double low, high; /* equal: not given */
} value_range;

enum { LONGEST_LIST = 16 };
typedef struct number_list {
    int32_t value[LONGEST_LIST], count;
} number_list;

typedef struct option {
    char letter; /* 0: none */
    const char *name;
    option_kind kind;
    void *value;          /* holds the default; help shows it */
    const char *argument; /* "FILE" in help; NULL for flags */
    const char *help;
    int64_t low, high;
    ptie_quantity quantity;
    const char *const *choices; /* NULL-terminated */
} option;

typedef struct command_usage {
    const char *name;     /* of the command */
    const char *purpose;  /* one or more sentences */
    const char *examples; /* lines, already indented */
    const char *synopsis; /* what follows "ptie <name> " */
    const char *notes;    /* paragraphs after the options, or NULL */
    int least, most;      /* operands */
    const char *operand;  /* name of the operands in messages */
    const option *options;
    size_t count;
} command_usage;

enum { MOST_OPERANDS = 64 };
typedef struct operand_list {
    const char *value[MOST_OPERANDS];
    int count;
    uint64_t given; /* bit i: the command line has options[i] of the usage */
} operand_list;

#define GO_ON (-1)

/* Reads argv[1..].  Returns GO_ON, or the exit code: 0 after help, 2 after a message. */
int parse_options(const command_usage *usage, int argc, char **argv, operand_list *operands);

/* Did the command line have the option of this name? */
bool was_given(const command_usage *usage, const operand_list *operands, const char *name);

#define COUNT(array) (sizeof(array) / sizeof *(array))

#endif
