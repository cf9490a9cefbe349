/* SPDX-License-Identifier: BSD-3-Clause */
/* ptie rig check: is a rig right for a recording? */
#include <stdio.h>

#include "cli.h"
#include "json.h"
#include "rig.h"

static const char examples[] = "  ptie rig check lab.ini flow.mraw --target target.mraw\n"
                               "  ptie rig check lab.ini --plus p.tif --minus m.tif --json\n";

static const char notes[] =
    "Each line begins with ok, with warn (the result is worse than it could be), or\n"
    "with FAIL (the result would mean nothing); the exit code is 1 if one fails.\n"
    "'ptie rig calibrate' takes care of gains and registration.\n";

static const char *const verdicts[] = {"ok", "warn", "FAIL"};

typedef struct settings {
    const char *rig_path, *recording, *plane[PTIE_ROLES], *target, *reference;
    bool json;
} settings;

static int parse(settings *s, int argc, char **argv) {
    const option options[] = {
        {0, "target", OPTION_TEXT, &s->target, "FILE",
         .help = "recording of a target in the object's plane: measures registration"},
        {0, "reference", OPTION_TEXT, &s->reference, "FILE",
         .help = "no-flow recording, instead of the rig's"},
        PLANE_OPTIONS(s->plane),
        {0, "json", OPTION_FLAG, &s->json, .help = "findings as JSON instead of lines"},
    };
    const command_usage usage = {
        .name = "rig check",
        .purpose = "Compares a rig with a recording: sizes, exposure, mosaic, planes, flat "
                   "field, registration, optics, noise.",
        .examples = examples,
        .synopsis = "RIG RECORDING [options]",
        .notes = notes,
        .least = 1,
        .most = 2,
        .operand = "RIG",
        .options = options,
        .count = COUNT(options)};
    operand_list files;
    int code = parse_options(&usage, argc, argv, &files);
    if (code != GO_ON) return code;
    s->rig_path = files.value[0];
    if (files.count > 1) s->recording = files.value[1];
    if (!s->recording && !s->plane[PTIE_PLUS])
        return misused("rig check: missing RECORDING (see 'ptie rig check --help')");
    return GO_ON;
}

static void print_json(const ptie_rig_report *report) {
    printf("{");
    for (int32_t i = 0; i < report->count; i++) {
        const ptie_rig_finding *f = &report->finding[i];
        printf("%s\n  ", i ? "," : "");
        json_text(stdout, f->name);
        printf(": {\"verdict\": \"%s\", \"value\": ", verdicts[f->verdict]);
        json_number(stdout, f->value);
        printf(", \"text\": ");
        json_text(stdout, f->text);
        printf("}");
    }
    printf("\n}\n");
}

static void print_lines(const ptie_rig_report *report) {
    for (int32_t i = 0; i < report->count; i++) {
        const ptie_rig_finding *f = &report->finding[i];
        printf("%-4s  %-16s  %s\n", verdicts[f->verdict], f->name, f->text);
    }
}

int rig_check(int argc, char **argv) {
    settings s = {0};
    ptie_rig rig;
    ptie_rig_report report;
    int code = parse(&s, argc, argv);
    if (code != GO_ON) return code;
    ptie_rig_init(&rig);
    ptie_status status = ptie_rig_load(&rig, s.rig_path);
    if (s.reference) snprintf(rig.reference, sizeof rig.reference, "%s", s.reference);
    if (status == PTIE_OK) status = ptie_rig_check(&rig, s.recording, s.plane, s.target, &report);
    if (status != PTIE_OK) return failed(status);
    if (s.json)
        print_json(&report);
    else
        print_lines(&report);
    for (int32_t i = 0; i < report.count; i++)
        if (report.finding[i].verdict == PTIE_WRONG) return FAILED;
    return DONE;
}
