/* SPDX-License-Identifier: BSD-3-Clause */
/* A host program that calls setlocale writes the same files and reads them the same. */
#include "train/tiny.h"

#include <locale.h>
#include <stdlib.h>

#include <ptie/ptie.h>

static const ptie_progress silent = {0};

/* Commas for decimal points, from the system or made here; else the case is skipped. */
static void write_commas(void) {
    char command[300];
    if (setlocale(LC_ALL, "de_DE.UTF-8") == NULL) {
        const char *made = support_temporary("de_DE.UTF-8");
        snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 '%s' >/dev/null 2>&1", made);
        const bool failed = system(command) != 0;
        setenv("LOCPATH", support_temporary(""), 1);
        if (failed || setlocale(LC_ALL, "de_DE.UTF-8") == NULL) {
            print_message("# no locale de_DE.UTF-8, and no localedef to make it\n");
            skip();
        }
    }
    char text[16];
    snprintf(text, sizeof text, "%.1f", 0.5);
    assert_string_equal(text, "0,5");
}

static int write_points(void **state) {
    (void)state;
    return setlocale(LC_ALL, "C") == NULL;
}

static void path_in(char path[256], const char *language, const char *name) {
    char file[64];
    snprintf(file, sizeof file, "%s-%s", language, name);
    snprintf(path, 256, "%s", support_temporary(file));
}

static void write_map(const char *language, const char *name) {
    char path[256];
    float map[16 * 16];
    ptie_writer *writer;
    const ptie_recording_info info = {.width_px = 16,
                                      .height_px = 16,
                                      .frames = 1,
                                      .unit = "rad",
                                      .frame_rate_hz = 2.5,
                                      .pixel_m = 1.25e-5};
    for (int i = 0; i < 16 * 16; i++) map[i] = 0.125f * (float)i - 3.5f;
    path_in(path, language, name);
    assert_ok(ptie_writer_create(&writer, path, "phase", &info, true));
    assert_ok(ptie_writer_append(writer, map));
    assert_ok(ptie_writer_close(writer));
    ptie_recording *recording;
    assert_ok(ptie_recording_open(&recording, path));
    /* TIFF keeps the pixel as f32: 2^-24 of it; the rate with nine digits. */
    assert_near(ptie_recording_get_info(recording)->pixel_m, 1.25e-5, 1.25e-5 * 6e-8);
    assert_near(ptie_recording_get_info(recording)->frame_rate_hz, 2.5, 1e-8);
    ptie_recording_close(recording);
}

static void draw(const char *language) {
    static const double x[] = {0, 0.25, 0.5}, y[] = {0.01, 1.5, 0.75};
    float map[32 * 32];
    char path[256];
    for (int i = 0; i < 32 * 32; i++) map[i] = 0.001f * (float)i;
    const ptie_panel panel = {.data = map, .width_px = 32, .height_px = 32, .unit = "rad", .pixel_m = 7.8e-6};
    const ptie_curve curve = {.x = x, .y = y, .count = 3, .label = "loss"};
    const ptie_axes axes = {.curves = &curve, .count = 1, .x_label = "epoch"};
    path_in(path, language, "panels.png");
    assert_ok(ptie_figure_panels(path, &(ptie_panels){.panels = &panel, .rows = 1, .columns = 1}, true));
    path_in(path, language, "curves.png");
    assert_ok(ptie_figure_curves(path, &axes, 1, NULL, 85.5, true));
}

/* A recording with its rig, the rig read back, and the metrics of what comes out. */
static void simulate_and_run(const char *language) {
    char recording[256], rig_path[256], result[256], csv[256];
    ptie_ctx *ctx = tiny_context(1);
    ptie_simulate_params s;
    path_in(recording, language, "jet.h5");
    path_in(rig_path, language, "rig.ini");
    path_in(result, language, "phase.h5");
    path_in(csv, language, "metrics.csv");
    ptie_simulate_params_init(&s);
    s.flow.width_px = s.flow.height_px = 64;
    s.flow.morphology = "jet";
    s.flow.pixel_m = 12.5e-6;
    s.frames = 2;
    s.output = recording;
    s.rig = rig_path;
    assert_ok(ptie_simulate(ctx, &s, silent));

    ptie_rig rig;
    ptie_run_params p;
    ptie_run_summary summary;
    ptie_rig_init(&rig);
    assert_ok(ptie_rig_load(&rig, rig_path));
    assert_true(rig.pixel_m == 12.5e-6);
    ptie_run_params_init(&p);
    p.rig = &rig;
    p.recording = recording;
    p.output = result;
    p.metrics_csv = csv;
    p.jet = (ptie_rect){24, 24, 16, 16};
    p.background = (ptie_rect){0, 0, 8, 64};
    assert_ok(ptie_run(ctx, &p, &summary, silent));
    ptie_ctx_free(ctx);
}

static void train(const char *language, uint64_t steps_limit, bool resume) {
    char path[256];
    ptie_train_params params = tiny_params();
    params.epochs = 2;
    params.steps_limit = steps_limit;
    params.resume = resume;
    params.overwrite = true;
    path_in(path, language, "m.safetensors");
    assert_ok(tiny_train(path, 1, &params, silent));
    ptie_model *model;
    assert_ok(ptie_model_load(&model, path));
    assert_true(ptie_model_get_params(model)->dropout == 0.1);
    ptie_model_free(model);
}

static void assert_same_history(void) {
    char path[256];
    ptie_epoch *rows[2];
    size_t count[2];
    for (int i = 0; i < 2; i++) {
        path_in(path, i ? "de" : "c", "m.safetensors");
        assert_ok(ptie_history_read(&rows[i], &count[i], path));
    }
    assert_int_equal(count[0], count[1]);
    for (size_t e = 0; e < count[0]; e++) {
        rows[1][e].seconds = rows[0][e].seconds;
        assert_memory_equal(&rows[1][e], &rows[0][e], sizeof rows[0][e]);
    }
    ptie_history_free(rows[0]);
    ptie_history_free(rows[1]);
}

static void write_everything(const char *language) {
    write_map(language, "map.png");
    write_map(language, "map.tif");
    draw(language);
    simulate_and_run(language);
}

static void files_are_the_same_in_any_locale(void **state) {
    (void)state;
    static const char *const names[] = {"map.png", "map.tif",     "panels.png",   "curves.png",
                                        "rig.ini", "metrics.csv", "m.safetensors"};
    write_everything("c");
    train("c", 0, false);
    train("de", 8, false);
    write_commas();
    write_everything("de");
    train("de", 0, true); /* a checkpoint of the other locale */
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char paths[2][256];
        size_t bytes[2];
        unsigned char *data[2];
        for (int k = 0; k < 2; k++) {
            path_in(paths[k], k ? "de" : "c", names[i]);
            data[k] = support_read(paths[k], &bytes[k]);
        }
        if (bytes[0] != bytes[1] || memcmp(data[0], data[1], bytes[0]) != 0)
            fail_msg("%s differs with the locale", names[i]);
        free(data[0]), free(data[1]);
    }
    assert_same_history();
}

static void quantities_and_messages_have_points(void **state) {
    (void)state;
    double value;
    char text[PTIE_QUANTITY_BYTES];
    write_commas();
    assert_null(ptie_parse_quantity("1.5 mm", PTIE_LENGTH, &value));
    assert_near(value, 1.5e-3, 1e-18);
    assert_non_null(ptie_parse_quantity("1,5 mm", PTIE_LENGTH, &value));
    assert_string_equal(ptie_print_quantity(text, 12.5e-6, PTIE_LENGTH), "12.5 um");
    ptie_comparison comparison;
    assert_fails(ptie_compare(&comparison, &(float){0}, &(float){0}, 1, 1, -0.5), PTIE_EINVAL,
                 "found -0.5");
    snprintf(text, sizeof text, "%.1f", 0.5); /* the host's own printing is as it was */
    assert_string_equal(text, "0,5");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(files_are_the_same_in_any_locale, write_points),
        cmocka_unit_test_teardown(quantities_and_messages_have_points, write_points),
    };
    return cmocka_run_group_tests_name("locale", tests, NULL, NULL);
}
