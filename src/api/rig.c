/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/rig.h>: arguments checked, then inward. */
#include "api/rig.h"

#include <stdio.h>

#include "api/params.h"
#include "rig/check.h"
#include "rig/planes.h"
#include "rig/rig.h"

void ptie_rig_init(ptie_rig *rig) {
    ptie_rig_defaults(rig);
}

ptie_status ptie_rig_load(ptie_rig *rig, const char *path) {
    PTIE_TRY(ptie_check_pointer(rig, "ptie_rig_load", "rig"));
    PTIE_TRY(ptie_check_pointer(path, "ptie_rig_load", "path"));
    return ptie_rig_read(rig, path);
}

ptie_status ptie_rig_edit(const char *to, const char *from, const ptie_rig_setting *settings,
                          size_t count, bool overwrite) {
    static const char where[] = "ptie_rig_edit";
    PTIE_TRY(ptie_check_pointer(to, where, "to"));
    if (count > 0) PTIE_TRY(ptie_check_pointer(settings, where, "settings"));
    for (size_t i = 0; i < count; i++) {
        PTIE_TRY(ptie_check_pointer(settings[i].section, where, "section"));
        PTIE_TRY(ptie_check_pointer(settings[i].key, where, "key"));
        PTIE_TRY(ptie_check_pointer(settings[i].value, where, "value"));
    }
    return ptie_rig_change(to, from, settings, count, overwrite);
}

static ptie_status check_plane(const ptie_plane *plane, const char *where, const char *role) {
    char name[160];
    snprintf(name, sizeof name, "%s: plane '%s'", where, role);
    PTIE_TRY(ptie_check_number(plane->defocus_m, -1e3, 1e3, name, "defocus_m"));
    PTIE_TRY(ptie_check_number(plane->gain, 1e-6, 1e6, name, "gain"));
    PTIE_TRY(ptie_check_number(plane->shift_x_px, -32768, 32768, name, "shift_x_px"));
    PTIE_TRY(ptie_check_number(plane->shift_y_px, -32768, 32768, name, "shift_y_px"));
    PTIE_TRY(ptie_check_number(plane->magnification, 0.5, 2, name, "magnification"));
    for (int c = 0; c < PTIE_CHANNELS; c++)
        PTIE_TRY(ptie_check_number(plane->mix[c], -1e6, 1e6, name, "mix"));
    return ptie_check_number(plane->rotation_rad, -3.15, 3.15, name, "rotation_rad");
}

/* What decides over memory and indices. */
static ptie_status check_numbers(const ptie_rig *rig, const char *where) {
    PTIE_TRY(ptie_check_positive(rig->wavelength_m, where, "wavelength_m"));
    PTIE_TRY(ptie_check_positive(rig->pixel_m, where, "pixel_m"));
    PTIE_TRY(ptie_check_number(rig->mask_below, 0, 1, where, "mask_below"));
    if (rig->cutoff_m != PTIE_CUTOFF_AUTO && rig->cutoff_m != PTIE_CUTOFF_CORNER)
        PTIE_TRY(ptie_check_number(rig->cutoff_m, 0, 1e6, where, "cutoff_m"));
    PTIE_TRY(ptie_check_integer(rig->max_iterations, 1, 100000, where, "max_iterations"));
    PTIE_TRY(ptie_check_integer(rig->still_first, 0, rig->still_end, where, "still_first"));
    PTIE_TRY(ptie_check_integer(rig->binning, 1, 64, where, "binning"));
    PTIE_TRY(ptie_check_integer(rig->roi_x, 0, 32767, where, "roi_x"));
    PTIE_TRY(ptie_check_integer(rig->roi_y, 0, 32767, where, "roi_y"));
    return ptie_check_integer(rig->polarity, -1, 1, where, "polarity");
}

static ptie_status check_choices(const ptie_rig *rig, const char *where) {
    PTIE_TRY(ptie_check_integer((int64_t)rig->layout, 0, PTIE_LAYOUT_QUADRANTS, where, "layout"));
    PTIE_TRY(
        ptie_check_integer((int64_t)rig->demosaic, 0, PTIE_DEMOSAIC_FOURIER, where, "demosaic"));
    PTIE_TRY(ptie_check_integer((int64_t)rig->background, 0, PTIE_BACKGROUND_ZERNIKE, where,
                                "background"));
    PTIE_TRY(ptie_check_integer((int64_t)rig->method, PTIE_SOLVE_DIRECT, PTIE_SOLVE_US_TIE, where,
                                "method"));
    return ptie_check_integer((int64_t)rig->boundary, PTIE_PERIODIC, PTIE_MIRROR, where,
                              "boundary");
}

ptie_status ptie_rig_take(ptie_rig *rig, const ptie_rig *given, const char *where) {
    ptie_rig_defaults(rig);
    PTIE_TRY(ptie_params_read(rig, sizeof *rig, given, where));
    PTIE_TRY(check_numbers(rig, where));
    PTIE_TRY(check_choices(rig, where));
    for (int i = 0; i < PTIE_ROLES; i++)
        if (rig->plane[i].used) PTIE_TRY(check_plane(&rig->plane[i], where, ptie_role_names[i]));
    return ptie_rig_check_planes(rig, where);
}

ptie_status ptie_rig_replace(char path[512], const char *file, const char *where) {
    if (!file || snprintf(path, 512, "%s", file) < 512) return PTIE_OK;
    return PTIE_FAIL(PTIE_EINVAL, "%s: path longer than 511 bytes: %s", where, file);
}

static ptie_status check_files(const char *recording, const char *const plane[PTIE_ROLES],
                               const char *where) {
    if (recording || (plane && plane[PTIE_PLUS])) return PTIE_OK;
    return ptie_check_pointer(NULL, where, "recording");
}

ptie_status ptie_rig_check(const ptie_rig *rig, const char *recording,
                           const char *const plane[PTIE_ROLES], const char *target,
                           ptie_rig_report *report) {
    static const char where[] = "ptie_rig_check";
    ptie_rig own;
    PTIE_TRY(ptie_check_pointer(report, where, "report"));
    PTIE_TRY(check_files(recording, plane, where));
    PTIE_TRY(ptie_rig_take(&own, rig, where));
    return ptie_rig_compare(&own, recording, plane, target, report);
}

ptie_status ptie_rig_calibrate(ptie_plane_calibration calibration[PTIE_ROLES], const ptie_rig *rig,
                               const char *recording, const char *const plane[PTIE_ROLES]) {
    static const char where[] = "ptie_rig_calibrate";
    ptie_rig own;
    PTIE_TRY(ptie_check_pointer(calibration, where, "calibration"));
    PTIE_TRY(check_files(recording, plane, where));
    PTIE_TRY(ptie_rig_take(&own, rig, where));
    return ptie_rig_measure(calibration, &own, recording, plane);
}
