/* SPDX-License-Identifier: BSD-3-Clause */
/* ptie convert: a recording as another kind of file. */
#include <stdlib.h>

#include "cli.h"

static const char *const colours[] = {"grey", "viridis", "diverging", NULL}; /* ptie_colormap */

static const char examples[] =
    "  # what the camera wrote, for Python and MATLAB\n"
    "  ptie convert shot.cihx shot.h5 --compress\n\n"
    "  # phase as a stack for Fiji, with scale and frame interval\n"
    "  ptie convert phase.h5 phase.tif\n\n"
    "  # every second frame of the first 100, a rectangle of each\n"
    "  ptie convert phase.h5 part.npy --frames 0:100:2 --roi 64,0,128,256\n\n"
    "  # images with one grey scale for all\n"
    "  ptie convert phase.h5 flow_%04d.png --range -1:3\n\n"
    "  # a film for slides, blue below 0 and red above\n"
    "  ptie convert phase.h5 flow.mp4 --colours diverging --fps 10\n\n"
    "  # for MATLAB and Octave\n"
    "  ptie convert phase.h5 phase.mat --frames 0:50\n";

static const char notes[] =
    "INPUT is anything 'ptie info' knows as a recording: MRAW (.mraw, .cihx), CINE,\n"
    "HDF5 (FILE.h5 or FILE.h5:/path/inside), TIFF, MAT, NPY, PNG, raw, a folder of\n"
    "numbered images, or a pattern with one %d. The ending of OUTPUT decides what is\n"
    "written: .h5 .tif .npy .mat .mraw .png (a pattern with one %d for several\n"
    "frames) .y4m, and .mp4 where the program ffmpeg is installed. Integers of up to\n"
    "16 bits stay integers, everything else becomes float32. Unit, pixel, frame rate\n"
    "and frame numbers go along where the kind of file has a place for them.\n";

typedef struct settings {
    compute_options compute;
    const char *input, *output;
    ptie_frame_range frames;
    ptie_rect roi;
    value_range range;
    int colours;
    double played_hz;
    bool compress;
} settings;

static int parse(settings *s, int argc, char **argv) {
    const option options[] = {
        {0, "frames", OPTION_FRAMES, &s->frames, "A:B:STEP", .help = "frames to take, B not included"},
        {0, "roi", OPTION_RECT, &s->roi, "x,y,w,h", .help = "rectangle to take, pixels"},
        {0, "range", OPTION_RANGE, &s->range, "LOW:HIGH",
         .help = "values of black and white in images and video; if not given, the extent of each image, of the "
                 "whole video"},
        {0, "colours", OPTION_CHOICE, &s->colours, "MAP", .choices = colours, .help = "of video"},
        {0, "fps", OPTION_QUANTITY, &s->played_hz, "RATE", .quantity = PTIE_RATE,
         .help = "of video: frames per second when shown"},
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
    params.frames = s->frames;
    params.roi = s->roi;
    params.low = s->range.low;
    params.high = s->range.high;
    params.colours = (ptie_colormap)s->colours;
    params.played_hz = s->played_hz;
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
    settings s = {.compute = COMPUTE_DEFAULTS, .frames = {.step = 1}, .played_hz = 25};
    int code = parse(&s, argc, argv);
    if (code != GO_ON) return code;
    char *provenance = joined_command(argc, argv);
    ptie_status status = convert(&s, provenance);
    free(provenance);
    if (status != PTIE_OK) return failed(status);
    say("%s: from %s", s.output, s.input);
    return DONE;
}
