/* SPDX-License-Identifier: BSD-3-Clause */
/* ptie prepare: the planes of a recording after any step before the solver. */
#include <stdlib.h>

#include "cli.h"

static const char *const steps[] = {"dark", "split",        "mix",  "flat",
                                    "gain", "registration", "mask", NULL};

static const char examples[] =
    "  # what the solver takes\n"
    "  ptie prepare --rig lab.ini flow.mraw -o planes.h5\n\n"
    "  # is the flat field right? the first ten frames before and after it\n"
    "  ptie prepare --rig lab.ini flow.mraw --frames :10 --until mix -o before.h5\n"
    "  ptie prepare --rig lab.ini flow.mraw --frames :10 --until flat -o after.h5\n";

static const char notes[] =
    "The steps, in their order:\n"
    "  dark          sensor images without their dark level\n"
    "  split         the channels of a sensor image, on one grid\n"
    "  mix           planes as the rig's sums of channels\n"
    "  flat          divided by their no-flow reference\n"
    "  gain          times the rig's gains, then scaled to equal means\n"
    "  registration  brought to the grid of I+\n"
    "  mask          opaque regions filled, binned: what the solver takes\n\n"
    "The file has one map over time per image, channel or plane.\n";

typedef struct settings {
    compute_options compute;
    ptie_prepare_params params;
    ptie_frame_range frames;
    const char *rig_path;
    int until;
    ptie_rig rig;
    char *provenance;
} settings;

static int parse(settings *s, int argc, char **argv) {
    ptie_prepare_params *p = &s->params;
    const option options[] = {
        {'r', "rig", OPTION_TEXT, &s->rig_path, "FILE", .help = "how the set-up is built (.ini)"},
        {'o', "output", OPTION_TEXT, &p->output, "FILE", .help = "planes to write (.h5)"},
        {0, "until", OPTION_CHOICE, &s->until, "STEP", .choices = steps, .help = "last step"},
        {0, "frames", OPTION_FRAMES, &s->frames, "a:b:step",
         .help = "frames to take, a Python slice"},
        PLANE_OPTIONS(p->plane),
        {0, "reference", OPTION_TEXT, &p->reference, "FILE",
         .help = "no-flow recording, instead of the rig's"},
        {0, "dark", OPTION_TEXT, &p->dark, "FILE",
         .help = "recording without light, instead of the rig's"},
        {0, "mask", OPTION_TEXT, &p->mask, "FILE",
         .help = "image of what is opaque (0), instead of the rig's"},
        COMPUTE_OPTIONS(s->compute),
    };
    const command_usage usage = {
        .name = "prepare",
        .purpose =
            "Takes a recording to the planes that the solver sees, or to what they are after any "
            "step before.",
        .examples = examples,
        .synopsis = "--rig FILE RECORDING -o FILE.h5 [options]",
        .notes = notes,
        .most = 1,
        .options = options,
        .count = COUNT(options)};
    operand_list files;
    int code = parse_options(&usage, argc, argv, &files);
    if (code != GO_ON) return code;
    if (files.count) p->recording = files.value[0];
    if (!p->recording && !p->plane[PTIE_PLUS])
        return misused("prepare: missing RECORDING (see 'ptie help prepare')");
    if (!s->rig_path) return misused("prepare: missing rig (expected --rig FILE.ini)");
    if (!p->output) return misused("prepare: missing output (expected -o FILE.h5)");
    if (!ends_in(p->output, ".h5") && !ends_in(p->output, ".hdf5"))
        return misused("prepare: --output: expected a name ending in .h5 or .hdf5, found '%s'",
                       p->output);
    p->until = (ptie_step)s->until;
    p->frames = s->frames;
    p->overwrite = s->compute.force;
    return GO_ON;
}

static ptie_status prepare(settings *s) {
    progress_bar progress;
    ptie_ctx *ctx = NULL;
    s->params.rig = &s->rig;
    s->params.provenance = s->provenance;
    progress_start(&progress, s->compute.progress, "prepare", "frames");
    ptie_status status = ptie_rig_load(&s->rig, s->rig_path);
    if (status == PTIE_OK) status = open_context(&ctx, &s->compute);
    if (status == PTIE_OK)
        status = ptie_prepare_planes(ctx, &s->params, progress_callback(&progress));
    progress_end(&progress);
    ptie_ctx_free(ctx);
    return status;
}

int prepare_command(int argc, char **argv) {
    settings s = {.compute = COMPUTE_DEFAULTS, .until = PTIE_STEP_MASK, .frames = {.step = 1}};
    ptie_prepare_params_init(&s.params);
    int code = parse(&s, argc, argv);
    if (code != GO_ON) return code;
    s.provenance = joined_command(argc, argv);
    ptie_status status = prepare(&s);
    free(s.provenance);
    if (status != PTIE_OK) return failed(status);
    say("%s: planes after step '%s'", s.params.output, steps[s.until]);
    return DONE;
}
