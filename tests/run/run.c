/* SPDX-License-Identifier: BSD-3-Clause */
/* The pipeline on recordings made here: what it computes, that it is independent of threads and blocks, and
   what it refuses. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>

#include <ptie/ptie.h>

enum { WIDTH = 48, HEIGHT = 40, PIXELS = WIDTH * HEIGHT, FRAMES = 11 };

static const double pixel_m = 20e-6;

/* A blob that drifts; amplitude about 1 rad. */
static void true_phase(float *phase, int frame) {
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            double dx = x - 16 - frame, dy = y - 20;
            phase[y * WIDTH + x] = (float)exp(-(dx * dx + dy * dy) / 40);
        }
}

static void write_recording(const char *path, float (*frames)[PIXELS], int count) {
    ptie_writer *writer;
    ptie_recording_info info = {.width_px = WIDTH, .height_px = HEIGHT, .frames = count, .unit = "counts"};
    assert_ok(ptie_writer_create(&writer, path, "intensity", &info, true));
    for (int t = 0; t < count; t++) assert_ok(ptie_writer_append(writer, frames[t]));
    assert_ok(ptie_writer_close(writer));
}

static ptie_optics *make_optics(ptie_ctx *ctx) {
    ptie_optics_params p;
    ptie_optics *optics;
    ptie_optics_params_init(&p);
    p.width_px = WIDTH, p.height_px = HEIGHT, p.pixel_m = pixel_m, p.boundary = PTIE_MIRROR;
    assert_ok(ptie_optics_create(&optics, ctx, &p));
    return optics;
}

/* plus.npy, minus.npy, truth.npy, flat.npy in the temporary folder; sensor counts around 1000. */
static void write_pair(void) {
    static float plus[FRAMES][PIXELS], minus[FRAMES][PIXELS], truth[FRAMES][PIXELS], flat[1][PIXELS];
    ptie_ctx *ctx;
    assert_ok(ptie_ctx_create(&ctx, NULL));
    ptie_optics *optics = make_optics(ctx);
    void *scratch = ptie_scratch_alloc(ptie_optics_scratch_bytes(optics));
    for (int t = 0; t < FRAMES; t++) {
        true_phase(truth[t], t);
        assert_ok(ptie_optics_run(optics, plus[t], minus[t], truth[t], NULL, scratch));
        for (int i = 0; i < PIXELS; i++) plus[t][i] *= 1000, minus[t][i] *= 1000;
    }
    for (int i = 0; i < PIXELS; i++) flat[0][i] = 1000;
    write_recording(support_temporary("plus.npy"), plus, FRAMES);
    write_recording(support_temporary("minus.npy"), minus, FRAMES);
    write_recording(support_temporary("truth.npy"), truth, FRAMES);
    write_recording(support_temporary("flat.npy"), flat, 1);
    ptie_scratch_free(scratch);
    ptie_optics_free(optics);
    ptie_ctx_free(ctx);
}

typedef struct setting {
    ptie_rig rig;
    ptie_run_params params;
    char plus[256], minus[256], truth[256], output[256], reference[256];
} setting;

static void init(setting *s) {
    memset(s, 0, sizeof *s);
    ptie_rig_init(&s->rig);
    s->rig.pixel_m = pixel_m;
    ptie_run_params_init(&s->params);
    snprintf(s->plus, sizeof s->plus, "%s", support_temporary("plus.npy"));
    snprintf(s->minus, sizeof s->minus, "%s", support_temporary("minus.npy"));
    snprintf(s->truth, sizeof s->truth, "%s", support_temporary("truth.npy"));
    snprintf(s->output, sizeof s->output, "%s", support_temporary("out.h5"));
    snprintf(s->reference, sizeof s->reference, "%s", support_temporary("flat.npy"));
    s->params.rig = &s->rig;
    s->params.plane[PTIE_PLUS] = s->plus;
    s->params.plane[PTIE_MINUS] = s->minus;
    s->params.truth = s->truth;
    s->params.output = s->output;
    s->params.overwrite = true;
}

static void take_one_plane(setting *s) {
    s->rig.one_plane = true;
    s->rig.plane[PTIE_MINUS].used = false;
    s->params.plane[PTIE_MINUS] = NULL;
}

static ptie_status run_with(const setting *s, int32_t threads, ptie_run_summary *summary) {
    ptie_ctx *ctx;
    ptie_ctx_params p;
    ptie_ctx_params_init(&p);
    p.threads = threads;
    assert_ok(ptie_ctx_create(&ctx, &p));
    ptie_status status = ptie_run(ctx, &s->params, summary, (ptie_progress){0});
    ptie_ctx_free(ctx);
    return status;
}

static void read_frames(float (*frames)[PIXELS], const char *path, const char *unit) {
    ptie_recording *recording;
    assert_ok(ptie_recording_open(&recording, path));
    assert_int_equal(ptie_recording_get_info(recording)->frames, FRAMES);
    assert_string_equal(ptie_recording_get_info(recording)->unit, unit);
    for (int t = 0; t < FRAMES; t++) assert_ok(ptie_recording_read(recording, t, frames[t]));
    ptie_recording_close(recording);
}

static void read_phase(float (*frames)[PIXELS], const char *path) {
    read_frames(frames, path, "rad");
}

static void a_pair_gives_back_the_phase_on_any_number_of_threads(void **state) {
    (void)state;
    static float one[FRAMES][PIXELS], three[FRAMES][PIXELS];
    setting s;
    ptie_run_summary summary;
    init(&s);
    assert_ok(run_with(&s, 1, &summary));
    assert_int_equal(summary.frames, FRAMES);
    /* Intensities near 1000 are stored in f32 with relative spacing 2^-24 .. 2^-23, a white error of at most
       3.5e-8 (uniform, 2^-23/sqrt(12)) per image; (M8) for DCT turns it into 0.11528 (2 pi/lambda) sigma N p^2/dz
       = 9e-8 rad for N = 48.  Times 10 for the transforms' own rounding. */
    assert_near(summary.phase.rmse_rad.mean, 0, 1e-6);
    assert_true(summary.phase.correlation.mean > 0.999999);
    assert_near(summary.phase.signal_kept.mean, 1, 1e-5); /* 1e-6 rad of error over 0.2 rad rms */
    assert_near(summary.truth.mgm.mean, summary.phase.mgm.mean, 2e-6); /* two values differ, each by 1e-6 */
    assert_true(isnan(summary.denoised.mgm.mean));
    read_phase(one, s.output);
    assert_ok(run_with(&s, 3, &summary));
    read_phase(three, s.output);
    assert_memory_equal(one, three, sizeof one);
}

/* A chessboard on one plane is noise that the mirror's transform knows exactly: of the measured derivative it is
   a share that the planes themselves tell, and what the true phase cannot explain. */
static void the_truth_leaves_the_noise_as_residual(void **state) {
    (void)state;
    static float plus[FRAMES][PIXELS], minus[PIXELS];
    setting s;
    ptie_run_summary summary;
    ptie_recording *recording[2];
    char path[256];
    double noise = 0, all = 0;
    init(&s);
    assert_ok(ptie_recording_open(&recording[0], s.plus));
    assert_ok(ptie_recording_open(&recording[1], s.minus));
    for (int t = 0; t < FRAMES; t++) {
        assert_ok(ptie_recording_read(recording[0], t, plus[t]));
        assert_ok(ptie_recording_read(recording[1], t, minus));
        for (int i = 0; i < PIXELS; i++) {
            const float step = (i / WIDTH + i % WIDTH) % 2 ? 8 : -8;
            plus[t][i] += step;
            noise += (double)step * (double)step;
            all += ((double)plus[t][i] - (double)minus[i]) * ((double)plus[t][i] - (double)minus[i]);
        }
    }
    ptie_recording_close(recording[0]);
    ptie_recording_close(recording[1]);
    snprintf(path, sizeof path, "%s", support_temporary("chess.npy"));
    write_recording(path, plus, FRAMES);
    assert_ok(run_with(&s, 2, &summary));
    /* Rounding of the phase to f32, which the Laplacian amplifies, and of the transforms (M9): measured 1.2e-5 and
       6.3e-7; bounds four times that. */
    assert_near(summary.phase.residual.mean, 0, 5e-5);
    assert_near(summary.truth.residual.mean, 0, 3e-6);
    s.params.plane[PTIE_PLUS] = path;
    assert_ok(run_with(&s, 2, &summary));
    assert_near(summary.phase.residual.mean, 0, 5e-5);
    assert_near(summary.truth.residual.mean, sqrt(noise / all), 1e-4);
    assert_true(sqrt(noise / all) > 0.1);
}

static void the_border_is_zero_and_a_subset_is_the_same(void **state) {
    (void)state;
    static float all[FRAMES][PIXELS];
    setting s;
    ptie_run_summary summary;
    init(&s);
    assert_ok(run_with(&s, 2, &summary));
    read_phase(all, s.output);
    /* The blob's tail at the border is exp(-16^2/40) = 2e-3 rad at most; the median far below. */
    assert_near((double)all[0][PIXELS - 1], 0, 2e-3);
    s.params.frames = (ptie_frame_range){3, 8, 4};
    assert_ok(run_with(&s, 2, &summary));
    assert_int_equal(summary.frames, 2);
    float frame[PIXELS];
    ptie_recording *recording;
    assert_ok(ptie_recording_open(&recording, s.output));
    for (int i = 0; i < 2; i++) {
        assert_ok(ptie_recording_read(recording, i, frame));
        assert_memory_equal(frame, all[3 + 4 * i], sizeof frame);
    }
    ptie_recording_close(recording);
}

static void one_plane_with_a_reference_gives_the_same_phase(void **state) {
    (void)state;
    setting s;
    ptie_run_summary summary;
    init(&s);
    take_one_plane(&s);
    s.params.reference = s.reference;
    assert_ok(run_with(&s, 2, &summary));
    /* One difference over dz instead of two over 2 dz: twice the bound of the pair. */
    assert_near(summary.phase.rmse_rad.mean, 0, 2e-6);
}

static void binning_solves_on_larger_pixels(void **state) {
    (void)state;
    setting s;
    ptie_run_summary summary;
    init(&s);
    s.rig.binning = 2;
    assert_ok(run_with(&s, 2, &summary));
    assert_int_equal(summary.width_px, WIDTH / 2);
    assert_near(summary.pixel_m, 2 * pixel_m, 1e-18);
    /* Binning commutes with the Laplacian of a smooth phase up to (q p)^2 / 24 per axis: the blob's spectrum
       exp(-10 q^2) has q p < 0.5 at 2 sigma; 1 % of 0.2 rad rms, with margin 2. */
    assert_near(summary.phase.rmse_rad.mean, 0, 4e-3);
    assert_true(summary.phase.correlation.mean > 0.999);
}

/* White noise of 2 % on one plane is a cloud of 0.035 rad in the phase (M8). */
static void a_cutoff_is_chosen_from_the_recording(void **state) {
    (void)state;
    static float plus[FRAMES][PIXELS];
    setting s;
    ptie_run_summary all, some;
    init(&s);
    read_frames(plus, s.plus, "");
    for (int t = 0; t < FRAMES; t++) ptie_add_gaussian_noise(plus[t], PIXELS, 20, 3, 0, (uint64_t)t);
    write_recording(support_temporary("noisy.npy"), plus, FRAMES);
    snprintf(s.plus, sizeof s.plus, "%s", support_temporary("noisy.npy"));
    assert_ok(run_with(&s, 0, &all));
    s.rig.cutoff_m = PTIE_CUTOFF_AUTO;
    assert_ok(run_with(&s, 0, &some));
    assert_true(some.phase.rmse_rad.mean < 0.9 * all.phase.rmse_rad.mean);
    assert_true(some.phase.residual.mean > 100 * all.phase.residual.mean);
    assert_true(some.noise_rad.mean < all.noise_rad.mean);
}

static void opaque_pixels_have_no_phase(void **state) {
    (void)state;
    static float mask[1][PIXELS], phase[FRAMES][PIXELS], trusted[PIXELS];
    for (int i = 0; i < PIXELS; i++) mask[0][i] = i % WIDTH < 8 && i / WIDTH < 20 ? 0 : 1;
    write_recording(support_temporary("mask.npy"), mask, 1);
    for (int method = PTIE_SOLVE_DIRECT; method <= PTIE_SOLVE_US_TIE; method++) {
        setting s;
        ptie_run_summary summary;
        init(&s);
        s.rig.method = (ptie_solver_method)method;
        s.rig.max_iterations = 2;
        snprintf(s.rig.mask, sizeof s.rig.mask, "%s", support_temporary("mask.npy"));
        assert_ok(run_with(&s, 0, &summary));
        read_phase(phase, s.output);
        char path[300];
        ptie_recording *recording;
        snprintf(path, sizeof path, "%s:/entry/statistics/trusted", s.output);
        assert_ok(ptie_recording_open(&recording, path));
        assert_ok(ptie_recording_read(recording, 0, trusted));
        ptie_recording_close(recording);
        for (int i = 0; i < PIXELS; i++)
            if (mask[0][i] == 0) assert_true(phase[3][i] == 0 && trusted[i] == 0);
        assert_true(trusted[25 * WIDTH + 30] == 1 && trusted[3] == 0);
        assert_true(summary.phase.residual.mean < 1);
    }
}

static void regions_can_be_given(void **state) {
    (void)state;
    setting s;
    ptie_run_summary summary;
    init(&s);
    s.params.jet = (ptie_rect){14, 16, 12, 8};
    s.params.background = (ptie_rect){0, 0, 48, 6};
    assert_ok(run_with(&s, 1, &summary));
    assert_true(summary.phase.cnr.mean > 1);
    s.params.jet.width_px = 100;
    assert_fails(run_with(&s, 1, &summary), PTIE_EINVAL, "jet");
}

static ptie_status denoise_with_two_inputs(void) {
    ptie_ctx *ctx;
    ptie_model *model;
    ptie_model_params m;
    ptie_denoise_params p;
    ptie_model_params_init(&m);
    m.in_channels = 2;
    assert_ok(ptie_ctx_create(&ctx, NULL));
    assert_ok(ptie_model_create(&model, &m));
    ptie_denoise_params_init(&p);
    p.input = support_temporary("truth.npy");
    p.output = support_temporary("two.npy");
    p.model = model;
    ptie_status status = ptie_denoise(ctx, &p, (ptie_progress){0});
    ptie_model_free(model);
    ptie_ctx_free(ctx);
    return status;
}

static void a_model_of_other_inputs_is_refused(void **state) {
    (void)state;
    assert_fails(denoise_with_two_inputs(), PTIE_ESIZE, "expected 1 channel, found 2");
}

static void an_output_is_never_an_input(void **state) {
    (void)state;
    setting s;
    ptie_run_summary summary;
    size_t bytes, after;
    char other_name[300], csv[300];
    init(&s);
    snprintf(other_name, sizeof other_name, "%s", s.plus);
    *strrchr(other_name, '/') = 0;
    strcat(other_name, "/./plus.npy"); /* the same file under another name */
    unsigned char *before = support_read(s.plus, &bytes);
    s.params.output = other_name;
    assert_fails(run_with(&s, 1, &summary), PTIE_EINVAL, "would be written over");
    s.params.output = s.output;
    snprintf(csv, sizeof csv, "%s", s.truth);
    s.params.metrics_csv = csv;
    assert_fails(run_with(&s, 1, &summary), PTIE_EINVAL, "would be written over");
    s.params.metrics_csv = s.output;
    assert_fails(run_with(&s, 1, &summary), PTIE_EINVAL, "would be written over");
    unsigned char *kept = support_read(s.plus, &after);
    assert_int_equal(after, bytes);
    assert_memory_equal(kept, before, bytes);
    free(before), free(kept);
}

/* Without flow and noise in the first frame, SBR and CNR are 0/0 there; the others still count. */
static void a_frame_without_a_metric_does_not_hide_it(void **state) {
    (void)state;
    static float frames[2][FRAMES][PIXELS];
    static const char *const names[2] = {"plus.npy", "minus.npy"};
    setting s;
    ptie_run_summary summary;
    init(&s);
    char paths[2][300];
    for (int plane = 0; plane < 2; plane++) {
        ptie_recording *recording;
        assert_ok(ptie_recording_open(&recording, support_temporary(names[plane])));
        for (int t = 0; t < FRAMES; t++) assert_ok(ptie_recording_read(recording, t, frames[plane][t]));
        ptie_recording_close(recording);
        for (int i = 0; i < PIXELS; i++) frames[plane][0][i] = 1000;
        snprintf(paths[plane], sizeof paths[0], "%s", support_temporary(plane ? "still-.npy" : "still+.npy"));
        write_recording(paths[plane], frames[plane], FRAMES);
    }
    s.params.plane[PTIE_PLUS] = paths[0];
    s.params.plane[PTIE_MINUS] = paths[1];
    assert_ok(run_with(&s, 2, &summary));
    assert_true(isfinite(summary.phase.cnr.mean) && summary.phase.cnr.mean > 1);
}

/* Two equal planes are no flow: nothing to propose regions from, but maps there are, and RMSE. */
static void maps_without_flow_are_kept_without_regions(void **state) {
    (void)state;
    static float still[FRAMES][PIXELS], phase[FRAMES][PIXELS];
    setting s;
    ptie_run_summary summary;
    size_t bytes;
    char path[256], csv[256];
    init(&s);
    for (int i = 0; i < FRAMES * PIXELS; i++) still[i / PIXELS][i % PIXELS] = 1000;
    snprintf(path, sizeof path, "%s", support_temporary("still.npy"));
    snprintf(csv, sizeof csv, "%s", support_temporary("still.csv"));
    write_recording(path, still, FRAMES);
    s.params.plane[PTIE_PLUS] = s.params.plane[PTIE_MINUS] = path;
    s.params.metrics_csv = csv;
    assert_ok(run_with(&s, 2, &summary));
    assert_false(summary.has_regions);
    assert_true(isnan(summary.phase.mgm.mean) && isnan(summary.phase.cnr.mean));
    assert_true(summary.phase.rmse_rad.mean > 0.1); /* of a blob with 0.25 rad rms */
    read_phase(phase, s.output);
    for (int i = 0; i < PIXELS; i++) assert_true(phase[FRAMES - 1][i] == 0);
    char *text = (char *)support_read(csv, &bytes);
    assert_non_null(strstr(text, "\n10,,,,,0."));
    free(text);
    s.params.jet = (ptie_rect){14, 16, 12, 8};
    s.params.background = (ptie_rect){0, 0, 48, 6};
    assert_ok(run_with(&s, 2, &summary));
    assert_true(summary.has_regions && summary.phase.mgm.mean == 0);
}

static bool nothing_left(const setting *s) {
    char part[300];
    snprintf(part, sizeof part, "%s.part", s->output);
    return !support_exists(s->output) && !support_exists(part);
}

static void what_does_not_fit_is_refused_and_leaves_nothing(void **state) {
    (void)state;
    static float small[1][PIXELS], bad[FRAMES][PIXELS];
    setting s;
    ptie_run_summary summary;
    init(&s);
    remove(s.output);
    write_recording(support_temporary("short.npy"), small, 1);
    s.params.plane[PTIE_MINUS] = support_temporary("short.npy");
    assert_fails(run_with(&s, 1, &summary), PTIE_ESIZE, "expected 11, found 1");
    s.params.plane[PTIE_MINUS] = NULL;
    assert_fails(run_with(&s, 1, &summary), PTIE_EINVAL, "plane 'minus' is missing");
    take_one_plane(&s);
    assert_fails(run_with(&s, 1, &summary), PTIE_EINVAL, "no-flow reference is missing");

    init(&s);
    s.params.frames.first = 11;
    assert_fails(run_with(&s, 1, &summary), PTIE_EINVAL, "expected 0..10, found 11");
    s.params.frames.first = 0;
    s.params.plane[PTIE_PLUS] = support_temporary("none.npy");
    assert_fails(run_with(&s, 1, &summary), PTIE_EIO, "none.npy");

    for (int i = 0; i < PIXELS; i++) bad[10][i] = 1;
    bad[10][777] = NAN;
    write_recording(support_temporary("nan.npy"), bad, FRAMES);
    init(&s);
    s.params.plane[PTIE_MINUS] = support_temporary("nan.npy");
    assert_fails(run_with(&s, 1, &summary), PTIE_ENUMERIC, "");
    assert_true(nothing_left(&s));
}

static int stop_at_once(void *user, uint64_t done, uint64_t total, const char *note) {
    (void)user, (void)done, (void)total, (void)note;
    return 1;
}

static void cancelling_leaves_nothing(void **state) {
    (void)state;
    setting s;
    ptie_run_summary summary;
    ptie_ctx *ctx;
    init(&s);
    remove(s.output);
    assert_ok(ptie_ctx_create(&ctx, NULL));
    assert_fails(ptie_run(ctx, &s.params, &summary, (ptie_progress){stop_at_once, NULL}), PTIE_ECANCELLED,
                 "cancelled");
    ptie_ctx_free(ctx);
    assert_true(nothing_left(&s));
}

/* Stops a run when `at` frames are written. */
static int stop_later(void *user, uint64_t done, uint64_t total, const char *note) {
    (void)total, (void)note;
    return done >= *(const uint64_t *)user;
}

/* Enough frames that a stop lands behind those that regions are proposed from; the flow repeats. */
enum { LONG = 120 };

static void write_long_pair(setting *s, char paths[3][256]) {
    static float frames[LONG][PIXELS];
    static const char *const names[3] = {"plus.npy", "minus.npy", "truth.npy"};
    static const char *const long_names[3] = {"long+.npy", "long-.npy", "longt.npy"};
    for (int k = 0; k < 3; k++) {
        ptie_recording *recording;
        assert_ok(ptie_recording_open(&recording, support_temporary(names[k])));
        for (int t = 0; t < LONG; t++) assert_ok(ptie_recording_read(recording, t % FRAMES, frames[t]));
        ptie_recording_close(recording);
        snprintf(paths[k], sizeof paths[k], "%s", support_temporary(long_names[k]));
        write_recording(paths[k], frames, LONG);
    }
    s->params.plane[PTIE_PLUS] = paths[0];
    s->params.plane[PTIE_MINUS] = paths[1];
    s->params.truth = paths[2];
    s->params.overwrite = false;
    s->params.resume = true;
}

static ptie_status run_until(const setting *s, uint64_t stop, int32_t threads, ptie_run_summary *summary) {
    ptie_ctx *ctx;
    ptie_ctx_params p;
    ptie_ctx_params_init(&p);
    p.threads = threads;
    assert_ok(ptie_ctx_create(&ctx, &p));
    ptie_status status = ptie_run(ctx, &s->params, summary, (ptie_progress){stop_later, &stop});
    ptie_ctx_free(ctx);
    return status;
}

/* Stopped twice and resumed on other numbers of threads: file and table are those of a run left alone. */
static void a_resumed_run_is_the_run_left_alone(void **state) {
    (void)state;
    setting s;
    ptie_run_summary alone, resumed;
    char paths[3][256], alone_h5[256], parts_h5[256], alone_csv[256], parts_csv[256];
    size_t bytes[2];
    init(&s);
    write_long_pair(&s, paths);
    snprintf(alone_h5, sizeof alone_h5, "%s", support_temporary("alone.h5"));
    snprintf(alone_csv, sizeof alone_csv, "%s", support_temporary("alone.csv"));
    snprintf(parts_h5, sizeof parts_h5, "%s", support_temporary("parts.h5"));
    snprintf(parts_csv, sizeof parts_csv, "%s", support_temporary("parts.csv"));
    s.params.output = alone_h5, s.params.metrics_csv = alone_csv;
    assert_ok(run_until(&s, LONG + 1, 3, &alone));
    assert_int_equal(alone.resumed, 0);
    s.params.output = parts_h5, s.params.metrics_csv = parts_csv;
    assert_fails(run_until(&s, 40, 1, &resumed), PTIE_ECANCELLED, "cancelled after");
    const int64_t kept = resumed.frames;
    assert_true(kept >= 40 && kept < LONG);
    assert_fails(run_until(&s, (uint64_t)kept + 10, 3, &resumed), PTIE_ECANCELLED, "cancelled after");
    assert_true(resumed.frames >= kept + 10);
    assert_ok(run_until(&s, LONG + 1, 2, &resumed));
    assert_true(resumed.resumed >= kept + 10);
    resumed.resumed = 0;
    resumed.seconds = alone.seconds;
    assert_memory_equal(&resumed, &alone, sizeof alone);
    for (int csv = 0; csv < 2; csv++) {
        unsigned char *a = support_read(csv ? alone_csv : alone_h5, &bytes[0]);
        unsigned char *b = support_read(csv ? parts_csv : parts_h5, &bytes[1]);
        assert_int_equal(bytes[0], bytes[1]);
        assert_memory_equal(a, b, bytes[0]);
        free(a), free(b);
    }
}

static void only_the_same_run_goes_on(void **state) {
    (void)state;
    setting s;
    ptie_run_summary summary;
    char paths[3][256];
    init(&s);
    write_long_pair(&s, paths);
    s.params.output = support_temporary("begun.h5");
    assert_fails(run_until(&s, 40, 2, &summary), PTIE_ECANCELLED, "cancelled");
    s.params.frames.end = LONG - 1;
    assert_fails(run_until(&s, LONG, 2, &summary), PTIE_EINVAL, "was begun with other settings (expected 'planes = ");
    s.params.frames.end = 0;
    s.rig.zero_border = false;
    assert_fails(run_until(&s, LONG, 2, &summary), PTIE_EINVAL, "(expected 'zero_border = no', found 'zero_border = yes')");
    s.rig.zero_border = true;
    s.params.resume = false;
    assert_fails(run_until(&s, LONG, 2, &summary), PTIE_EEXIST, "frames of an interrupted run (use --resume");
    s.params.overwrite = true;
    assert_ok(run_until(&s, LONG + 1, 2, &summary));
    assert_int_equal(summary.frames, LONG);
    assert_int_equal(summary.resumed, 0);
}

/* The page has every section, stands alone, and tells a file that is no result. */
static void a_result_becomes_a_page(void **state) {
    (void)state;
    setting s;
    ptie_run_summary summary;
    size_t bytes;
    init(&s);
    assert_ok(run_with(&s, 2, &summary));
    const char *page = support_temporary("page.html");
    assert_ok(ptie_report_write(page, s.output, false));
    assert_fails(ptie_report_write(page, s.output, false), PTIE_EEXIST, "page.html");
    assert_fails(ptie_report_write(support_temporary("no.html"), s.plus, false), PTIE_EFORMAT, "plus.npy");
    assert_false(support_exists(support_temporary("no.html")));
    assert_false(support_exists(support_temporary("page.html.part.png")));
    char *text = (char *)support_read(page, &bytes);
    static const char *const sections[] = {"<h2>Phase</h2>", "<h2>Metrics</h2>", "<h2>Noise</h2>", "<h2>Rig</h2>", "data:image/png;base64,iVBORw0KGgo"};
    for (size_t i = 0; i < sizeof sections / sizeof *sections; i++) assert_non_null(strstr(text, sections[i]));
    assert_null(strstr(text, "src=\"http"));
    free(text);
}

static void metrics_go_to_csv(void **state) {
    (void)state;
    setting s;
    ptie_run_summary summary;
    size_t bytes;
    init(&s);
    char csv[256];
    snprintf(csv, sizeof csv, "%s", support_temporary("metrics.csv"));
    s.params.metrics_csv = csv;
    assert_ok(run_with(&s, 2, &summary));
    char *text = (char *)support_read(csv, &bytes);
    assert_non_null(strstr(text, "frame,"));
    int lines = 0;
    for (size_t i = 0; i < bytes; i++) lines += text[i] == '\n';
    assert_int_equal(lines, FRAMES + 1);
    free(text);
    s.params.overwrite = false;
    s.params.output = support_temporary("other.h5");
    assert_fails(run_with(&s, 1, &summary), PTIE_EEXIST, "metrics.csv");
    assert_false(support_exists(support_temporary("other.h5")));
}

static int setup(void **state) {
    (void)state;
    write_pair();
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pair_gives_back_the_phase_on_any_number_of_threads),
        cmocka_unit_test(the_truth_leaves_the_noise_as_residual),
        cmocka_unit_test(the_border_is_zero_and_a_subset_is_the_same),
        cmocka_unit_test(one_plane_with_a_reference_gives_the_same_phase),
        cmocka_unit_test(binning_solves_on_larger_pixels),
        cmocka_unit_test(a_cutoff_is_chosen_from_the_recording),
        cmocka_unit_test(opaque_pixels_have_no_phase),
        cmocka_unit_test(regions_can_be_given),
        cmocka_unit_test(a_model_of_other_inputs_is_refused),
        cmocka_unit_test(an_output_is_never_an_input),
        cmocka_unit_test(a_frame_without_a_metric_does_not_hide_it),
        cmocka_unit_test(maps_without_flow_are_kept_without_regions),
        cmocka_unit_test(what_does_not_fit_is_refused_and_leaves_nothing),
        cmocka_unit_test(cancelling_leaves_nothing),
        cmocka_unit_test(a_resumed_run_is_the_run_left_alone),
        cmocka_unit_test(only_the_same_run_goes_on),
        cmocka_unit_test(a_result_becomes_a_page),
        cmocka_unit_test(metrics_go_to_csv),
    };
    return cmocka_run_group_tests_name("run", tests, setup, NULL);
}
