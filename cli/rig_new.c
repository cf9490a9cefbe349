/* SPDX-License-Identifier: BSD-3-Clause */
/* ptie rig new: a rig file from options.  What the user wrote goes into the file as it is; the
 * library checks it. */
#include <string.h>

#include "cli.h"
#include "rig.h"

static const char examples[] =
    "  # a polarisation camera: I+ behind one polariser, I- behind the one across\n"
    "  ptie rig new --layout mosaic --mosaic crysta --plus 0 --minus 90 \\\n"
    "      --wavelength \"532 nm\" --pixel \"20 um\" --defocus \"10 mm\" -o lab.ini\n\n"
    "  # both planes beside each other on one sensor, imaged at 1:2\n"
    "  ptie rig new --layout side-by-side --magnification 0.5 -o lab.ini\n\n"
    "  # one defocused plane against a recording without flow\n"
    "  ptie rig new --set reference --reference noflow.tif --defocus \"2.08 m\" \\\n"
    "      -o plume.ini\n";

static const char notes[] =
    "The file has every key of a rig with a line about it; those behind a semicolon\n"
    "are not set. Edit it at will, then let 'ptie rig check' compare it with a\n"
    "recording.\n";

/* Options and the keys they set, in the order of the file. */
typedef struct rig_option {
    const char *section, *key;
    const char *argument, *help;
} rig_option;

static const rig_option rig_options[] = {
    {"optics", "wavelength", "LENGTH", "of the light (default: 532 nm)"},
    {"optics", "pixel", "LENGTH", "pitch of the sensor (default: 20 um)"},
    {"optics", "magnification", "N", "of the imaging (default: 1)"},
    {"optics", "defocus", "LENGTH", "of both planes from focus (default: 10 mm)"},
    {"planes", "set", "NAME", "pair, triple, five or reference (default: pair)"},
    {"planes", "layout", "NAME",
     "separate, mosaic, side-by-side, top-bottom or quadrants (default: separate)"},
    {"planes", "mosaic", "ANGLES",
     "sony, crysta, or the angles of a cell row by row, \"90 45 135 0\""},
    {"planes", "plus", "CHANNELS",
     "where I+ is: 0, \"0.98*0 + 0.02*45\", left, top, tl, or a data set"},
    {"planes", "minus", "CHANNELS", "where I- is"},
    {"planes", "zero", "CHANNELS", "where I0 is"},
    {"planes", "plus2", "CHANNELS", "where the outer I+ is"},
    {"planes", "minus2", "CHANNELS", "where the outer I- is"},
    {"recording", "reference", "FILE", "recording without flow"},
    {"recording", "dark", "FILE", "recording without light"},
    {"camera", "saturation", "COUNTS", "largest value of the sensor"},
    {"preprocess", "demosaic", "HOW", "none, bilinear or fourier (default: bilinear)"},
    {"solver", "binning", "N", "average N x N pixels (default: 1)"},
    {"solver", "boundary", "NAME", "mirror or periodic (default: mirror)"},
    {"flow", "polarity", "SIGN", "positive, negative or auto (default: auto)"},
};
enum { RIG_OPTIONS = COUNT(rig_options) };

typedef struct settings {
    const char *output;
    bool force;
    const char *value[RIG_OPTIONS]; /* NULL: not given */
} settings;

static int parse(settings *s, int argc, char **argv) {
    option options[RIG_OPTIONS + 2] = {
        {'o', "output", OPTION_TEXT, &s->output, "FILE", .help = "rig file to write (.ini)"},
        {'f', "force", OPTION_FLAG, &s->force, .help = "replace existing output"},
    };
    for (int i = 0; i < RIG_OPTIONS; i++)
        options[2 + i] = (option){.name = rig_options[i].key,
                                  .kind = OPTION_TEXT,
                                  .value = &s->value[i],
                                  .argument = rig_options[i].argument,
                                  .help = rig_options[i].help};
    const command_usage usage = {
        .name = "rig new",
        .purpose = "Writes a rig file: how a set-up is built, with every key explained.",
        .examples = examples,
        .synopsis = "-o FILE.ini [options]",
        .notes = notes,
        .options = options,
        .count = COUNT(options)};
    operand_list operands;
    int code = parse_options(&usage, argc, argv, &operands);
    if (code != GO_ON) return code;
    if (!s->output) return misused("rig new: missing output (expected -o FILE.ini)");
    return GO_ON;
}

/* The planes' channels that a layout most often means. */
static void add_usual_planes(ptie_rig_setting *list, size_t *count, const char *layout) {
    static const char *const usual[][3] = {{"mosaic", "0", "90"},
                                           {"side-by-side", "left", "right"},
                                           {"top-bottom", "top", "bottom"},
                                           {"quadrants", "tl", "br"}};
    for (size_t i = 0; i < COUNT(usual); i++) {
        if (strcmp(layout, usual[i][0]) != 0) continue;
        list[(*count)++] = (ptie_rig_setting){"planes", "plus", usual[i][1]};
        list[(*count)++] = (ptie_rig_setting){"planes", "minus", usual[i][2]};
    }
}

int rig_new(int argc, char **argv) {
    settings s = {0};
    ptie_rig_setting list[RIG_OPTIONS + 2];
    size_t count = 0;
    int code = parse(&s, argc, argv);
    if (code != GO_ON) return code;
    for (int i = 0; i < RIG_OPTIONS; i++)
        if (s.value[i] && strcmp(rig_options[i].key, "layout") == 0)
            add_usual_planes(list, &count, s.value[i]);
    for (int i = 0; i < RIG_OPTIONS; i++)
        if (s.value[i])
            list[count++] =
                (ptie_rig_setting){rig_options[i].section, rig_options[i].key, s.value[i]};
    ptie_status status = ptie_rig_edit(s.output, NULL, list, count, s.force);
    if (status != PTIE_OK) return failed(status);
    say("%s: written; 'ptie rig check %s RECORDING' compares it with a recording", s.output,
        s.output);
    return DONE;
}
