/* SPDX-License-Identifier: BSD-3-Clause */
#include "simulate/rig.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "io/nexus.h"
#include "optics/camera.h"
#include "rig/rig.h"

/* "lab.mraw", "_dark" -> "lab_dark.mraw"; another ending if one is given. */
static ptie_status name_beside(char out[PTIE_SIMULATED_PATH], const char *path, const char *suffix,
                               const char *ending) {
    const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
    if (!dot || (slash && dot < slash)) dot = path + strlen(path);
    const int length = snprintf(out, PTIE_SIMULATED_PATH, "%.*s%s%s", (int)(dot - path), path, suffix,
                                ending ? ending : dot);
    if (length < PTIE_SIMULATED_PATH) return PTIE_OK;
    return PTIE_FAIL(PTIE_EINVAL, "%.80s...: name of the output too long", path);
}

ptie_status ptie_simulate_name_files(ptie_simulated_files *files, const ptie_simulate_params *params) {
    *files = (ptie_simulated_files){0};
    if (!params->camera) return PTIE_OK;
    PTIE_TRY(name_beside(files->truth, params->output, "_truth", ".h5"));
    if (params->reference_frames) PTIE_TRY(name_beside(files->reference, params->output, "_reference", NULL));
    if (params->dark_frames) PTIE_TRY(name_beside(files->dark, params->output, "_dark", NULL));
    if (params->target_frames) PTIE_TRY(name_beside(files->target, params->output, "_target", NULL));
    return params->rig ? name_beside(files->true_rig, params->rig, "_true", NULL) : PTIE_OK;
}

static const char *file_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* Where a recording is, seen from the rig beside it. */
static void set_path(char field[512], const char *path) {
    snprintf(field, 512, "%.255s", file_name(path)); /* as long as names of files get */
}

/* Channel that sees most of a polarisation. */
static int channel_of(const ptie_camera_params *camera, double polarisation_rad) {
    int best = 0;
    for (int c = 1; c < PTIE_CHANNELS; c++)
        if (ptie_camera_passed(camera, c, polarisation_rad) > ptie_camera_passed(camera, best, polarisation_rad))
            best = c;
    return best;
}

/* The rig of a camera, as its builder knows it before any calibration. */
static void known_rig(ptie_rig *rig, const ptie_simulate_params *p, const ptie_simulated_files *files) {
    const ptie_camera_params *camera = p->camera;
    ptie_rig_defaults(rig);
    rig->wavelength_m = p->flow.wavelength_m;
    rig->pixel_m = p->flow.pixel_m;
    rig->plane[PTIE_PLUS].defocus_m = p->defocus_m;
    rig->plane[PTIE_MINUS].defocus_m = -p->defocus_m;
    rig->boundary = p->boundary;
    rig->frame_rate_hz = p->frame_rate_hz;
    rig->polarity = p->flow.family == PTIE_PARAMETRIC;
    rig->saturation_counts = ldexp(1, camera->bits) - 1;
    rig->electrons_per_count = camera->full_well / (rig->saturation_counts - camera->black);
    rig->read_noise_electrons = camera->read_noise;
    rig->mask_below = camera->nozzle_length_m > 0 && camera->nozzle_width_m > 0 ? 0.2 : 0;
    set_path(rig->reference, files->reference);
    set_path(rig->dark, files->dark);
    if (camera->layout == PTIE_CAMERA_SEPARATE) {
        snprintf(rig->plane[PTIE_PLUS].source, sizeof rig->plane->source, PTIE_NEXUS_DATA "/plus");
        snprintf(rig->plane[PTIE_MINUS].source, sizeof rig->plane->source, PTIE_NEXUS_DATA "/minus");
        return;
    }
    rig->layout = PTIE_LAYOUT_MOSAIC;
    memcpy(rig->angle_deg, camera->angle_deg, sizeof rig->angle_deg);
    rig->roi_x = camera->roi_x_px;
    rig->roi_y = camera->roi_y_px;
    rig->plane[PTIE_PLUS].mix[channel_of(camera, camera->plus_rad)] = 1;
    rig->plane[PTIE_MINUS].mix[channel_of(camera, camera->minus_rad)] = 1;
}

/* Takes out of two channels what each lets through of the other's plane, and their gains (C8). */
static void unmix(ptie_rig *rig, const ptie_camera_params *camera) {
    const int a = channel_of(camera, camera->plus_rad), b = channel_of(camera, camera->minus_rad);
    const double aa = camera->gain[a] * ptie_camera_passed(camera, a, camera->plus_rad),
                 ab = camera->gain[a] * ptie_camera_passed(camera, a, camera->minus_rad),
                 ba = camera->gain[b] * ptie_camera_passed(camera, b, camera->plus_rad),
                 bb = camera->gain[b] * ptie_camera_passed(camera, b, camera->minus_rad);
    const double determinant = aa * bb - ab * ba;
    if (a == b || determinant == 0) return;
    double *plus = rig->plane[PTIE_PLUS].mix, *minus = rig->plane[PTIE_MINUS].mix;
    plus[a] = bb / determinant, plus[b] = -ab / determinant;
    minus[a] = -ba / determinant, minus[b] = aa / determinant;
}

/* What a perfect calibration finds. */
static void calibrated_rig(ptie_rig *rig, const ptie_simulate_params *p, const ptie_simulated_files *files) {
    const ptie_camera_params *camera = p->camera;
    const double pitch = camera->layout == PTIE_CAMERA_MOSAIC ? 2 : 1; /* of a plane's pixel, in the sensor's */
    ptie_plane *minus = &rig->plane[PTIE_MINUS];
    known_rig(rig, p, files);
    if (camera->layout == PTIE_CAMERA_MOSAIC) unmix(rig, camera);
    minus->gain = 1 / camera->minus_gain;
    minus->shift_x_px = camera->minus_shift_x_px / pitch;
    minus->shift_y_px = camera->minus_shift_y_px / pitch;
    minus->magnification = camera->minus_magnification;
    minus->rotation_rad = camera->minus_rotation_rad;
}

static ptie_status write_rig(const char *path, const char *comment, const ptie_rig *rig, bool overwrite) {
    char *keys = ptie_rig_print(rig);
    ptie_text text = {0};
    ptie_text_append(&text, "; %s\n%s", comment, keys ? keys : "");
    ptie_status status = !keys || text.failed ? PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", path)
                                              : ptie_write_file(path, text.data, text.length, overwrite);
    ptie_text_free(&text);
    ptie_free(keys);
    return status;
}

/* Without a camera: as a person would write it. */
static void print_rig(ptie_text *text, const ptie_simulate_params *p) {
    char wavelength[PTIE_QUANTITY_BYTES], pixel[PTIE_QUANTITY_BYTES], defocus[PTIE_QUANTITY_BYTES],
        rate[PTIE_QUANTITY_BYTES];
    ptie_text_append(text, "; The rig of a simulated recording.\n");
    ptie_text_append(text, "[optics]\nwavelength = %s\npixel = %s\ndefocus = %s\n\n",
                     ptie_print_quantity(wavelength, p->flow.wavelength_m, PTIE_LENGTH),
                     ptie_print_quantity(pixel, p->flow.pixel_m, PTIE_LENGTH),
                     ptie_print_quantity(defocus, p->defocus_m, PTIE_LENGTH));
    ptie_text_append(text, "[planes]\nset = pair\nplus = " PTIE_NEXUS_DATA "/plus\nminus = " PTIE_NEXUS_DATA "/minus\n\n");
    ptie_text_append(text, "[recording]\nframe_rate = %s\n\n",
                     ptie_print_quantity(rate, p->frame_rate_hz, PTIE_RATE));
    ptie_text_append(text, "[flow]\npolarity = %s\n\n",
                     p->flow.family == PTIE_PARAMETRIC ? "positive" : "auto");
    ptie_text_append(text, "[solver]\nboundary = %s\n",
                     p->boundary == PTIE_PERIODIC ? "periodic" : "mirror");
}

static ptie_status write_plain_rig(const ptie_simulate_params *p) {
    ptie_text text = {0};
    print_rig(&text, p);
    ptie_status status = text.failed
                             ? PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", p->rig)
                             : ptie_write_file(p->rig, text.data, text.length, p->overwrite);
    ptie_text_free(&text);
    return status;
}

ptie_status ptie_simulate_write_rigs(const ptie_simulate_params *params, const ptie_simulated_files *files) {
    ptie_rig rig;
    if (!params->camera) return write_plain_rig(params);
    known_rig(&rig, params, files);
    PTIE_TRY(write_rig(params->rig, "The rig of a simulated recording, before any calibration.", &rig,
                       params->overwrite));
    calibrated_rig(&rig, params, files);
    return write_rig(files->true_rig, "The rig of a simulated recording, as a perfect calibration would find it.", &rig,
                     params->overwrite);
}
