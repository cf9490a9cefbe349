/* SPDX-License-Identifier: BSD-3-Clause */
#include "pipelines.h"

#include <math.h>
#include <string.h>

#include <ptie/ptie.h>

#include "support/support.h"

enum { SIDE = 16, PIXELS = SIDE * SIDE, FRAMES = 3, MOST_PATHS = 32 };

const char *pipeline_path(const char *name) {
    static struct {
        char name[32], path[256];
    } known[MOST_PATHS];
    int i = 0;
    while (i < MOST_PATHS && known[i].name[0] && strcmp(known[i].name, name) != 0) i++;
    assert_true(i < MOST_PATHS);
    if (!known[i].name[0]) {
        snprintf(known[i].name, sizeof known[i].name, "%s", name);
        snprintf(known[i].path, sizeof known[i].path, "%s", support_temporary(name));
    }
    return known[i].path;
}

/* --- inputs ---------------------------------------------------------------------------------------------- */

/* A blob that drifts over a slope, around 1000 counts. */
static void fill_frame(float *frame, int t, double sign) {
    for (int i = 0; i < PIXELS; i++) {
        const double x = i % SIDE - 6 - t, y = i / SIDE - 8;
        frame[i] = (float)(1000 + sign * (40 * exp(-(x * x + y * y) / 9) + x));
    }
}

static ptie_status write_recording(const char *path, int frames, double sign) {
    ptie_writer *writer;
    const ptie_recording_info info = {.width_px = SIDE, .height_px = SIDE, .frames = frames, .unit = "counts",
                                      .frame_rate_hz = 1000, .pixel_m = 2e-5, .frame_step = 1};
    float frame[PIXELS];
    ptie_status status = ptie_writer_create(&writer, path, "intensity", &info, true);
    if (status != PTIE_OK) return status;
    for (int t = 0; t < frames && status == PTIE_OK; t++) {
        fill_frame(frame, t, sign);
        status = ptie_writer_append(writer, frame);
    }
    if (status == PTIE_OK) return ptie_writer_close(writer);
    ptie_writer_discard(writer);
    return status;
}

static void write_model(void) {
    ptie_model_params params;
    ptie_model *model;
    ptie_model_params_init(&params);
    params.levels = 2;
    params.width[0] = params.width[1] = 2;
    assert_ok(ptie_model_create(&model, &params));
    assert_ok(ptie_model_save(model, pipeline_path("model.safetensors"), true));
    ptie_model_free(model);
}

void pipelines_prepare(void) {
    static const char rig[] = "[optics]\nwavelength = 532 nm\npixel = 20 um\ndefocus = 10 mm\n";
    assert_ok(write_recording(pipeline_path("plus.npy"), FRAMES, 1));
    assert_ok(write_recording(pipeline_path("minus.npy"), FRAMES, -1));
    assert_ok(write_recording(pipeline_path("plus.h5"), FRAMES, 1));
    assert_ok(write_recording(pipeline_path("plus.tif"), FRAMES, 1));
    assert_ok(write_recording(pipeline_path("in_%02d.png"), FRAMES, 1));
    support_write(pipeline_path("rig.ini"), rig, sizeof rig - 1);
    write_model();
}

/* --- jobs ------------------------------------------------------------------------------------------------- */

static ptie_status start(ptie_ctx **ctx) {
    ptie_ctx_params params;
    ptie_ctx_params_init(&params);
    params.threads = 2;
    return ptie_ctx_create(ctx, &params);
}

static ptie_status run_with(ptie_ctx *ctx, const ptie_model *model) {
    ptie_rig rig;
    ptie_run_params params;
    ptie_run_summary summary;
    ptie_rig_init(&rig);
    ptie_status status = ptie_rig_load(&rig, pipeline_path("rig.ini"));
    if (status != PTIE_OK) return status;
    ptie_run_params_init(&params);
    params.rig = &rig;
    params.plane[PTIE_PLUS] = pipeline_path("plus.npy");
    params.plane[PTIE_MINUS] = pipeline_path("minus.npy");
    params.truth = pipeline_path("plus.npy");
    params.model = model;
    params.output = pipeline_path("run.h5");
    params.metrics_csv = pipeline_path("run.csv");
    params.overwrite = params.resume = true;
    return ptie_run(ctx, &params, &summary, (ptie_progress){0});
}

/* Phase, denoised phase and metrics. */
static ptie_status run(void) {
    ptie_ctx *ctx = NULL;
    ptie_model *model = NULL;
    ptie_status status = start(&ctx);
    if (status == PTIE_OK) status = ptie_model_load(&model, pipeline_path("model.safetensors"));
    if (status == PTIE_OK) status = run_with(ctx, model);
    ptie_model_free(model);
    ptie_ctx_free(ctx);
    return status;
}

static ptie_status reconstruct(void) {
    ptie_ctx *ctx = NULL;
    ptie_status status = start(&ctx);
    if (status == PTIE_OK) status = run_with(ctx, NULL);
    ptie_ctx_free(ctx);
    return status;
}

static ptie_status denoise_to(ptie_ctx *ctx, const ptie_model *model) {
    ptie_denoise_params params;
    ptie_denoise_params_init(&params);
    params.model = model;
    params.input = pipeline_path("plus.npy");
    params.output = pipeline_path("denoised.h5");
    params.overwrite = true;
    return ptie_denoise(ctx, &params, (ptie_progress){0});
}

static ptie_status denoise(void) {
    ptie_ctx *ctx = NULL;
    ptie_model *model = NULL;
    ptie_status status = start(&ctx);
    if (status == PTIE_OK) status = ptie_model_load(&model, pipeline_path("model.safetensors"));
    if (status == PTIE_OK) status = denoise_to(ctx, model);
    ptie_model_free(model);
    ptie_ctx_free(ctx);
    return status;
}

static ptie_status simulate(void) {
    ptie_ctx *ctx = NULL;
    ptie_simulate_params params;
    ptie_simulate_params_init(&params);
    params.flow.width_px = params.flow.height_px = SIDE;
    params.flow.morphology = "jet";
    params.frames = FRAMES;
    params.output = pipeline_path("simulated.h5");
    params.rig = pipeline_path("simulated.ini");
    params.overwrite = true;
    ptie_status status = start(&ctx);
    if (status == PTIE_OK) status = ptie_simulate(ctx, &params, (ptie_progress){0});
    ptie_ctx_free(ctx);
    return status;
}

/* All frames of one recording into another. */
static ptie_status copy_frames(ptie_recording *recording, ptie_writer *writer) {
    float frame[PIXELS];
    ptie_status status = PTIE_OK;
    for (int64_t t = 0; t < ptie_recording_get_info(recording)->frames && status == PTIE_OK; t++) {
        status = ptie_recording_read(recording, t, frame);
        if (status == PTIE_OK) status = ptie_writer_append(writer, frame);
    }
    return status;
}

static ptie_status convert(const char *from, const char *to) {
    ptie_recording *recording;
    ptie_writer *writer = NULL;
    ptie_status status = ptie_recording_open(&recording, pipeline_path(from));
    if (status != PTIE_OK) return status;
    status = ptie_writer_create(&writer, pipeline_path(to), "intensity", ptie_recording_get_info(recording), true);
    if (status == PTIE_OK) status = copy_frames(recording, writer);
    if (status == PTIE_OK)
        status = ptie_writer_close(writer);
    else
        ptie_writer_discard(writer);
    ptie_recording_close(recording);
    return status;
}

static ptie_status npy_to_h5(void) {
    return convert("plus.npy", "converted.h5");
}

static ptie_status h5_to_npy(void) {
    return convert("plus.h5", "converted.npy");
}

static ptie_status tiff_to_npy(void) {
    return convert("plus.tif", "converted.npy");
}

static ptie_status npy_to_tiff(void) {
    return convert("plus.npy", "converted.tif");
}

static ptie_status images_to_images(void) {
    return convert("in_%02d.png", "out_%02d.png");
}

const pipeline pipelines[] = {
    {"run", run, {"run.h5", "run.csv"}, true},
    {"reconstruct", reconstruct, {"run.h5", "run.csv"}, true},
    {"denoise", denoise, {"denoised.h5"}, false},
    {"simulate", simulate, {"simulated.h5", "simulated.ini"}, false},
    {"npy to h5", npy_to_h5, {"converted.h5"}, false},
    {"h5 to npy", h5_to_npy, {"converted.npy"}, false},
    {"npy to tiff", npy_to_tiff, {"converted.tif"}, false},
    {"tiff to npy", tiff_to_npy, {"converted.npy"}, false},
    {"images to images", images_to_images, {"out_00.png", "out_01.png", "out_02.png"}, false},
};
const int pipeline_count = sizeof pipelines / sizeof *pipelines;
