/* SPDX-License-Identifier: BSD-3-Clause */
/* ptie rig calibrate: where the planes lie and how bright they are, written into the rig. */
#include <math.h>
#include <stdio.h>

#include "cli.h"
#include "rig.h"

static const char examples[] =
    "  # a target in the field of view; lab.ini is changed in place, comments stay\n"
    "  ptie rig calibrate lab.ini --target target.mraw --reference noflow.mraw\n\n"
    "  # frames without flow alone; another file is written\n"
    "  ptie rig calibrate lab.ini --reference noflow.mraw -o calibrated.ini\n";

static const char notes[] =
    "The planes must show the same unmoving structure: a ruler, dots on glass, the\n"
    "nozzle's edge. Dust on the sensor and fringes of one plane mislead: they do not\n"
    "move with a plane. A target is divided by the reference, which takes them out.\n"
    "Take the recordings with the same light and region of the sensor.\n";

enum { KEYS = 5, VALUE_BYTES = 32 };
static const char *const roles[PTIE_ROLES] = {"plus", "minus", "zero", "plus2", "minus2"};
static const char *const keys[KEYS] = {"gain", "shift_x", "shift_y", "magnification", "rotation"};

typedef struct settings {
    const char *rig_path, *target, *reference, *output;
    bool force;
} settings;

static int parse(settings *s, int argc, char **argv) {
    const option options[] = {
        {0, "target", OPTION_TEXT, &s->target, "FILE",
         .help = "recording of a target in the object's plane; if not given, the reference"},
        {0, "reference", OPTION_TEXT, &s->reference, "FILE",
         .help = "recording without flow; if not given, the rig's"},
        {'o', "output", OPTION_TEXT, &s->output, "FILE",
         .help = "rig file to write; if not given, RIG is changed in place"},
        {'f', "force", OPTION_FLAG, &s->force, .help = "replace existing output"},
    };
    const command_usage usage = {
        .name = "rig calibrate",
        .purpose = "Measures where the planes lie on the grid of I+ (shift, magnification, "
                   "rotation) and their gains, and writes them into the rig.",
        .examples = examples,
        .synopsis = "RIG [--target FILE] [--reference FILE] [-o FILE] [options]",
        .notes = notes,
        .least = 1,
        .most = 1,
        .operand = "RIG",
        .options = options,
        .count = COUNT(options)};
    operand_list files;
    int code = parse_options(&usage, argc, argv, &files);
    if (code != GO_ON) return code;
    s->rig_path = files.value[0];
    return GO_ON;
}

static void print_plane(const char *role, const ptie_plane_calibration *c) {
    const ptie_similarity *p = &c->where.place, *d = &c->where.deviation;
    printf("%-13s  %s\n", "", role);
    printf("%-13s  %.5f +- %.5f\n", "gain", c->gain, c->gain_deviation);
    printf("%-13s  %.3f +- %.3f px\n", "shift_x", p->shift_x_px, d->shift_x_px);
    printf("%-13s  %.3f +- %.3f px\n", "shift_y", p->shift_y_px, d->shift_y_px);
    printf("%-13s  %.6f +- %.6f\n", "magnification", p->magnification, d->magnification);
    printf("%-13s  %.3f +- %.3f mrad\n", "rotation", 1e3 * p->rotation_rad, 1e3 * d->rotation_rad);
    printf("%-13s  %.3f\n\n", "correlation", c->where.correlation);
}

/* The keys of a plane's section, as text. */
static void add_settings(ptie_rig_setting *list, size_t *count, char values[KEYS][VALUE_BYTES],
                         const char *role, const ptie_plane_calibration *c) {
    const ptie_similarity *p = &c->where.place;
    snprintf(values[0], VALUE_BYTES, "%.6f", c->gain);
    snprintf(values[1], VALUE_BYTES, "%.4f", p->shift_x_px);
    snprintf(values[2], VALUE_BYTES, "%.4f", p->shift_y_px);
    snprintf(values[3], VALUE_BYTES, "%.7f", p->magnification);
    snprintf(values[4], VALUE_BYTES, "%.5f mrad", 1e3 * p->rotation_rad);
    for (int k = 0; k < KEYS; k++) list[(*count)++] = (ptie_rig_setting){role, keys[k], values[k]};
}

/* Prints what was measured and writes it. */
static ptie_status write_rig(const settings *s,
                             const ptie_plane_calibration calibration[PTIE_ROLES],
                             const ptie_rig *rig) {
    ptie_rig_setting list[PTIE_ROLES * KEYS];
    char values[PTIE_ROLES][KEYS][VALUE_BYTES];
    size_t count = 0;
    for (int i = 1; i < PTIE_ROLES; i++) {
        if (!rig->plane[i].used) continue;
        if (!calibration[i].measured) {
            say("ptie: rig calibrate: '%s' shows nothing that 'plus' does: its section is left as "
                "it is",
                roles[i]);
            continue;
        }
        print_plane(roles[i], &calibration[i]);
        add_settings(list, &count, values[i], roles[i], &calibration[i]);
    }
    const char *output = s->output ? s->output : s->rig_path;
    return ptie_rig_edit(output, s->rig_path, list, count, s->force || !s->output);
}

int rig_calibrate(int argc, char **argv) {
    settings s = {0};
    ptie_rig rig;
    ptie_plane_calibration calibration[PTIE_ROLES];
    int code = parse(&s, argc, argv);
    if (code != GO_ON) return code;
    ptie_rig_init(&rig);
    ptie_status status = ptie_rig_load(&rig, s.rig_path);
    if (status != PTIE_OK) return failed(status);
    if (s.reference) snprintf(rig.reference, sizeof rig.reference, "%s", s.reference);
    const char *recording = s.target ? s.target : rig.reference;
    if (!recording[0])
        return misused(
            "rig calibrate: missing frames without flow (expected --target or --reference FILE, or "
            "'reference' in the rig)");
    status = ptie_rig_calibrate(calibration, &rig, recording, NULL);
    if (status == PTIE_OK) status = write_rig(&s, calibration, &rig);
    if (status != PTIE_OK) return failed(status);
    say("%s: written", s.output ? s.output : s.rig_path);
    return DONE;
}
