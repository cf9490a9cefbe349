/* SPDX-License-Identifier: BSD-3-Clause */
/* The program: finds the command and runs it. */
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "cli.h"

static const command commands[] = {
    {"simulate", "a synthetic camera recording of a moving flow, with its truth", simulate_command},
    {"dataset", "pairs of clean and noisy phase for training", dataset_command},
    {"train", "data set or preset -> model", train_command},
    {"evaluate", "how well a model denoises data that it has not seen", evaluate_command},
    {"reconstruct", "recording -> phase", reconstruct_command},
    {"denoise", "phase -> denoised phase", denoise_command},
    {"run", "recording -> phase -> denoised phase -> metrics, in one pass", run_command},
    {"report", "the result of a run as one page: maps, metrics, noise, parameters", report_command},
    {"metrics", "MGM, SBR, BNS and CNR over frames and regions", metrics_command},
    {"convert", "a recording as another kind of file, or a part of it", convert_command},
    {"prepare", "recording -> planes, as the solver sees them or after any step", prepare_command},
    {"rig", "rig files: how a set-up is built", rig_command},
    {"info", "what is in a file, a model, a preset, this machine", info_command},
    {"bench", "how fast all of it is on this machine", bench_command},
};

static void print_line(const char *prefix, const char *format, va_list arguments) {
    fputs(prefix, stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
}

int misused(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    print_line("ptie: ", format, arguments);
    va_end(arguments);
    return MISUSED;
}

void say(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    print_line("", format, arguments);
    va_end(arguments);
}

/* The library's messages may begin with the name of the function that was called, which users never
 * see. */
static const char *without_function(const char *message) {
    size_t name = strspn(message, "abcdefghijklmnopqrstuvwxyz_");
    bool is_function = strncmp(message, "ptie_", 5) == 0 && strncmp(message + name, ": ", 2) == 0;
    return is_function ? message + name + 2 : message;
}

int failed(ptie_status status) {
    if (status == PTIE_ECANCELLED && interrupted()) {
        say("ptie: interrupted");
        return 128 + interrupted();
    }
    /* Memory that the program itself did not get leaves no message in the library. */
    const char *message = ptie_last_error();
    say("ptie: %s", *message ? without_function(message) : "out of memory");
    return status == PTIE_EINVAL || status == PTIE_ENAME ? MISUSED : FAILED;
}

ptie_status open_context(ptie_ctx **ctx, const compute_options *c) {
    ptie_ctx_params params;
    ptie_ctx_params_init(&params);
    params.threads = c->threads;
    params.cpu = c->cpu;
    return ptie_ctx_create(ctx, &params);
}

char *joined_command(int argc, char **argv) {
    char *line = NULL;
    size_t bytes;
    FILE *out = open_memstream(&line, &bytes);
    if (!out) return NULL;
    fputs("ptie", out);
    for (int i = 0; i < argc; i++) {
        const char *quote = argv[i][0] && !strpbrk(argv[i], " \t\n'\"\\$&|;<>()*?[]#~") ? "" : "'";
        fprintf(out, " %s%s%s", quote, argv[i], quote);
    }
    fclose(out);
    return line;
}

bool replace_ending(char *out, size_t bytes, const char *path, const char *ending) {
    const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
    size_t stem =
        dot && dot > path && (!slash || dot > slash + 1) ? (size_t)(dot - path) : strlen(path);
    return (size_t)snprintf(out, bytes, "%.*s%s", (int)stem, path, ending) < bytes;
}

bool ends_in(const char *path, const char *ending) {
    size_t length = strlen(path), tail = strlen(ending);
    return length > tail && strcasecmp(path + length - tail, ending) == 0;
}

int check_figure(const char *path, bool force) {
    if (!path) return GO_ON;
    if (!ends_in(path, ".png") && !ends_in(path, ".svg"))
        return misused("%s: not a kind of figure (expected a name ending in .png or .svg)", path);
    const char *slash = strrchr(path, '/');
    char folder[PATH_BYTES];
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - path) + 1 : 1,
             slash ? path : ".");
    if (access(folder, W_OK) != 0) {
        say("ptie: %s: cannot create: %s", path, strerror(errno));
        return FAILED;
    }
    if (force || access(path, F_OK) != 0) return GO_ON;
    say("ptie: %s: exists already (use -f to overwrite)", path);
    return FAILED;
}

static const command *find_command(const char *name) {
    for (size_t i = 0; i < COUNT(commands); i++)
        if (strcmp(commands[i].name, name) == 0) return &commands[i];
    return NULL;
}

static int unknown_command(const char *name) {
    const char *names[COUNT(commands) + 1] = {0};
    for (size_t i = 0; i < COUNT(commands); i++) names[i] = commands[i].name;
    return misused("unknown command '%s' (did you mean '%s'?)", name,
                   ptie_nearest_word(name, names));
}

static int print_overview(void) {
    printf("ptie " PTIE_VERSION_STRING
           ": from parallel-TIE recordings to quantitative, denoised phase\n\n"
           "  ptie run --rig lab.ini recording.h5 --model paper.safetensors -o phase.h5\n\n"
           "Commands:\n");
    for (size_t i = 0; i < COUNT(commands); i++)
        printf("  %-13s%s\n", commands[i].name, commands[i].summary);
    printf("\n'ptie help COMMAND' shows examples and options of a command.\n");
    return DONE;
}

static int help(int argc, char **argv) {
    if (argc < 2) return print_overview();
    const command *found = find_command(argv[1]);
    char help_option[] = "--help", *arguments[] = {argv[1], help_option, NULL};
    return found ? found->run(2, arguments) : unknown_command(argv[1]);
}

static int print_version(void) {
    printf("ptie %s\n", ptie_version());
    return DONE;
}

static int dispatch(int argc, char **argv) {
    const char *name = argc > 1 ? argv[1] : "help";
    if (strcmp(name, "--version") == 0 || strcmp(name, "-V") == 0) return print_version();
    if (strcmp(name, "help") == 0 || strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0)
        return help(argc - 1, argv + 1);
    const command *found = find_command(name);
    if (found) return found->run(argc - 1, argv + 1);
    if (name[0] == '-') return misused("unknown option '%s' (see 'ptie help')", name);
    return unknown_command(name);
}

int main(int argc, char **argv) {
    if (strcmp(ptie_version(), PTIE_VERSION_STRING) != 0) {
        say("ptie: built for library version %s, but running with %s", PTIE_VERSION_STRING,
            ptie_version());
        return FAILED;
    }
    catch_interrupts();
    int code = dispatch(argc, argv);
    if (fflush(stdout) == 0 && !ferror(stdout)) return code;
    say("ptie: cannot write to standard output");
    return code ? code : FAILED;
}
