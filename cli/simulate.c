/* SPDX-License-Identifier: BSD-3-Clause */
/* ptie simulate: a synthetic recording with its rig and its truth, or the gallery of all flows. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "gallery.h"

static const char *const families[] = {"parametric", "physical", NULL};
static const char *const boundaries[] = {"periodic", "mirror", NULL};
static const char *const propagations[] = {"tie-spectral", "tie-stencil", "angular-spectrum", NULL};

static const char examples[] =
    "  # 20 frames of a jet and the rig that goes with them\n"
    "  ptie simulate jet -o jet.h5\n"
    "  ptie run --rig jet.ini jet.h5 --model models/paper.safetensors -o phase.h5\n\n"
    "  # a shock front in real units, seen by diffraction\n"
    "  ptie simulate shock -o shock.h5 --family physical \\\n"
    "      --propagation angular-spectrum --boundary mirror\n\n"
    "  # what a polarisation camera would have written: MRAW, with recordings of\n"
    "  # no flow, of the dark and of a target, the truth and the rig beside it\n"
    "  ptie simulate jet -o lab.mraw --camera examples/camera.ini --seed 2 \\\n"
    "      --size 512 --pixel \"10 um\" --defocus \"20 mm\" --family physical \\\n"
    "      --propagation angular-spectrum --boundary mirror\n\n"
    "  # every flow there is, as one figure\n"
    "  ptie simulate --gallery gallery.png\n";

static const char notes[] =
    "MORPHOLOGY is one of: jet, eddies, front, pockets, fan, diffusion, shock,\n"
    "combustion, plasma, random, nozzle; or mix, several of them composed.\n\n"
    "The recording holds /entry/data/plus and /entry/data/minus (intensity relative\n"
    "to its mean) and /entry/truth/phase (rad).\n\n"
    "With --camera it holds counts, in the format of FILE's ending if the camera has\n"
    "a mosaic. Beside it: FILE_reference (no flow), FILE_dark, FILE_target (dots for\n"
    "'ptie rig calibrate'), FILE_truth.h5, the rig as a lab knows it and, as\n"
    "FILE_true.ini, as a perfect calibration would find it.\n";

typedef struct settings {
    compute_options compute;
    ptie_simulate_params params;
    frame_size size;
    const char *gallery, *camera_path;
    ptie_camera_params camera;
    char rig[PATH_BYTES]; /* beside the recording unless named */
    char *provenance;
} settings;

static int parse(settings *s, int argc, char **argv) {
    ptie_simulate_params *p = &s->params;
    int family = (int)p->flow.family, boundary = (int)p->boundary,
        propagation = (int)p->propagation;
    const option options[] = {
        {'o', "output", OPTION_TEXT, &p->output, "FILE", .help = "recording to write (.h5; from a mosaic also .mraw and others)"},
        {0, "rig-out", OPTION_TEXT, &p->rig, "FILE",
         .help = "rig file to write; if not given, beside the recording (.ini)"},
        {0, "gallery", OPTION_TEXT, &s->gallery, "FILE",
         .help = "draw every morphology of both families instead (.png or .svg)"},
        {'n', "frames", OPTION_INT64, &p->frames, "N", .low = 1, .high = 100000000,
         .help = "frames of the recording"},
        {0, "fps", OPTION_QUANTITY, &p->frame_rate_hz, "RATE", .quantity = PTIE_RATE,
         .help = "frame rate"},
        {0, "size", OPTION_SIZE, &s->size, "N or WxH", .help = "frame size in pixels"},
        {0, "noise", OPTION_QUANTITY, &p->noise, "SHARE", .quantity = PTIE_NUMBER,
         .help = "standard deviation of the camera noise, relative to the mean intensity"},
        {0, "camera", OPTION_TEXT, &s->camera_path, "FILE",
         .help = "camera file (.ini): counts instead of intensities; --noise does not count then"},
        {0, "reference-frames", OPTION_INT32, &p->reference_frames, "N", .low = 0, .high = 1000000,
         .help = "with --camera: frames of the no-flow recording"},
        {0, "dark-frames", OPTION_INT32, &p->dark_frames, "N", .low = 0, .high = 1000000,
         .help = "with --camera: frames of the dark recording"},
        {0, "target-frames", OPTION_INT32, &p->target_frames, "N", .low = 0, .high = 1000000,
         .help = "with --camera: frames of the calibration target"},
        {0, "family", OPTION_CHOICE, &family, "NAME", .choices = families,
         .help = "kind of flow model"},
        {0, "amplitude", OPTION_QUANTITY, &p->amplitude_rad, "ANGLE", .quantity = PTIE_ANGLE,
         .help = "height of the phase; 0: 1 rad for parametric flows, what the model says for "
                 "physical ones"},
        {0, "seed", OPTION_SEED, &p->flow.seed, "N", .help = "which flow, and which noise"},
        {0, "index", OPTION_SEED, &p->flow.index, "N", .help = "which flow of the seed"},
        {0, "wavelength", OPTION_QUANTITY, &p->flow.wavelength_m, "LENGTH", .quantity = PTIE_LENGTH,
         .help = "of the light"},
        {0, "pixel", OPTION_QUANTITY, &p->flow.pixel_m, "LENGTH", .quantity = PTIE_LENGTH,
         .help = "pixel pitch at the object"},
        {0, "defocus", OPTION_QUANTITY, &p->defocus_m, "LENGTH", .quantity = PTIE_LENGTH,
         .help = "distance of both planes from focus"},
        {0, "propagation", OPTION_CHOICE, &propagation, "NAME", .choices = propagations,
         .help = "forward model"},
        {0, "boundary", OPTION_CHOICE, &boundary, "NAME", .choices = boundaries,
         .help = "what lies beyond the frame"},
        COMPUTE_OPTIONS(s->compute),
    };
    const command_usage usage = {
        .name = "simulate",
        .purpose = "Simulates a camera recording of a moving flow, with its truth.",
        .examples = examples,
        .synopsis = "MORPHOLOGY -o FILE [options]\n  ptie simulate --gallery FILE.png [options]",
        .notes = notes,
        .most = 1,
        .options = options,
        .count = COUNT(options)};
    operand_list operands;
    int code = parse_options(&usage, argc, argv, &operands);
    if (code != GO_ON) return code;
    p->flow.family = (ptie_family)family;
    p->boundary = (ptie_boundary)boundary;
    p->propagation = (ptie_propagation)propagation;
    p->flow.width_px = s->size.width;
    p->flow.height_px = s->size.height;
    p->flow.morphology = operands.count ? operands.value[0] : NULL;
    p->overwrite = s->compute.force;
    if (s->gallery && operands.count)
        return misused("simulate: --gallery draws every morphology (found '%s')",
                       operands.value[0]);
    if (s->gallery) return GO_ON;
    if (!operands.count) return misused("simulate: missing MORPHOLOGY (see 'ptie help simulate')");
    if (!p->output) return misused("simulate: missing output (expected -o FILE.h5)");
    return GO_ON;
}

static int simulate(settings *s, int argc, char **argv) {
    progress_bar progress;
    ptie_ctx *ctx;
    ptie_simulate_params *p = &s->params;
    if (!p->rig && !replace_ending(s->rig, sizeof s->rig, p->output, ".ini"))
        return misused("simulate: name of the output too long");
    if (!p->rig) p->rig = s->rig;
    if (s->camera_path) {
        if (strcmp(s->camera_path, p->rig) == 0)
            return misused("simulate: the rig %s would be written over the camera file", p->rig);
        ptie_status status = ptie_camera_read(&s->camera, s->camera_path);
        if (status != PTIE_OK) return failed(status);
        p->camera = &s->camera;
    }
    p->provenance = s->provenance = joined_command(argc, argv);
    ptie_status status = open_context(&ctx, &s->compute);
    if (status != PTIE_OK) return failed(status);
    progress_start(&progress, s->compute.progress, "simulate", "frames");
    status = ptie_simulate(ctx, p, progress_callback(&progress));
    progress_end(&progress);
    ptie_ctx_free(ctx);
    if (status != PTIE_OK) return failed(status);
    say("%s: %lld frame%s of %d x %d px with the truth; rig in %s", p->output, (long long)p->frames,
        p->frames > 1 ? "s" : "", p->flow.width_px, p->flow.height_px, p->rig);
    return DONE;
}

int simulate_command(int argc, char **argv) {
    settings s = {.compute = COMPUTE_DEFAULTS};
    ptie_simulate_params_init(&s.params);
    s.size = (frame_size){s.params.flow.width_px, s.params.flow.height_px};
    int code = parse(&s, argc, argv);
    if (code == GO_ON && s.gallery)
        code = draw_gallery(s.gallery, &s.params.flow, s.compute.force);
    else if (code == GO_ON)
        code = simulate(&s, argc, argv);
    free(s.provenance);
    return code;
}
