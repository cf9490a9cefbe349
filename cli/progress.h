/* SPDX-License-Identifier: BSD-3-Clause */
/* Progress of long work on stderr, and Ctrl-C. */
#ifndef CLI_PROGRESS_H
#define CLI_PROGRESS_H

#include <ptie/status.h>

typedef enum progress_style {
    PROGRESS_AUTO, /* a bar on a terminal, else nothing */
    PROGRESS_BAR,
    PROGRESS_PLAIN, /* a line every few seconds */
    PROGRESS_JSON,  /* one JSON object per line */
    PROGRESS_NONE
} progress_style;

extern const char *const progress_styles[]; /* their names, NULL-terminated */

typedef struct progress_bar {
    progress_style style;
    const char *task, *unit; /* "dataset", "samples" */
    double start_s, first_s, shown_s; /* of the task, its first report, and the one shown last */
    uint64_t first_done, shown_done;
    bool begun;
    bool on_line; /* the cursor stands behind a bar */
} progress_bar;

/* From here on Ctrl-C asks the running call to stop; a second one ends the process. */
void catch_interrupts(void);
/* The signal that came, or 0. */
int interrupted(void);

/* Starts the clock; style is a progress_style. */
void progress_start(progress_bar *progress, int style, const char *task, const char *unit);
/* For the library: reports to `progress`, and stops the call after Ctrl-C. */
ptie_progress progress_callback(progress_bar *progress);
/* The same as a function, for callbacks that do more. */
int progress_report(void *progress, uint64_t done, uint64_t total, const char *note);
/* Prints a line that stays, above the bar. */
void progress_line(progress_bar *progress, const char *line);
/* Takes the bar away. */
void progress_end(progress_bar *progress);

#endif
