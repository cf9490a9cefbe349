/* SPDX-License-Identifier: BSD-3-Clause */
/* What the commands share: exit codes, messages, options that mean the same everywhere. */
#ifndef CLI_CLI_H
#define CLI_CLI_H

#include <ptie/ptie.h>

#include "options.h"
#include "progress.h"

/* Exit codes. */
enum { DONE = 0, FAILED = 1, MISUSED = 2 }; /* and 128 + signal after Ctrl-C */

enum { PATH_BYTES = 4096 };

typedef struct command {
    const char *name, *summary;
    int (*run)(int argc, char **argv); /* argv[0] is the command's name */
} command;

int simulate_command(int argc, char **argv);
int dataset_command(int argc, char **argv);
int train_command(int argc, char **argv);
int evaluate_command(int argc, char **argv);
int reconstruct_command(int argc, char **argv);
int denoise_command(int argc, char **argv);
int run_command(int argc, char **argv);
int report_command(int argc, char **argv);
int prepare_command(int argc, char **argv);
int rig_command(int argc, char **argv);
int metrics_command(int argc, char **argv);
int convert_command(int argc, char **argv);
int info_command(int argc, char **argv);
int bench_command(int argc, char **argv);

/* One line on stderr, "ptie: ...".  Returns MISUSED. */
int misused(const char *format, ...) PTIE_PRINTF(1, 2);
/* Tells the library's last error; returns the exit code that belongs to the status. */
int failed(ptie_status status);
/* A message for people, on stderr. */
void say(const char *format, ...) PTIE_PRINTF(1, 2);

/* Options of commands that compute. */
typedef struct compute_options {
    int32_t threads;
    const char *cpu;
    int progress; /* progress_style */
    bool force;
} compute_options;

/* clang-format off */
#define COMPUTE_DEFAULTS {.cpu = "auto", .progress = PROGRESS_AUTO}
#define COMPUTE_OPTIONS(c)                                                                         \
    {'f', "force", OPTION_FLAG, &(c).force, .help = "replace existing output"},                    \
    {'T', "threads", OPTION_INT32, &(c).threads, "N", .low = 0, .high = 256,                       \
     .help = "worker threads; 0 = all processors"},                                                \
    {0, "cpu", OPTION_TEXT, &(c).cpu, "LEVEL", .help = "auto, scalar, avx2 or avx512"},            \
    {0, "progress", OPTION_CHOICE, &(c).progress, "HOW", .choices = progress_styles,               \
     .help = "on stderr; auto is a bar on a terminal"}

/* Planes in files of their own; `plane` is const char *[PTIE_ROLES]. */
#define PLANE_OPTIONS(plane)                                                                       \
    {0, "plus", OPTION_TEXT, &(plane)[PTIE_PLUS], "FILE",                                          \
     .help = "planes in files of their own: beyond focus"},                                        \
    {0, "minus", OPTION_TEXT, &(plane)[PTIE_MINUS], "FILE", .help = "before focus"},               \
    {0, "zero", OPTION_TEXT, &(plane)[PTIE_ZERO], "FILE", .help = "in focus"},                     \
    {0, "plus2", OPTION_TEXT, &(plane)[PTIE_PLUS2], "FILE", .help = "farther beyond focus"},       \
    {0, "minus2", OPTION_TEXT, &(plane)[PTIE_MINUS2], "FILE", .help = "farther before focus"}
/* clang-format on */

/* Starts the library. */
ptie_status open_context(ptie_ctx **ctx, const compute_options *compute);

/* The command line as one string, to keep in output files.  malloc'ed; NULL without memory. */
char *joined_command(int argc, char **argv);

/* `path` with its ending replaced, "jet.h5" -> "jet.ini"; false when it does not fit. */
bool replace_ending(char *out, size_t bytes, const char *path, const char *ending);

bool ends_in(const char *path, const char *ending); /* upper or lower case */

/* Finds out before long work whether a figure can be written after it.  GO_ON, or the exit code
   after a message; fine with NULL. */
int check_figure(const char *path, bool force);

#endif
