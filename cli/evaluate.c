/* SPDX-License-Identifier: BSD-3-Clause */
/* ptie evaluate: scores of a model over a split, and examples as a figure. */
#include <stdio.h>
#include <stdlib.h>

#include "cli.h"
#include "json.h"
#include "samples.h"
#include "table.h"

static const char *const splits[] = {"train", "validation", "test", "all", NULL};

static const char examples[] =
    "  # the paper's Table 2, and examples as in its Fig. 4\n"
    "  ptie evaluate paper.safetensors --data paper.h5 --figure examples.png\n\n"
    "  # fresh samples of the preset, that no data set file holds\n"
    "  ptie evaluate paper.safetensors --preset paper --count 1000 \\\n"
    "      --data-seed 99 --split all\n";

static const char notes[] =
    "Scores are means over samples, of maps in [0, 1]: PSNR with MAX = 1, mean\n"
    "absolute error, SSIM (11x11 Gaussian), and the training loss.\n";

typedef struct settings {
    compute_options compute;
    samples samples;
    int split;
    const char *model, *figure;
    number_list shown;
    bool json;
} settings;

static int parse(settings *s, int argc, char **argv) {
    const option options[] = {
        SAMPLES_OPTIONS(s->samples),
        {0, "split", OPTION_CHOICE, &s->split, "NAME", .choices = splits,
         .help = "part of the data"},
        {0, "figure", OPTION_TEXT, &s->figure, "FILE",
         .help = "draw samples: noisy, denoised, clean (.png or .svg)"},
        {0, "samples", OPTION_LIST, &s->shown, "N,N,...",
         .help = "samples of the split in the figure; if not given, five spread over it"},
        {0, "json", OPTION_FLAG, &s->json, .help = "scores as JSON instead of a table"},
        COMPUTE_OPTIONS(s->compute),
    };
    const command_usage usage = {
        .name = "evaluate",
        .purpose = "Scores a model on data that it has not seen: the input as it is, "
                   "and what the model makes of it.",
        .examples = examples,
        .synopsis = "MODEL (--data FILE | --preset NAME) [options]",
        .notes = notes,
        .least = 1,
        .most = 1,
        .operand = "MODEL",
        .options = options,
        .count = COUNT(options)};
    operand_list operands;
    int code = parse_options(&usage, argc, argv, &operands);
    if (code != GO_ON) return code;
    s->model = operands.value[0];
    return check_figure(s->figure, s->compute.force);
}

static void print_scores_json(const char *name, const ptie_scores *s, const char *end) {
    printf("  \"%s\": {\"psnr_db\": ", name);
    json_number(stdout, s->psnr_db);
    printf(", \"mae\": ");
    json_number(stdout, s->mae);
    printf(", \"ssim\": ");
    json_number(stdout, s->ssim);
    printf(", \"loss\": ");
    json_number(stdout, s->loss);
    printf("}%s\n", end);
}

static void print_scores(const settings *s, const ptie_scores *noisy, const ptie_scores *denoised) {
    if (s->json) {
        printf("{\n  \"split\": \"%s\",\n  \"samples\": %llu,\n", splits[s->split],
               (unsigned long long)noisy->samples);
        print_scores_json("noisy", noisy, ",");
        print_scores_json("denoised", denoised, "");
        printf("}\n");
        return;
    }
    static const char *const heads[] = {"", "PSNR (dB)", "MAE", "SSIM", "loss"};
    const ptie_scores *rows[] = {noisy, denoised};
    table t = {.rows = 0};
    for (int c = 0; c < 5; c++) table_set(&t, 0, c, "%s", heads[c]);
    for (int r = 1; r <= 2; r++) {
        const ptie_scores *row = rows[r - 1];
        table_set(&t, r, 0, r == 1 ? "noisy" : "denoised");
        table_set(&t, r, 1, "%.2f", row->psnr_db);
        table_set(&t, r, 2, "%.4f", row->mae);
        table_set(&t, r, 3, "%.4f", row->ssim);
        table_set(&t, r, 4, "%.4f", row->loss);
    }
    printf("%llu samples (%s)\n\n", (unsigned long long)noisy->samples, splits[s->split]);
    table_print(&t);
}

/* Five samples spread over the split, the first and the last not among them. */
static void choose_samples(settings *s, uint64_t count) {
    if (s->shown.count > 0) return;
    s->shown.count = count < 5 ? (int32_t)count : 5;
    for (int32_t i = 0; i < s->shown.count; i++)
        s->shown.value[i] =
            (int32_t)((2 * (uint64_t)i + 1) * count / (2 * (uint64_t)s->shown.count));
}

/* maps: noisy, denoised, clean of every shown sample. */
static ptie_status draw_samples(const settings *s, const ptie_denoiser *denoiser, float *maps,
                                void *scratch) {
    static const char *const rows[] = {"noisy", "denoised", "clean"};
    int32_t columns = s->shown.count, width, height;
    char titles[LONGEST_LIST][32];
    ptie_panel panels[3 * LONGEST_LIST];
    ptie_dataset_size(s->samples.dataset, &width, &height);
    size_t pixels = (size_t)width * (size_t)height;
    for (int32_t c = 0; c < columns; c++) {
        float *noisy = maps + 3 * (size_t)c * pixels, *denoised = noisy + pixels,
              *clean = denoised + pixels;
        ptie_status status = ptie_dataset_read(s->samples.dataset, (ptie_split)s->split,
                                               (uint64_t)s->shown.value[c], clean, noisy, NULL);
        if (status == PTIE_OK) status = ptie_denoiser_run(denoiser, denoised, noisy, scratch);
        if (status != PTIE_OK) return status;
        snprintf(titles[c], sizeof titles[c], "sample %d", s->shown.value[c]);
        for (int r = 0; r < 3; r++)
            panels[r * columns + c] = (ptie_panel){.data = noisy + (size_t)r * pixels,
                                                   .width_px = width,
                                                   .height_px = height,
                                                   .title = r == 0 ? titles[c] : NULL,
                                                   .colormap = PTIE_VIRIDIS,
                                                   .high = 1};
    }
    ptie_panels figure = {.panels = panels, .rows = 3, .columns = columns, .row_titles = rows};
    return ptie_figure_panels(s->figure, &figure, s->compute.force);
}

static int draw(settings *s, ptie_ctx *ctx, const ptie_model *model) {
    int32_t width, height;
    ptie_denoiser *denoiser;
    ptie_dataset_size(s->samples.dataset, &width, &height);
    choose_samples(s, ptie_dataset_count(s->samples.dataset, (ptie_split)s->split));
    ptie_status status = ptie_denoiser_create(&denoiser, ctx, model, width, height, NULL);
    if (status != PTIE_OK) return failed(status);
    float *maps = calloc(3 * (size_t)s->shown.count, (size_t)width * (size_t)height * sizeof *maps);
    void *scratch = ptie_scratch_alloc(ptie_denoiser_scratch_bytes(denoiser));
    int code = DONE;
    if (!maps || !scratch)
        code = failed(PTIE_ENOMEM);
    else if ((status = draw_samples(s, denoiser, maps, scratch)) != PTIE_OK)
        code = failed(status);
    ptie_scratch_free(scratch);
    free(maps);
    ptie_denoiser_free(denoiser);
    return code;
}

static int evaluate(settings *s) {
    progress_bar progress;
    ptie_ctx *ctx = NULL;
    ptie_model *model = NULL;
    ptie_scores noisy, denoised;
    progress_start(&progress, s->compute.progress, "evaluate", "samples");
    ptie_status status = ptie_model_load(&model, s->model);
    if (status == PTIE_OK) status = open_context(&ctx, &s->compute);
    if (status == PTIE_OK)
        status = ptie_evaluate(ctx, model, s->samples.dataset, (ptie_split)s->split, NULL, &noisy,
                               &denoised, progress_callback(&progress));
    progress_end(&progress);
    int code = status == PTIE_OK ? DONE : failed(status);
    if (code == DONE && s->figure) code = draw(s, ctx, model);
    if (code == DONE) print_scores(s, &noisy, &denoised);
    ptie_ctx_free(ctx);
    ptie_model_free(model);
    return code;
}

int evaluate_command(int argc, char **argv) {
    settings s = {.compute = COMPUTE_DEFAULTS, .samples = SAMPLES_DEFAULTS, .split = PTIE_TEST};
    int code = parse(&s, argc, argv);
    if (code == GO_ON) code = open_samples(&s.samples, "evaluate");
    if (code == GO_ON) code = evaluate(&s);
    close_samples(&s.samples);
    return code;
}
