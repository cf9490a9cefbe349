/* SPDX-License-Identifier: BSD-3-Clause */
/* ptie convert: a recording as another kind of file. */
#include <stdlib.h>

#include "cli.h"

static const char examples[] =
    "  # what the camera wrote, for Python and MATLAB; a third of the size\n"
    "  ptie convert shot.h5 small.h5 --compress\n\n"
    "  # phase as a stack for Fiji, with scale and frame interval\n"
    "  ptie convert phase.h5 phase.tif\n\n"
    "  # every second of the first 100 frames, a rectangle of them\n"
    "  ptie convert phase.h5 part.npy --frames 0:100:2 --roi 64,0,128,256\n\n"
    "  # images with one grey scale for all\n"
    "  ptie convert phase.h5 flow_%04d.png --range -1:3\n";

static const char notes[] =
    "INPUT is anything 'ptie info' knows as a recording: HDF5 (FILE.h5 or\n"
    "FILE.h5:/path/inside), TIFF, NPY, PNG, a folder of numbered images, or a\n"
    "pattern with one %d. The ending of OUTPUT decides what is written: .h5 .tif\n"
    ".npy .png (a pattern with one %d for several frames). Integers of up to 16\n"
    "bits stay integers, everything else becomes float32.\n";

typedef struct settings {
    compute_options compute;
    const char *input, *output;
    ptie_frame_range frames;
    ptie_rect roi;
    value_range range;
    bool compress;
} settings;

static int parse(settings *s, int argc, char **argv) {
    const option options[] = {
        {0, "frames", OPTION_FRAMES, &s->frames, "A:B:STEP", .help = "frames to take, B not included"},
        {0, "roi", OPTION_RECT, &s->roi, "x,y,w,h", .help = "rectangle to take, pixels"},
        {0, "range", OPTION_RANGE, &s->range, "LOW:HIGH",
         .help = "PNG: values of black and white, instead of each frame's own"},
        {0, "compress", OPTION_FLAG, &s->compress, .help = "HDF5: shuffled and deflated"},
        COMPUTE_OPTIONS(s->compute),
    };
    const command_usage usage = {.name = "convert",
                                 .purpose = "Writes a recording as another kind of file, or a part of it.",
                                 .examples = examples,
                                 .synopsis = "INPUT OUTPUT [options]",
                                 .notes = notes,
                                 .least = 2,
                                 .most = 2,
                                 .operand = "INPUT or OUTPUT",
                                 .options = options,
                                 .count = COUNT(options)};
    operand_list operands;
    int code = parse_options(&usage, argc, argv, &operands);
    if (code != GO_ON) return code;
    s->input = operands.value[0];
    s->output = operands.value[1];
    return GO_ON;
}

static ptie_status convert(const settings *s, const char *provenance) {
    progress_bar progress;
    ptie_convert_params params;
    ptie_ctx *ctx;
    ptie_status status = open_context(&ctx, &s->compute);
    if (status != PTIE_OK) return status;
    ptie_convert_params_init(&params);
    params.input = s->input;
    params.output = s->output;
    params.first = s->frames.first;
    params.count = frames_in(s->frames);
    params.step = s->frames.step;
    params.roi = s->roi;
    params.low = s->range.low;
    params.high = s->range.high;
    params.compress = s->compress;
    params.overwrite = s->compute.force;
    params.provenance = provenance;
    progress_start(&progress, s->compute.progress, "convert", "frames");
    status = ptie_convert(ctx, &params, progress_callback(&progress));
    progress_end(&progress);
    ptie_ctx_free(ctx);
    return status;
}

int convert_command(int argc, char **argv) {
    settings s = {.compute = COMPUTE_DEFAULTS, .frames = {.step = 1}};
    int code = parse(&s, argc, argv);
    if (code != GO_ON) return code;
    char *provenance = joined_command(argc, argv);
    ptie_status status = convert(&s, provenance);
    free(provenance);
    if (status != PTIE_OK) return failed(status);
    say("%s: from %s", s.output, s.input);
    return DONE;
}
