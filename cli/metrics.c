/* SPDX-License-Identifier: BSD-3-Clause */
/* ptie metrics: MGM, SBR, BNS, CNR of recordings of phase, over frames. */
#include <stdio.h>
#include <stdlib.h>

#include "cli.h"
#include "json.h"
#include "series.h"

static const char examples[] =
    "  # both maps of a result of 'ptie run', regions proposed from the last one\n"
    "  ptie metrics phase.h5\n\n"
    "  # the paper's Table 3 and Fig. 6 with regions of your own\n"
    "  ptie metrics phase.h5 --jet 100,80,60,120 --background 0,0,60,60 \\\n"
    "      --figure metrics.png\n\n"
    "  # against the truth of a simulation\n"
    "  ptie metrics phase.h5 --truth jet.h5:/entry/truth/phase\n\n"
    "  # any recordings of phase, side by side\n"
    "  ptie metrics before.tif after.tif\n";

static const char notes[] =
    "MGM  mean gradient magnitude in the jet\n"
    "SBR  mean of the jet / mean of the background; grows without bound as a network\n"
    "     prints zeros in the background, so look at CNR beside it\n"
    "BNS  standard deviation in the background\n"
    "CNR  |mean jet - mean background| / sqrt(var jet + var background)\n"
    "RMSE, correlation: against the truth, means taken out\n"
    "signal kept: slope of the map on the truth; 1 = all of it, 0 = erased\n";

typedef struct settings {
    const char *truth, *figure;
    ptie_rect jet, background;
    bool json, force;
    int progress;
    operand_list files;
} settings;

static int parse(settings *s, int argc, char **argv) {
    const option options[] = {
        {0, "jet", OPTION_RECT, &s->jet, "x,y,w,h", .help = "region of the flow, pixels"},
        {0, "background", OPTION_RECT, &s->background, "x,y,w,h",
         .help =
             "region without flow; if no regions are given, they are proposed from the mean of the "
             "last recording"},
        {0, "truth", OPTION_TEXT, &s->truth, "FILE", .help = "true phase to compare with"},
        {0, "figure", OPTION_TEXT, &s->figure, "FILE",
         .help = "draw the metrics over frames (.png or .svg)"},
        {0, "json", OPTION_FLAG, &s->json, .help = "as JSON, with every frame"},
        {'f', "force", OPTION_FLAG, &s->force, .help = "replace existing output"},
        {0, "progress", OPTION_CHOICE, &s->progress, "HOW", .choices = progress_styles,
         .help = "on stderr; auto is a bar on a terminal"},
    };
    const command_usage usage = {
        .name = "metrics",
        .purpose = "Measures phase maps over frames: mean and standard deviation of MGM, SBR, "
                   "BNS and CNR.",
        .examples = examples,
        .synopsis = "PHASE... [options]",
        .notes = notes,
        .least = 1,
        .most = MOST_SERIES - 1,
        .operand = "PHASE",
        .options = options,
        .count = COUNT(options)};
    int code = parse_options(&usage, argc, argv, &s->files);
    if (code != GO_ON) return code;
    if (!s->jet.width_px != !s->background.width_px)
        return misused("metrics: --jet and --background belong together");
    return check_figure(s->figure, s->force);
}

static int measure(series_set *set, const settings *s) {
    progress_bar progress;
    progress_start(&progress, s->progress, "metrics", "frames");
    ptie_status status = PTIE_OK;
    for (int64_t t = 0; t < set->frames && status == PTIE_OK; t++) {
        status = measure_frame(set, t);
        if (progress_report(&progress, (uint64_t)t + 1, (uint64_t)set->frames, NULL))
            status = PTIE_ECANCELLED;
    }
    progress_end(&progress);
    return status == PTIE_OK ? DONE : failed(status);
}

static void print_frames_json(const series_set *set) {
    printf("  \"by_frame\": {");
    for (int i = 0; i < set->count; i++) {
        printf("%s\n    ", i ? "," : "");
        json_text(stdout, set->series[i].key);
        printf(": {");
        for (int k = 0; k < MEASURES; k++) {
            printf("%s\n      \"%s\": [", k ? "," : "", measure_key(k));
            for (int64_t t = 0; t < set->frames; t++) {
                if (t) printf(", ");
                json_number(stdout, set->series[i].value[k][t]);
            }
            printf("]");
        }
        printf("}");
    }
    printf("\n  },\n");
}

static void print_results(const series_set *set, bool json) {
    measured columns[MOST_SERIES];
    size_t jet = 0, background = 0;
    for (size_t i = 0; i < set->pixels; i++) {
        jet += set->labels[i] == PTIE_JET;
        background += set->labels[i] == PTIE_BACKGROUND;
    }
    for (int i = 0; i < set->count; i++)
        columns[i] = (measured){set->series[i].name, set->series[i].key, summarise_series(set, i)};
    if (json) {
        printf("{\n  \"frames\": %lld,\n  \"jet_px\": %zu,\n  \"background_px\": %zu,\n",
               (long long)set->frames, jet, background);
        print_frames_json(set);
        print_measures_json(columns, set->count);
        printf("}\n");
        return;
    }
    printf("%lld frames of %d x %d px; jet %zu px, background %zu px\n\n", (long long)set->frames,
           set->width, set->height, jet, background);
    print_measures(columns, set->count);
}

/* The paper's Fig. 6. */
static int draw(const series_set *set, const settings *s) {
    enum { PLOTS = 3 };
    static const int shown[PLOTS] = {MGM, SBR, BNS};
    static const char *const titles[PLOTS] = {"Mean gradient", "Signal to background",
                                              "Background noise"};
    ptie_curve curves[PLOTS][MOST_SERIES];
    ptie_axes axes[PLOTS];
    double *frame = calloc((size_t)set->frames, sizeof *frame);
    if (!frame) return failed(PTIE_ENOMEM);
    for (int64_t t = 0; t < set->frames; t++) frame[t] = (double)(set->first_frame + t * set->frame_step);
    for (int k = 0; k < PLOTS; k++) {
        for (int i = 0; i < set->count; i++)
            curves[k][i] = (ptie_curve){.x = frame,
                                        .y = set->series[i].value[shown[k]],
                                        .count = (size_t)set->frames,
                                        .label = set->series[i].name,
                                        .dashed = &set->series[i] == set->truth,
                                        .markers = set->frames <= 40,
                                        .colour = i};
        axes[k] = (ptie_axes){.curves = curves[k],
                              .count = set->count,
                              .title = titles[k],
                              .x_label = "frame",
                              .y_label = measure_name(shown[k])};
    }
    ptie_status status = ptie_figure_curves(s->figure, axes, PLOTS, NULL, 0, s->force);
    free(frame);
    return status == PTIE_OK ? DONE : failed(status);
}

int metrics_command(int argc, char **argv) {
    settings s = {.progress = PROGRESS_AUTO};
    series_set set = {.count = 0};
    int code = parse(&s, argc, argv);
    if (code == GO_ON) code = open_series(&set, &s.files, s.truth);
    if (code == GO_ON) code = label_regions(&set, s.jet, s.background);
    if (code == GO_ON) {
        code = measure(&set, &s);
        if (code == DONE && s.figure) code = draw(&set, &s);
        if (code == DONE) print_results(&set, s.json);
    }
    close_series(&set);
    return code;
}
