/* SPDX-License-Identifier: BSD-3-Clause */
/* ptie info: what is in a recording, data set, model, rig, preset; what this machine runs. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "facts.h"
#include "json.h"
#include "recording_facts.h"

static const char examples[] = "  ptie info                            # this machine\n"
                               "  ptie info models/paper.safetensors   # a model\n"
                               "  ptie info jet.h5:/entry/data/plus    # a recording\n"
                               "  ptie info shot.mraw --json           # one of a camera, for a program\n"
                               "  ptie info paper > mine.ini           # a preset, to edit\n";

static void add_names(facts *f, const char *name, const char *(*name_of)(int32_t which)) {
    for (int32_t i = 0; name_of(i); i++) add_to_list(f, name, name_of(i));
}

static ptie_status describe_machine(facts *f) {
    ptie_ctx *ctx;
    ptie_machine machine;
    ptie_status status = ptie_ctx_create(&ctx, NULL);
    if (status != PTIE_OK) return status;
    ptie_machine_describe(&machine);
    add_text(f, "version", "%s", ptie_version());
    add_text(f, "commit", "%s", machine.commit);
    add_text(f, "compiler", "%s", machine.compiler);
    add_text(f, "processor", "%s", machine.processor);
    add_number(f, "threads", ptie_ctx_threads(ctx), "%d", ptie_ctx_threads(ctx));
    add_text(f, "level", "%s", ptie_ctx_cpu(ctx));
    add_names(f, "levels", ptie_level_name);
    add_number(f, "half precision", machine.half, "%s",
               machine.half ? "yes: --fast takes effect" : "no: --fast computes in single precision");
    add_names(f, "kernels", ptie_kernel_name);
    add_names(f, "presets", ptie_preset_name);
    ptie_ctx_free(ctx);
    return PTIE_OK;
}

static ptie_status describe_model(facts *f, const char *path) {
    static const char *const notes[][2] = {{"trained on", "ptie.trained_on"},
                                           {"epochs", "ptie.epochs"},
                                           {"seed", "ptie.seed"},
                                           {"generator", "ptie.generator"},
                                           {"kernels", "ptie.kernels"},
                                           {"written by", "ptie.version"}};
    ptie_model *model;
    char number[32], widths[FACT_BYTES] = "";
    size_t used = 0;
    ptie_status status = ptie_model_load(&model, path);
    if (status != PTIE_OK) return status;
    const ptie_model_params *p = ptie_model_get_params(model);
    for (int32_t i = 0; i < p->levels; i++)
        used += (size_t)snprintf(widths + used, sizeof widths - used, "%s%d", i ? ", " : "",
                                 p->width[i]);
    add_text(f, "kind", "model");
    add_text(f, "name", "%s", ptie_model_name(model));
    add_number(f, "parameters", (double)ptie_model_trainable(model), "%s trainable",
               with_separators(number, ptie_model_trainable(model)));
    add_number(f, "levels", p->levels, "%d (%s channels)", p->levels, widths);
    add_number(f, "inputs", p->in_channels, "%d channel%s", p->in_channels,
               p->in_channels > 1 ? "s" : "");
    add_text(f, "output", "%s", p->output == PTIE_SIGMOID ? "sigmoid" : "linear");
    for (size_t i = 0; i < COUNT(notes); i++) {
        const char *text = ptie_model_note(model, notes[i][1]);
        if (text) add_text(f, notes[i][0], "%s", text);
    }
    ptie_model_free(model);
    return PTIE_OK;
}

static ptie_status describe_dataset(facts *f, const char *path) {
    static const struct {
        const char *name;
        ptie_split split;
    } splits[] = {{"samples", PTIE_ALL},
                  {"train", PTIE_TRAIN},
                  {"validation", PTIE_VALIDATION},
                  {"test", PTIE_TEST}};
    ptie_dataset *dataset;
    int32_t width, height;
    char number[32];
    ptie_status status = ptie_dataset_open(&dataset, path);
    if (status != PTIE_OK) return status;
    ptie_dataset_size(dataset, &width, &height);
    add_text(f, "kind", "data set");
    add_text(f, "size", "%d x %d px", width, height);
    for (size_t i = 0; i < COUNT(splits); i++) {
        uint64_t count = ptie_dataset_count(dataset, splits[i].split);
        add_number(f, splits[i].name, (double)count, "%s", with_separators(number, count));
    }
    ptie_dataset_free(dataset);
    return PTIE_OK;
}

static void add_path(facts *f, const char *name, const char *path) {
    if (path[0]) add_text(f, name, "%s", path);
}

static void describe_planes(facts *f, const ptie_rig *rig) {
    static const char *const names[PTIE_ROLES] = {"plus", "minus", "zero", "plus2", "minus2"};
    for (int i = 0; i < PTIE_ROLES; i++) {
        const ptie_plane *plane = &rig->plane[i];
        char defocus[PTIE_QUANTITY_BYTES];
        if (!plane->used) continue;
        ptie_print_rounded(defocus, plane->defocus_m, PTIE_LENGTH);
        add_text(f, names[i], "%s%s%s", defocus, plane->source[0] ? ", " : "", plane->source);
    }
}

static void describe_rig(facts *f, const ptie_rig *rig) {
    static const char *const layouts[] = {"separate", "mosaic", "side-by-side", "top-bottom", "quadrants"};
    static const char *const polarities[] = {"negative", "auto", "positive"};
    static const char *const methods[] = {"direct", "max-intensity", "two-poisson", "iterative-dct", "us-tie"};
    add_text(f, "kind", "rig");
    add_quantity(f, "wavelength", rig->wavelength_m, PTIE_LENGTH);
    add_quantity(f, "pixel", rig->pixel_m, PTIE_LENGTH);
    add_text(f, "layout", "%s", layouts[rig->layout]);
    describe_planes(f, rig);
    add_path(f, "reference", rig->reference);
    add_path(f, "dark", rig->dark);
    add_path(f, "mask", rig->mask);
    add_text(f, "polarity", "%s", polarities[rig->polarity + 1]);
    add_number(f, "binning", rig->binning, "%d", rig->binning);
    add_text(f, "boundary", "%s", rig->boundary == PTIE_PERIODIC ? "periodic" : "mirror");
    add_text(f, "method", "%s", methods[rig->method]);
    if (rig->cutoff_m > 0) add_quantity(f, "cutoff", rig->cutoff_m, PTIE_LENGTH);
    if (rig->cutoff_m < 0) add_text(f, "cutoff", "%s", rig->cutoff_m == PTIE_CUTOFF_AUTO ? "auto" : "l-curve");
    if (rig->frame_rate_hz > 0) add_quantity(f, "frame rate", rig->frame_rate_hz, PTIE_RATE);
}

/* A preset is shown as its own text, which reads back. */
static ptie_status print_preset(const char *name, bool json) {
    ptie_preset *preset;
    ptie_status status = ptie_preset_load(&preset, name);
    if (status != PTIE_OK) return status;
    if (json) {
        printf("{\n  \"kind\": \"preset\",\n  \"text\": ");
        json_text(stdout, ptie_preset_text(preset));
        printf("\n}\n");
    } else {
        printf("%s", ptie_preset_text(preset));
    }
    ptie_preset_free(preset);
    return PTIE_OK;
}

static bool is_built_in(const char *name) {
    for (int32_t i = 0; ptie_preset_name(i); i++)
        if (strcmp(ptie_preset_name(i), name) == 0) return true;
    return false;
}

/* INI files are rigs or presets.  A rig that only lacks something is one; if it is neither, what
 * the rig's reader says is the message. */
static ptie_status describe_ini(facts *f, const char *path, bool json) {
    ptie_rig rig;
    ptie_rig_init(&rig);
    ptie_status status = ptie_rig_load(&rig, path);
    if (status == PTIE_OK)
        describe_rig(f, &rig);
    else if (status != PTIE_EINVAL && print_preset(path, json) == PTIE_OK)
        status = PTIE_OK;
    else
        status = ptie_rig_load(&rig, path);
    return status;
}

static ptie_status describe_file(facts *f, const char *path, bool json) {
    const bool hdf5 = ends_in(path, ".h5") || ends_in(path, ".hdf5");
    if (ends_in(path, ".ini")) return describe_ini(f, path, json);
    if (ends_in(path, ".safetensors")) return describe_model(f, path);
    if (hdf5 && describe_dataset(f, path) == PTIE_OK) return PTIE_OK;
    return add_recording(f, path);
}

int info_command(int argc, char **argv) {
    bool json = false;
    const option options[] = {{0, "json", OPTION_FLAG, &json, .help = "as JSON"}};
    const command_usage usage = {
        .name = "info",
        .purpose = "Tells what is in a recording, data set, model, rig file or preset; without "
                   "a name, what this machine runs.",
        .examples = examples,
        .synopsis = "[FILE | PRESET] [--json]",
        .most = 1,
        .options = options,
        .count = COUNT(options)};
    operand_list operands;
    facts f = {.count = 0};
    int code = parse_options(&usage, argc, argv, &operands);
    if (code != GO_ON) return code;
    const char *name = operands.count ? operands.value[0] : NULL;
    ptie_status status = !name               ? describe_machine(&f)
                         : is_built_in(name) ? print_preset(name, json)
                                             : describe_file(&f, name, json);
    if (status != PTIE_OK) return failed(status);
    if (f.count > 0) print_facts(&f, json);
    return DONE;
}
