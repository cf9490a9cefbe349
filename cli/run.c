/* SPDX-License-Identifier: BSD-3-Clause */
/* ptie run and ptie reconstruct: the pipeline, with and without a model. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli.h"
#include "json.h"
#include "maps_figure.h"
#include "measures.h"

static const char run_examples[] =
    "  # pairs of planes in one HDF5 file; the rig says how they were taken\n"
    "  ptie run --rig jet.ini jet.h5 --model models/paper.safetensors -o phase.h5\n\n"
    "  # a polarisation camera: all planes in each image\n"
    "  ptie run --rig lab.ini flow.mraw --model m.safetensors -o phase.h5\n\n"
    "  # planes in two files\n"
    "  ptie run --rig lab.ini --plus p.tif --minus m.tif --model m.safetensors \\\n"
    "      -o phase.h5\n\n"
    "  # numbered images of a plume, with a no-flow reference named in the rig\n"
    "  ptie run --rig plume.ini 'plume/flow_%02d.png' --model m.safetensors \\\n"
    "      -o plume.h5 --figure plume.png --metrics plume.csv\n";

static const char reconstruct_examples[] =
    "  ptie reconstruct --rig jet.ini jet.h5 -o phase.h5\n"
    "  ptie reconstruct --rig lab.ini --plus p.tif --zero z.tif --minus m.tif \\\n"
    "      -o phase.h5\n";

static const char notes[] =
    "RECORDING holds all planes (one image of a polarisation camera, or data sets\n"
    "of HDF5; the rig names them), or the flow where the rig's set is a reference.\n"
    "Files: MRAW (.mraw, .cihx), CINE, HDF5 (FILE.h5 or FILE.h5:/path/inside), TIFF,\n"
    "MAT, NPY, PNG, raw, a folder of numbered images, or a pattern with one %d.\n\n"
    "The table has mean and standard deviation over frames: MGM, mean gradient in\n"
    "the jet; SBR, mean jet / mean background; BNS, deviation of the background;\n"
    "CNR, contrast over noise; with --truth also RMSE, correlation,\n"
    "and the share of the signal kept; residual, the map sent back through the\n"
    "forward model against the planes: 0 keeps all noise, 1 is an empty map.\n";

typedef struct settings {
    compute_options compute;
    ptie_run_params params;
    const char *rig_path, *model_path, *figure;
    const char *report;                /* as given: NULL, or "none" */
    char report_path[PATH_BYTES];      /* "" for none */
    int64_t figure_frame; /* of those processed; -1: the middle */
    bool json;
    ptie_rig rig;
    char *provenance;
} settings;

/* Beside the output unless it is named; found out before long work whether it can be written. */
static int choose_report(settings *s, const char *name, bool with_model) {
    const char *given = s->report;
    if (given && strcmp(given, "none") != 0 && !ends_in(given, ".html"))
        return misused("%s: --report: expected a name ending in .html or 'none', found '%s'", name, given);
    if (given ? strcmp(given, "none") == 0 : !with_model) return GO_ON;
    if (given)
        snprintf(s->report_path, sizeof s->report_path, "%s", given);
    else if (!replace_ending(s->report_path, sizeof s->report_path, s->params.output, ".html"))
        return misused("%s: --output: path too long", name);
    if (s->compute.force || access(s->report_path, F_OK) != 0) return GO_ON;
    say("ptie: %s: exists already (use -f to overwrite)", s->report_path);
    return FAILED;
}

static int check(settings *s, const char *name, bool with_model) {
    ptie_run_params *p = &s->params;
    if (!p->recording && !p->plane[PTIE_PLUS])
        return misused("%s: missing RECORDING (see 'ptie help %s')", name, name);
    if (!s->rig_path) return misused("%s: missing rig (expected --rig FILE.ini)", name);
    if (with_model && !s->model_path)
        return misused("%s: missing model (expected --model FILE.safetensors)", name);
    if (!p->output) return misused("%s: missing output (expected -o FILE.h5)", name);
    if (!ends_in(p->output, ".h5") && !ends_in(p->output, ".hdf5"))
        return misused("%s: --output: expected a name ending in .h5 or .hdf5, found '%s'", name,
                       p->output);
    if (!p->jet.width_px != !p->background.width_px)
        return misused("%s: --jet and --background belong together", name);
    p->overwrite = s->compute.force;
    const int code = choose_report(s, name, with_model);
    return code == GO_ON ? check_figure(s->figure, s->compute.force) : code;
}

static int parse(settings *s, const char *name, bool with_model, int argc, char **argv) {
    ptie_run_params *p = &s->params;
    enum { OF_MODEL = 2 };
    const option options[] = {
        /* Must stay the first: reconstruct leaves them out. */
        {'m', "model", OPTION_TEXT, &s->model_path, "FILE",
         .help = "denoising network (.safetensors)"},
        {0, "fast", OPTION_FLAG, &p->fast, .help = "half precision where available; less exact"},
        {'r', "rig", OPTION_TEXT, &s->rig_path, "FILE", .help = "how the set-up is built (.ini)"},
        {'o', "output", OPTION_TEXT, &p->output, "FILE", .help = "result to write (.h5)"},
        PLANE_OPTIONS(p->plane),
        {0, "reference", OPTION_TEXT, &p->reference, "FILE",
         .help = "no-flow recording, instead of the rig's"},
        {0, "dark", OPTION_TEXT, &p->dark, "FILE", .help = "recording without light, instead of the rig's"},
        {0, "mask", OPTION_TEXT, &p->mask, "FILE", .help = "image of what is opaque (0), instead of the rig's"},
        {0, "frames", OPTION_FRAMES, &p->frames, "a:b:step",
         .help = "frames a, a + step, ... below b; each may be left out"},
        {0, "resume", OPTION_FLAG, &p->resume, .help = "go on where an interrupted run stopped"},
        {0, "truth", OPTION_TEXT, &p->truth, "FILE", .help = "true phase to compare with"},
        {0, "jet", OPTION_RECT, &p->jet, "x,y,w,h",
         .help = "region of the flow, pixels of the phase"},
        {0, "background", OPTION_RECT, &p->background, "x,y,w,h",
         .help = "region without flow; if no regions are given, they are proposed from the result"},
        {0, "metrics", OPTION_TEXT, &p->metrics_csv, "FILE",
         .help = "metrics of every frame as a table (.csv)"},
        {0, "report", OPTION_TEXT, &s->report, "FILE",
         .help = "page to draw at the end (.html), or 'none'; run draws one beside the output"},
        {0, "figure", OPTION_TEXT, &s->figure, "FILE",
         .help = "draw a frame: intensity and phase (.png or .svg)"},
        {0, "figure-frame", OPTION_INT64, &s->figure_frame, "N", .low = -1, .high = INT64_MAX,
         .help = "which of the frames processed; -1 = the middle one"},
        {0, "json", OPTION_FLAG, &s->json, .help = "summary as JSON instead of a table"},
        COMPUTE_OPTIONS(s->compute),
    };
    const command_usage usage = {
        .name = name,
        .purpose =
            with_model
                ? "Takes a recording to phase in rad and to denoised phase, and measures both."
                : "Takes a recording to phase in rad, by the transport-of-intensity equation.",
        .examples = with_model ? run_examples : reconstruct_examples,
        .synopsis =
            with_model
                ? "--rig FILE RECORDING --model FILE -o FILE.h5 [options]\n"
                  "  ptie run --rig FILE --plus FILE --minus FILE -m FILE -o FILE.h5 [options]"
                : "--rig FILE RECORDING -o FILE.h5 [options]\n"
                  "  ptie reconstruct --rig FILE --plus FILE --minus FILE -o FILE.h5 [options]",
        .notes = notes,
        .most = 1,
        .options = options + (with_model ? 0 : OF_MODEL),
        .count = COUNT(options) - (with_model ? 0 : OF_MODEL)};
    operand_list files;
    int code = parse_options(&usage, argc, argv, &files);
    if (code != GO_ON) return code;
    if (files.count && p->plane[PTIE_PLUS])
        return misused("%s: expected RECORDING or --plus, not both (found '%s')", name,
                       files.value[0]);
    if (files.count) p->recording = files.value[0];
    return check(s, name, with_model);
}

static void print_summary(const settings *s, const ptie_run_summary *r) {
    measured columns[3] = {{"TIE phase", "phase", r->phase}};
    int count = 1;
    if (s->params.model) columns[count++] = (measured){"denoised", "denoised", r->denoised};
    if (s->params.truth) columns[count++] = (measured){"truth", "truth", r->truth};
    const int64_t done = r->frames - r->resumed;
    const double rate = r->seconds > 0 ? (double)done / r->seconds : 0;
    if (s->json) {
        printf("{\n  \"output\": ");
        json_text(stdout, s->params.output);
        printf(",\n  \"frames\": %lld,\n  \"width_px\": %d,\n  \"height_px\": %d,\n  \"pixel_m\": ",
               (long long)r->frames, r->width_px, r->height_px);
        json_number(stdout, r->pixel_m);
        printf(",\n  \"seconds\": ");
        json_number(stdout, r->seconds);
        printf(",\n");
        print_measures_json(columns, count);
        printf("}\n");
        return;
    }
    char pixel[PTIE_QUANTITY_BYTES];
    printf("%lld frame%s of %d x %d px, %s each, in %.3g s (%.4g frames/s)\n\n",
           (long long)r->frames, r->frames == 1 ? "" : "s", r->width_px, r->height_px,
           ptie_print_rounded(pixel, r->pixel_m, PTIE_LENGTH), r->seconds, rate);
    print_measures(columns, count);
}

static ptie_status draw(const settings *s, const ptie_run_summary *summary) {
    int64_t frame = s->figure_frame < 0 ? summary->frames / 2 : s->figure_frame;
    return draw_maps(s->figure, &s->params, frame, summary->pixel_m);
}

/* What belongs to the result and is no number of it. */
static void tell(const settings *s, ptie_status status, const ptie_run_summary *r) {
    if (status != PTIE_OK && r->frames > 0)
        say("%s.part holds %lld frames; --resume goes on from there", s->params.output,
            (long long)r->frames);
    for (int32_t i = 0; status == PTIE_OK && i < r->warnings; i++)
        say("%s: %s", s->params.output, r->warning[i]);
}

static ptie_status compute_run(settings *s, const char *name, ptie_run_summary *summary) {
    progress_bar progress;
    ptie_ctx *ctx = NULL;
    ptie_model *model = NULL;
    ptie_status status = PTIE_OK;
    if (s->model_path) status = ptie_model_load(&model, s->model_path);
    if (status == PTIE_OK) status = open_context(&ctx, &s->compute);
    if (status == PTIE_OK) {
        s->params.model = model;
        s->params.provenance = s->provenance;
        progress_start(&progress, s->compute.progress, name, "frames");
        status = ptie_run(ctx, &s->params, summary, progress_callback(&progress));
        progress_end(&progress);
    }
    tell(s, status, summary);
    if (status == PTIE_OK && s->figure) status = draw(s, summary);
    if (status == PTIE_OK && s->report_path[0])
        status = ptie_report_write(s->report_path, s->params.output, s->compute.force);
    if (status == PTIE_OK) print_summary(s, summary);
    ptie_ctx_free(ctx);
    ptie_model_free(model);
    return status;
}

static int pipeline(bool with_model, int argc, char **argv) {
    const char *name = with_model ? "run" : "reconstruct";
    settings s = {.compute = COMPUTE_DEFAULTS, .figure_frame = -1};
    ptie_run_summary summary = {0};
    ptie_rig_init(&s.rig);
    ptie_run_params_init(&s.params);
    int code = parse(&s, name, with_model, argc, argv);
    if (code != GO_ON) return code;
    ptie_status status = ptie_rig_load(&s.rig, s.rig_path);
    if (status != PTIE_OK) return failed(status);
    s.params.rig = &s.rig;
    if (s.figure && (code = check_maps_frame(&s.params, s.figure_frame)) != GO_ON) return code;
    s.provenance = joined_command(argc, argv);
    status = compute_run(&s, name, &summary);
    free(s.provenance);
    return status == PTIE_OK ? DONE : failed(status);
}

int run_command(int argc, char **argv) {
    return pipeline(true, argc, argv);
}

int reconstruct_command(int argc, char **argv) {
    return pipeline(false, argc, argv);
}
