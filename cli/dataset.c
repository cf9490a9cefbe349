/* SPDX-License-Identifier: BSD-3-Clause */
/* ptie dataset: pairs of clean and noisy phase in an HDF5 file. */
#include "cli.h"

static const char examples[] =
    "  # the paper's data set: 20,000 pairs to train, twice 2,500 to judge\n"
    "  ptie dataset --preset paper --count 25000 -o paper.h5\n\n"
    "  # your own distribution: print a preset, edit it, use it\n"
    "  ptie info paper > mine.ini\n"
    "  ptie dataset --preset mine.ini --count 1000 -o mine.h5\n";

static const char notes[] =
    "The file holds /clean and /noisy [N, H, W] in [0, 1] and one data set per\n"
    "parameter. Sample i depends on preset, seed and i only, so the bytes do not\n"
    "depend on the number of threads. 80 % train, 10 % validation, 10 % test, in\n"
    "this order.\n";

int dataset_command(int argc, char **argv) {
    compute_options compute = COMPUTE_DEFAULTS;
    const char *preset_name = "paper", *output = NULL;
    int64_t count = 25000;
    uint64_t seed = 1;
    const option options[] = {
        {'o', "output", OPTION_TEXT, &output, "FILE", .help = "data set to write (.h5)"},
        {'p', "preset", OPTION_TEXT, &preset_name, "NAME",
         .help = "paper, realistic, or an INI file"},
        {'n', "count", OPTION_INT64, &count, "N", .low = 1, .high = INT32_MAX,
         .help = "number of pairs"},
        {0, "seed", OPTION_SEED, &seed, "N", .help = "which samples of the distribution"},
        COMPUTE_OPTIONS(compute),
    };
    const command_usage usage = {.name = "dataset",
                                 .purpose = "Draws pairs of clean and noisy phase from a preset.",
                                 .examples = examples,
                                 .synopsis = "--preset NAME --count N -o FILE.h5 [options]",
                                 .notes = notes,
                                 .options = options,
                                 .count = COUNT(options)};
    operand_list operands;
    int code = parse_options(&usage, argc, argv, &operands);
    if (code != GO_ON) return code;
    if (!output) return misused("dataset: missing output (expected -o FILE.h5)");

    progress_bar progress;
    ptie_ctx *ctx = NULL;
    ptie_preset *preset = NULL;
    progress_start(&progress, compute.progress, "dataset", "samples");
    ptie_status status = ptie_preset_load(&preset, preset_name);
    if (status == PTIE_OK) status = open_context(&ctx, &compute);
    if (status == PTIE_OK)
        status = ptie_dataset_write(ctx, output, preset, seed, (uint64_t)count, compute.force,
                                    progress_callback(&progress));
    progress_end(&progress);
    ptie_ctx_free(ctx);
    ptie_preset_free(preset);
    if (status != PTIE_OK) return failed(status);
    say("%s: %lld pairs of preset %s, seed %llu", output, (long long)count, preset_name,
        (unsigned long long)seed);
    return DONE;
}
