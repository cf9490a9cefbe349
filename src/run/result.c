/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/result.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "rig/planes.h"
#include "rig/rig.h"
#include "run/run.h"
#include "tie/derivative.h"
#include "tie/solver.h"

#define METRICS "/entry/metrics"
#define PROCESS PTIE_NEXUS_PROCESS
#define STATISTICS "/entry/statistics"
#define PHASE PTIE_NEXUS_DATA "/phase"
#define DENOISED PTIE_NEXUS_DATA "/denoised"
#define SETTINGS "settings" /* attribute of PROCESS */

_Static_assert(PTIE_RUN_WARNING_BYTES == PTIE_H5_LINE_BYTES, "a warning is a line");

struct ptie_result {
    ptie_output_file file;
    int64_t finished;
    bool denoised;
    bool has[PTIE_ROW];
    ptie_place phase_maps, denoised_maps, field[PTIE_RESULT_FIELDS], column[PTIE_ROW];
};

static const struct {
    const char *path, *long_name;
    ptie_h5_type type;
} fields[PTIE_RESULT_FIELDS] = {
    [PTIE_RESULT_REGIONS] = {METRICS "/regions", "0 nowhere, 1 jet, 2 background", PTIE_H5_U8},
    [PTIE_RESULT_TRUSTED] = {STATISTICS "/trusted", "1 far enough from the frame's border, 0 not", PTIE_H5_U8},
    [PTIE_RESULT_PHASE_MEAN] = {STATISTICS "/phase_mean", "TIE phase averaged over time", PTIE_H5_F32},
    [PTIE_RESULT_PHASE_RMS] = {STATISTICS "/phase_rms", "Rms of the TIE phase about that", PTIE_H5_F32},
    [PTIE_RESULT_DENOISED_MEAN] = {STATISTICS "/denoised_mean", "Denoised phase averaged over time", PTIE_H5_F32},
    [PTIE_RESULT_DENOISED_RMS] = {STATISTICS "/denoised_rms", "Rms of the denoised phase about that", PTIE_H5_F32},
    [PTIE_RESULT_WARNINGS] = {PROCESS "/warnings", "What a reader of the result should know", PTIE_H5_LINE},
    [PTIE_RESULT_FINISHED] = {PROCESS "/finished", "Frames finished", PTIE_H5_U64},
};

static bool has_field(const ptie_result *r, int field) {
    return r->denoised || (field != PTIE_RESULT_DENOISED_MEAN && field != PTIE_RESULT_DENOISED_RMS);
}

static void column_path(char path[96], int which) {
    const ptie_row_name name = ptie_run_row_name(which);
    snprintf(path, 96, METRICS "/%s/%s", name.group, name.name);
}

/* --- structure ------------------------------------------------------------------------------------ */

/* What white noise of relative deviation 1 in each plane makes of the phase: its deviation over the frame, and the
   power spectral density at 1 rad/m, from where it falls with q^-4 (docs/math.md M8). */
static ptie_status write_noise(ptie_h5 *h5, const ptie_rig *rig, const ptie_nexus_axes *axes) {
    const ptie_solver_params params = ptie_rig_solver(rig, axes->width_px, axes->height_px);
    const double k_p = 2 * acos(-1) / params.wavelength_m * params.pixel_m;
    ptie_tie_weights weights;
    ptie_solver *solver;
    PTIE_TRY(ptie_tie_weigh(&weights, &params));
    PTIE_TRY(ptie_tie_plan(&solver, &params));
    const double noise_rad = ptie_tie_noise_rad(solver, 1);
    ptie_solver_free(solver);
    PTIE_TRY(ptie_h5_set_number(h5, PROCESS, "noise_rad_per_sigma", noise_rad));
    return ptie_h5_set_number(h5, PROCESS, "noise_density_per_sigma2", k_p * k_p * ptie_tie_noise_gain(&weights));
}

/* NeXus NXprocess: everything that decided the result. */
static ptie_status write_process(ptie_h5 *h5, const ptie_run_params *params, const ptie_nexus_axes *axes,
                                 const char *settings) {
    PTIE_TRY(ptie_nexus_process(h5, ptie_run_name(params), params->provenance));
    PTIE_TRY(ptie_h5_set_text(h5, PROCESS, SETTINGS, settings));
    PTIE_TRY(write_noise(h5, params->rig, axes));
    if (params->model) PTIE_TRY(ptie_h5_set_text(h5, PROCESS, "model", ptie_model_name(params->model)));
    char *rig = ptie_rig_print(params->rig);
    if (!rig) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", params->output);
    ptie_status status = ptie_h5_set_text(h5, PROCESS, "rig", rig);
    ptie_free(rig);
    return status;
}

static ptie_status make_field(ptie_h5 *h5, int field, const ptie_nexus_axes *axes) {
    const uint64_t image[2] = {(uint64_t)axes->height_px, (uint64_t)axes->width_px};
    const uint64_t lines = PTIE_RUN_MOST_WARNINGS, one = 1;
    const char *path = fields[field].path;
    if (field == PTIE_RESULT_WARNINGS)
        PTIE_TRY(ptie_h5_dataset(h5, path, fields[field].type, 1, &lines, 0));
    else if (field == PTIE_RESULT_FINISHED)
        PTIE_TRY(ptie_h5_dataset(h5, path, fields[field].type, 1, &one, 0));
    else
        PTIE_TRY(ptie_h5_dataset(h5, path, fields[field].type, 2, image, 0));
    if (fields[field].type == PTIE_H5_F32) PTIE_TRY(ptie_h5_set_text(h5, path, "units", "rad"));
    return ptie_h5_set_text(h5, path, "long_name", fields[field].long_name);
}

/* NaN until it is measured. */
static ptie_status make_column(ptie_h5 *h5, int which, uint64_t frames) {
    enum { BLOCK = 1024 };
    double none[BLOCK];
    char path[96];
    column_path(path, which);
    for (int i = 0; i < BLOCK; i++) none[i] = (double)NAN;
    PTIE_TRY(ptie_h5_dataset(h5, path, PTIE_H5_F64, 1, &frames, 0));
    for (uint64_t t = 0; t < frames; t += BLOCK)
        PTIE_TRY(ptie_h5_write(h5, path, PTIE_H5_F64, t, frames - t < BLOCK ? frames - t : BLOCK, none));
    return PTIE_OK;
}

static ptie_status make_structure(const ptie_result *r, ptie_h5 *h5, const ptie_run_params *params,
                                  const ptie_nexus_axes *axes, const char *settings) {
    static const ptie_nexus_signal phase = {"phase", "Phase by the transport-of-intensity equation", "rad",
                                            PTIE_H5_F32, false};
    static const ptie_nexus_signal denoised = {"denoised", "Denoised phase", "rad", PTIE_H5_F32, false};
    /* The best map comes first: it is what viewers show. */
    const ptie_nexus_signal signals[] = {r->denoised ? denoised : phase, phase};
    PTIE_TRY(ptie_nexus_begin(h5, axes, signals, r->denoised ? 2 : 1));
    PTIE_TRY(write_process(h5, params, axes, settings));
    for (int i = 0; i < PTIE_RESULT_FIELDS; i++)
        if (has_field(r, i)) PTIE_TRY(make_field(h5, i, axes));
    for (int i = 0; i < PTIE_ROW; i++)
        if (r->has[i]) PTIE_TRY(make_column(h5, i, axes->frames));
    return PTIE_OK;
}

static ptie_status find_places(ptie_result *r, ptie_h5 *h5) {
    char path[96];
    PTIE_TRY(ptie_h5_place(h5, PHASE, &r->phase_maps));
    if (r->denoised) PTIE_TRY(ptie_h5_place(h5, DENOISED, &r->denoised_maps));
    for (int i = 0; i < PTIE_RESULT_FIELDS; i++)
        if (has_field(r, i)) PTIE_TRY(ptie_h5_place(h5, fields[i].path, &r->field[i]));
    for (int i = 0; i < PTIE_ROW; i++) {
        if (!r->has[i]) continue;
        column_path(path, i);
        PTIE_TRY(ptie_h5_place(h5, path, &r->column[i]));
    }
    return PTIE_OK;
}

/* --- a new file, and an interrupted run's ----------------------------------------------------------- */

/* Finished frames in what an interrupted run left; 0 if there is none, or nothing of use in it. */
static int64_t finished_in(const char *part) {
    ptie_h5 *h5;
    uint64_t finished = 0;
    const char *path = fields[PTIE_RESULT_FINISHED].path;
    if (access(part, F_OK) != 0 || ptie_h5_open(&h5, part) != PTIE_OK) return 0;
    if (!ptie_h5_exists(h5, path) || ptie_h5_read(h5, path, PTIE_H5_U64, 0, 1, &finished) != PTIE_OK) finished = 0;
    ptie_h5_discard(h5);
    return (int64_t)finished;
}

/* The disk's blocks are taken now: a disk that is too small says so before the work.  Not every file system can. */
static ptie_status reserve(const ptie_output_file *file) {
    const off_t bytes = lseek(file->lock, 0, SEEK_END);
    if (bytes <= 0 || fallocate(file->lock, 0, 0, bytes) == 0 || (errno != ENOSPC && errno != EFBIG)) return PTIE_OK;
    return PTIE_FAIL(PTIE_EIO, "%s: cannot reserve %.3g GB: %s", file->path, 1e-9 * (double)bytes, strerror(errno));
}

static ptie_status create(ptie_result *r, const ptie_run_params *params, const ptie_nexus_axes *axes,
                          const char *settings) {
    ptie_h5 *h5;
    PTIE_TRY(ptie_h5_create(&h5, params->output, params->overwrite));
    ptie_status status = make_structure(r, h5, params, axes, settings);
    if (status == PTIE_OK) status = find_places(r, h5);
    if (status != PTIE_OK) {
        ptie_h5_discard(h5);
        return status;
    }
    PTIE_TRY(ptie_h5_detach(h5, &r->file));
    return reserve(&r->file);
}

/* The first line that differs. */
static ptie_status compare_settings(const char *part, const char *expected, const char *found) {
    while (*expected && *expected == *found) {
        const size_t a = strcspn(expected, "\n"), b = strcspn(found, "\n");
        if (a != b || memcmp(expected, found, a) != 0) break;
        expected += a + (expected[a] != 0);
        found += b + (found[b] != 0);
    }
    if (!*expected && !*found) return PTIE_OK;
    return PTIE_FAIL(PTIE_EINVAL, "%s: was begun with other settings (expected '%.*s', found '%.*s')", part,
                     (int)strcspn(expected, "\n"), expected, (int)strcspn(found, "\n"), found);
}

static ptie_status check_and_find(ptie_result *r, ptie_h5 *h5, const char *settings) {
    char *begun;
    PTIE_TRY(ptie_h5_get_text(h5, PROCESS, SETTINGS, &begun));
    const ptie_status status = compare_settings(r->file.part, settings, begun);
    ptie_free(begun);
    PTIE_TRY(status);
    PTIE_TRY(find_places(r, h5));
    uint64_t finished;
    PTIE_TRY(ptie_result_read(r, PTIE_RESULT_FINISHED, &finished));
    r->finished = (int64_t)finished;
    return PTIE_OK;
}

static ptie_status take_up(ptie_result *r, const ptie_run_params *params, const char *settings) {
    ptie_h5 *h5;
    PTIE_TRY(ptie_output_resume(&r->file, params->output, params->overwrite));
    r->finished = 1; /* until it is known, nothing of it may be removed */
    PTIE_TRY(ptie_h5_open(&h5, r->file.part));
    const ptie_status status = check_and_find(r, h5, settings);
    ptie_h5_discard(h5);
    return status;
}

static ptie_status open_either(ptie_result *r, const ptie_run_params *params, const ptie_nexus_axes *axes,
                               const char *settings) {
    char part[4096];
    snprintf(part, sizeof part, "%s.part", params->output);
    const int64_t finished = finished_in(part);
    if (finished > 0 && params->resume) return take_up(r, params, settings);
    if (finished > 0 && !params->overwrite)
        return PTIE_FAIL(PTIE_EEXIST, "%s: %lld frames of an interrupted run (use --resume to go on, -f to begin again)",
                         part, (long long)finished);
    return create(r, params, axes, settings);
}

ptie_status ptie_result_open(ptie_result **out, const ptie_run_params *params, const ptie_nexus_axes *axes,
                             const char *settings) {
    *out = NULL;
    ptie_result *r;
    PTIE_TRY(ptie_alloc_status(&r, 1, sizeof *r, params->output));
    r->denoised = params->model;
    for (int i = 0; i < PTIE_ROW; i++) r->has[i] = ptie_run_row_has(i, params->model, params->truth);
    const ptie_status status = open_either(r, params, axes, settings);
    if (status == PTIE_OK)
        *out = r;
    else
        ptie_result_abandon(r);
    return status;
}

ptie_status ptie_result_complete(ptie_result *r) {
    const ptie_status status = ptie_output_commit(&r->file);
    ptie_free(r);
    return status;
}

void ptie_result_abandon(ptie_result *r) {
    if (!r) return;
    if (r->finished > 0)
        ptie_output_keep(&r->file);
    else
        ptie_output_discard(&r->file);
    ptie_free(r);
}

/* --- rows ------------------------------------------------------------------------------------------- */

static ptie_place_file out(const ptie_result *r) {
    return (ptie_place_file){r->file.lock, r->file.path};
}

int64_t ptie_result_finished(const ptie_result *r) {
    return r->finished;
}

ptie_status ptie_result_finish(ptie_result *r, int64_t frames) {
    const uint64_t finished = (uint64_t)frames;
    PTIE_TRY(ptie_result_write(r, PTIE_RESULT_FINISHED, &finished));
    r->finished = frames;
    return PTIE_OK;
}

ptie_status ptie_result_write_maps(const ptie_result *r, int64_t frame, const float *phase, const float *denoised) {
    PTIE_TRY(ptie_place_write(out(r), &r->phase_maps, (uint64_t)frame, 1, phase));
    return r->denoised ? ptie_place_write(out(r), &r->denoised_maps, (uint64_t)frame, 1, denoised) : PTIE_OK;
}

ptie_status ptie_result_read_maps(const ptie_result *r, int64_t frame, float *phase, float *denoised) {
    PTIE_TRY(ptie_place_read(out(r), &r->phase_maps, (uint64_t)frame, 1, phase));
    return r->denoised ? ptie_place_read(out(r), &r->denoised_maps, (uint64_t)frame, 1, denoised) : PTIE_OK;
}

ptie_status ptie_result_write_row(const ptie_result *r, int64_t frame, const double *row) {
    for (int i = 0; i < PTIE_ROW; i++)
        if (r->has[i]) PTIE_TRY(ptie_place_write(out(r), &r->column[i], (uint64_t)frame, 1, &row[i]));
    return PTIE_OK;
}

ptie_status ptie_result_read_row(const ptie_result *r, int64_t frame, double *row) {
    for (int i = 0; i < PTIE_ROW; i++) {
        row[i] = (double)NAN;
        if (r->has[i]) PTIE_TRY(ptie_place_read(out(r), &r->column[i], (uint64_t)frame, 1, &row[i]));
    }
    return PTIE_OK;
}

ptie_status ptie_result_write(const ptie_result *r, ptie_result_field field, const void *data) {
    return ptie_place_write(out(r), &r->field[field], 0, r->field[field].rows, data);
}

ptie_status ptie_result_read(const ptie_result *r, ptie_result_field field, void *data) {
    return ptie_place_read(out(r), &r->field[field], 0, r->field[field].rows, data);
}
