/* SPDX-License-Identifier: BSD-3-Clause */
/* ptie train: data set or preset -> model. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "facts.h"
#include "samples.h"

static const char *const outputs[] = {"sigmoid", "linear", NULL};

static const char examples[] =
    "  # the paper's network on the paper's data, drawn on the fly\n"
    "  ptie train --preset paper --count 25000 -o paper.safetensors\n\n"
    "  # from a file, for an hour; later go on from where it stopped\n"
    "  ptie train --data paper.h5 -o paper.safetensors --time-limit 1h\n"
    "  ptie train --data paper.h5 -o paper.safetensors --resume\n\n"
    "  # a larger member of the family, with the curves as a figure\n"
    "  ptie train --data paper.h5 -o big.safetensors --widths 16,32,64,128 \\\n"
    "      --figure curves.png\n";

static const char notes[] =
    "Written: the best model by validation loss, FILE.last (everything --resume\n"
    "needs), FILE.history.csv and FILE.history.json. The same bits for any number\n"
    "of threads. After Ctrl-C or a limit, --resume goes on as if nothing had been.\n";

typedef struct settings {
    compute_options compute;
    samples samples;
    ptie_train_params train;
    ptie_model_params model;
    number_list widths;
    const char *output, *start, *figure;
} settings;

static int parse(settings *s, int argc, char **argv) {
    ptie_train_params *t = &s->train;
    ptie_model_params *m = &s->model;
    int output = (int)m->output;
    int64_t steps = 0;
    const option options[] = {
        {'o', "output", OPTION_TEXT, &s->output, "FILE", .help = "model to write (.safetensors)"},
        SAMPLES_OPTIONS(s->samples),
        {'e', "epochs", OPTION_INT32, &t->epochs, "N", .low = 1, .high = 100000,
         .help = "passes over the data"},
        {'b', "batch", OPTION_INT32, &t->batch, "N", .low = 1, .high = 1024,
         .help = "samples per step"},
        {0, "lr", OPTION_QUANTITY, &t->learning_rate, "X",
         .help = "learning rate, before the schedule"},
        {0, "warmup", OPTION_QUANTITY, &t->warmup_epochs, "X", .help = "linear warm-up, epochs"},
        {0, "weight-decay", OPTION_QUANTITY, &t->weight_decay, "X", .help = "of AdamW"},
        {0, "dropout", OPTION_QUANTITY, &m->dropout, "X",
         .help = "share dropped at the bottleneck"},
        {0, "patience", OPTION_INT32, &t->patience, "N", .low = 0, .high = 100000,
         .help = "epochs without a better validation loss before stopping; 0 = never stop"},
        {0, "time-limit", OPTION_QUANTITY, &t->time_limit_s, "TIME", .quantity = PTIE_TIME,
         .help = "stop after so long, such as 30min; 0 = no limit"},
        {0, "steps", OPTION_INT64, &steps, "N", .low = 0, .high = INT64_MAX,
         .help = "stop after so many steps in all; 0 = no limit"},
        {0, "checkpoint-steps", OPTION_INT32, &t->checkpoint_steps, "N", .low = 0,
         .high = INT32_MAX, .help = "also write FILE.last every so many steps; 0 = every epoch"},
        {'r', "resume", OPTION_FLAG, &t->resume, .help = "go on from FILE.last"},
        {0, "from", OPTION_TEXT, &s->start, "MODEL",
         .help = "start from the weights of another model"},
        {0, "widths", OPTION_LIST, &s->widths, "N,N,...",
         .help = "channels per level, 2 to 6 levels"},
        {0, "activation", OPTION_CHOICE, &output, "NAME", .choices = outputs,
         .help = "of the output"},
        {0, "seed", OPTION_SEED, &t->seed, "N", .help = "of weights, order and dropout"},
        {0, "figure", OPTION_TEXT, &s->figure, "FILE",
         .help = "draw loss, PSNR and MAE over epochs"},
        COMPUTE_OPTIONS(s->compute),
    };
    const command_usage usage = {.name = "train",
                                 .purpose = "Trains a denoising network.",
                                 .examples = examples,
                                 .synopsis = "(--data FILE | --preset NAME) -o MODEL [options]",
                                 .notes = notes,
                                 .options = options,
                                 .count = COUNT(options)};
    operand_list operands;
    int code = parse_options(&usage, argc, argv, &operands);
    if (code != GO_ON) return code;
    if (!s->output) return misused("train: missing output (expected -o FILE.safetensors)");
    static const char *const of_new_models[] = {"widths", "activation", "dropout"};
    for (size_t i = 0; s->start && i < COUNT(of_new_models); i++)
        if (was_given(&usage, &operands, of_new_models[i]))
            return misused("train: --%s does not go with --from, whose model has its own",
                           of_new_models[i]);
    if (s->widths.count < 2 || s->widths.count > PTIE_MAX_LEVELS)
        return misused("train: --widths: expected 2 to %d levels, found %d", PTIE_MAX_LEVELS,
                       s->widths.count);
    m->levels = s->widths.count;
    memcpy(m->width, s->widths.value, (size_t)m->levels * sizeof *m->width);
    m->output = (ptie_output)output;
    m->seed = t->seed;
    t->steps_limit = (uint64_t)steps;
    t->overwrite = s->compute.force;
    return check_figure(s->figure, s->compute.force);
}

/* The end of an epoch stays on the screen; what happens within one is part of the bar. */
static int report(void *user, uint64_t done, uint64_t total, const char *note) {
    if (note && strstr(note, ", validation loss ")) progress_line(user, note);
    return progress_report(user, done, total, note);
}

/* The paper's Fig. 3. */
static int draw_history(const char *path, const ptie_epoch *epochs, size_t count, bool force) {
    enum { SCORES = 3 };
    static const char *const names[SCORES] = {"Loss", "PSNR", "MAE"}, *const units[SCORES] = {
                                                                          "loss", "PSNR (dB)",
                                                                          "MAE"};
    double *values = calloc(count * (1 + 2 * SCORES) + 1, sizeof *values), *x = values;
    if (!values) return failed(PTIE_ENOMEM);
    ptie_curve curves[SCORES][2];
    ptie_axes axes[SCORES];
    for (int k = 0; k < SCORES; k++) {
        double *train = values + (size_t)(1 + 2 * k) * count, *validation = train + count;
        for (size_t i = 0; i < count; i++) {
            const ptie_scores *a = &epochs[i].train, *b = &epochs[i].validation;
            x[i] = epochs[i].epoch;
            train[i] = k == 0 ? a->loss : k == 1 ? a->psnr_db : a->mae;
            validation[i] = k == 0 ? b->loss : k == 1 ? b->psnr_db : b->mae;
        }
        curves[k][0] = (ptie_curve){.x = x, .y = train, .count = count, .label = "training"};
        curves[k][1] = (ptie_curve){.x = x,
                                    .y = validation,
                                    .count = count,
                                    .label = "validation",
                                    .dashed = true,
                                    .colour = 1};
        axes[k] = (ptie_axes){.curves = curves[k],
                              .count = 2,
                              .title = names[k],
                              .x_label = "epoch",
                              .y_label = units[k]};
    }
    ptie_status status = ptie_figure_curves(path, axes, SCORES, NULL, 0, force);
    free(values);
    return status == PTIE_OK ? DONE : failed(status);
}

/* Says how it went, and draws it. */
static int conclude(const settings *s) {
    ptie_epoch *epochs;
    size_t count, best = 0;
    ptie_status status = ptie_history_read(&epochs, &count, s->output);
    if (status != PTIE_OK) return failed(status);
    for (size_t i = 1; i < count; i++)
        if (epochs[i].validation.loss < epochs[best].validation.loss) best = i;
    if (count > 0)
        say("%s: best epoch %d of %zu: validation loss %.4f, PSNR %.2f dB, MAE %.4f", s->output,
            epochs[best].epoch, count, epochs[best].validation.loss,
            epochs[best].validation.psnr_db, epochs[best].validation.mae);
    else
        say("%s: stopped before the first epoch ended; --resume goes on from %s.last", s->output,
            s->output);
    int code =
        s->figure && count > 0 ? draw_history(s->figure, epochs, count, s->compute.force) : DONE;
    ptie_history_free(epochs);
    return code;
}

/* A run that goes on with other kernels is the same but for rounding. */
static void tell_kernels(const settings *s, const ptie_ctx *ctx) {
    char path[PATH_BYTES];
    ptie_model *model;
    snprintf(path, sizeof path, "%s.last", s->output);
    if (ptie_model_load(&model, path) != PTIE_OK) return; /* training says why */
    const char *before = ptie_model_note(model, "ptie.kernels"), *now = ptie_ctx_cpu(ctx);
    if (before && strcmp(before, now) != 0)
        say("%s: begun with %s kernels, goes on with %s: the same but for rounding", path, before,
            now);
    ptie_model_free(model);
}

static int train(settings *s) {
    progress_bar progress;
    ptie_ctx *ctx = NULL;
    ptie_model *model = NULL;
    char number[32];
    ptie_status status =
        s->start ? ptie_model_load(&model, s->start) : ptie_model_create(&model, &s->model);
    if (status == PTIE_OK) status = open_context(&ctx, &s->compute);
    if (status == PTIE_OK) {
        progress_start(&progress, s->compute.progress, "train", "samples");
        say("%s: %s trainable parameters", ptie_model_name(model),
            with_separators(number, ptie_model_trainable(model)));
        if (s->train.resume) tell_kernels(s, ctx);
        status = ptie_train(ctx, model, s->samples.dataset, s->output, &s->train,
                            (ptie_progress){report, &progress});
        progress_end(&progress);
    }
    ptie_ctx_free(ctx);
    ptie_model_free(model);
    if (status == PTIE_ECANCELLED)
        say("%s.last holds the last step; --resume goes on from there", s->output);
    return status == PTIE_OK ? conclude(s) : failed(status);
}

int train_command(int argc, char **argv) {
    settings s = {.compute = COMPUTE_DEFAULTS, .samples = SAMPLES_DEFAULTS};
    ptie_train_params_init(&s.train);
    ptie_model_params_init(&s.model);
    s.widths.count = s.model.levels;
    memcpy(s.widths.value, s.model.width, (size_t)s.model.levels * sizeof *s.model.width);
    int code = parse(&s, argc, argv);
    if (code == GO_ON) code = open_samples(&s.samples, "train");
    if (code == GO_ON) code = train(&s);
    close_samples(&s.samples);
    return code;
}
