/* SPDX-License-Identifier: BSD-3-Clause */
/* ptie bench: how fast all of it is on this machine. */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "bench_results.h"
#include "cli.h"

static const char examples[] = "  # everything; about two minutes\n"
                               "  ptie bench\n\n"
                               "  # the network alone, measured longer, on one thread\n"
                               "  ptie bench --only inference,training --time 5s --threads 1\n\n"
                               "  # the kernels of another instruction set, as JSON\n"
                               "  ptie bench --only peak,kernels --cpu avx2 --json -\n";

static const char notes[] =
    "Groups: peak, kernels, family, inference, training, generation, solving, run.\n"
    "Median and range over the samples of a measurement. GFLOP/s count the\n"
    "operations of the direct formulas, a multiply-add as two; their share is that\n"
    "of the machine's best rate of multiply-adds on as many threads, measured after\n"
    "every sample. Nothing else should run meanwhile.\n";

typedef struct settings {
    compute_options compute;
    ptie_bench_params bench;
    const char *json;
    bool markdown;
} settings;

static bool to_stdout(const char *path) {
    return path && strcmp(path, "-") == 0;
}

static int parse(settings *s, int argc, char **argv) {
    const option options[] = {
        {0, "only", OPTION_TEXT, &s->bench.groups, "GROUP,...",
         .help = "measure these groups only"},
        {0, "time", OPTION_QUANTITY, &s->bench.seconds, "TIME", .quantity = PTIE_TIME,
         .help = "of one measurement"},
        {0, "json", OPTION_TEXT, &s->json, "FILE",
         .help = "also write the results as JSON; - prints them instead of the table"},
        {0, "markdown", OPTION_FLAG, &s->markdown, .help = "print the table as Markdown"},
        COMPUTE_OPTIONS(s->compute),
    };
    const command_usage usage = {
        .name = "bench",
        .purpose = "Measures how fast this machine is at every part: kernels, inference, "
                   "training, generation, solving, the whole pipeline.",
        .examples = examples,
        .synopsis = "[options]",
        .notes = notes,
        .options = options,
        .count = COUNT(options)};
    operand_list operands;
    return parse_options(&usage, argc, argv, &operands);
}

static ptie_status measure(settings *s, bench_results *b) {
    progress_bar progress;
    ptie_ctx *ctx;
    ptie_status status = open_context(&ctx, &s->compute);
    if (status != PTIE_OK) return status;
    ptie_machine_describe(&b->machine);
    b->level = ptie_ctx_cpu(ctx);
    b->threads = ptie_ctx_threads(ctx);
    b->seconds = s->bench.seconds;
    progress_start(&progress, s->compute.progress, "bench", "measurements");
    status = ptie_bench_run(ctx, &s->bench, &b->results, &b->count, progress_callback(&progress));
    progress_end(&progress);
    ptie_ctx_free(ctx);
    return status;
}

/* The JSON file, whole or not at all: opened before the work, so that nothing is measured in vain.
 */
typedef struct json_file {
    const char *path;
    char part[PATH_BYTES];
    FILE *out;
} json_file;

static int open_json(json_file *file, const char *path, bool force) {
    file->path = path;
    if (!path) return GO_ON;
    if (!force && access(path, F_OK) == 0) {
        say("ptie: %s: exists already (use -f to overwrite)", path);
        return FAILED;
    }
    if (snprintf(file->part, sizeof file->part, "%s.part", path) >= (int)sizeof file->part)
        return misused("bench: name of the output too long");
    file->out = fopen(file->part, "w");
    if (file->out) return GO_ON;
    say("ptie: %s: cannot create: %s", path, strerror(errno));
    return FAILED;
}

/* `good`: what was written is complete. */
static int close_json(json_file *file, bool good) {
    if (!file->out) return DONE;
    good = !ferror(file->out) && good;
    good = fclose(file->out) == 0 && good;
    if (good && rename(file->part, file->path) == 0) return DONE;
    if (good) say("ptie: %s: cannot write: %s", file->path, strerror(errno));
    remove(file->part);
    return FAILED;
}

static void print(const settings *s, const bench_results *b, FILE *json) {
    if (json) print_bench_json(json, b);
    if (to_stdout(s->json))
        print_bench_json(stdout, b);
    else
        print_bench_table(b, s->markdown);
}

int bench_command(int argc, char **argv) {
    settings s = {.compute = COMPUTE_DEFAULTS};
    bench_results b = {.count = 0};
    json_file file = {.out = NULL};
    ptie_bench_params_init(&s.bench);
    int code = parse(&s, argc, argv);
    if (code == GO_ON) code = open_json(&file, to_stdout(s.json) ? NULL : s.json, s.compute.force);
    if (code != GO_ON) return code;
    ptie_status status = measure(&s, &b);
    if (status == PTIE_OK) print(&s, &b, file.out);
    code = close_json(&file, status == PTIE_OK);
    ptie_bench_free(b.results);
    return status == PTIE_OK ? code : failed(status);
}
