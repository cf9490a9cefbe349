/* SPDX-License-Identifier: BSD-3-Clause */
/* ptie denoise: a recording of phase -> denoised phase. */
#include "cli.h"

static const char *const polarities[] = {"negative", "auto", "positive", NULL}; /* index - 1 */

static const char examples[] =
    "  ptie denoise phase.h5 --model models/paper.safetensors -o denoised.h5\n\n"
    "  # hot gas has negative phase; TIFF in, TIFF out\n"
    "  ptie denoise phase.tif --model m.safetensors -o denoised.tif \\\n"
    "      --polarity negative\n";

static const char notes[] =
    "Reads and writes HDF5, TIFF, NPY and PNG (a pattern with one %d for several\n"
    "frames); the ending of the output decides. Values are taken as rad.\n";

typedef struct settings {
    compute_options compute;
    const char *model, *input, *output;
    int polarity;
    bool fast;
} settings;

static int parse(settings *s, int argc, char **argv) {
    const option options[] = {
        {'m', "model", OPTION_TEXT, &s->model, "FILE", .help = "denoising network (.safetensors)"},
        {'o', "output", OPTION_TEXT, &s->output, "FILE",
         .help = "recording to write (.h5, .tif, .npy, .png)"},
        {0, "polarity", OPTION_CHOICE, &s->polarity, "SIGN", .choices = polarities,
         .help = "sign of the flow's phase; auto judges every frame"},
        {0, "fast", OPTION_FLAG, &s->fast, .help = "half precision where available; less exact"},
        COMPUTE_OPTIONS(s->compute),
    };
    const command_usage usage = {.name = "denoise",
                                 .purpose = "Denoises a recording of phase, in rad.",
                                 .examples = examples,
                                 .synopsis = "PHASE --model FILE -o FILE [options]",
                                 .notes = notes,
                                 .least = 1,
                                 .most = 1,
                                 .operand = "PHASE",
                                 .options = options,
                                 .count = COUNT(options)};
    operand_list operands;
    int code = parse_options(&usage, argc, argv, &operands);
    if (code != GO_ON) return code;
    s->input = operands.value[0];
    if (!s->model) return misused("denoise: missing model (expected --model FILE.safetensors)");
    if (!s->output) return misused("denoise: missing output (expected -o FILE)");
    return GO_ON;
}

static ptie_status denoise(const settings *s) {
    progress_bar progress;
    ptie_denoise_params params;
    ptie_ctx *ctx = NULL;
    ptie_model *model = NULL;
    ptie_denoise_params_init(&params);
    progress_start(&progress, s->compute.progress, "denoise", "frames");
    ptie_status status = ptie_model_load(&model, s->model);
    if (status == PTIE_OK) status = open_context(&ctx, &s->compute);
    if (status == PTIE_OK) {
        params.model = model;
        params.input = s->input;
        params.output = s->output;
        params.polarity = s->polarity - 1;
        params.fast = s->fast;
        params.overwrite = s->compute.force;
        status = ptie_denoise(ctx, &params, progress_callback(&progress));
    }
    progress_end(&progress);
    ptie_ctx_free(ctx);
    ptie_model_free(model);
    return status;
}

int denoise_command(int argc, char **argv) {
    settings s = {.compute = COMPUTE_DEFAULTS, .polarity = 1};
    int code = parse(&s, argc, argv);
    if (code != GO_ON) return code;
    ptie_status status = denoise(&s);
    if (status != PTIE_OK) return failed(status);
    say("%s: denoised phase of %s", s.output, s.input);
    return DONE;
}
