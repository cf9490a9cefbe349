/* SPDX-License-Identifier: BSD-3-Clause */
#include "rig/rig.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "rig/channels.h"
#include "rig/planes.h"
#include "rig/keys.h"

#define MAX_RIG_BYTES (1 << 20)

/* A path in a rig is relative to the rig's own folder. */
static ptie_status resolve(char path[512], const char *name, const char *rig_path) {
    const char *slash = strrchr(rig_path, '/');
    if (!path[0] || path[0] == '/' || !slash) return PTIE_OK;
    const size_t folder = (size_t)(slash - rig_path) + 1, length = strlen(path) + 1;
    if (folder + length > 512)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: %s: path longer than 511 bytes", rig_path, name);
    memmove(path + folder, path, length);
    memcpy(path, rig_path, folder);
    return PTIE_OK;
}

static double or_else(double value, double otherwise) {
    return isnan(value) ? otherwise : value;
}

/* Where a plane is on the sensor or in the file. */
static ptie_status set_origin(ptie_plane *plane, const ptie_rig_file *file, int role,
                              const char *path) {
    const char *name = ptie_role_names[role], *text = file->planes[role];
    char expected[128];
    if (file->rig.layout == PTIE_LAYOUT_SEPARATE) {
        memcpy(plane->source, text, sizeof plane->source);
        if (!text[0] || text[0] == '/') return PTIE_OK;
        return PTIE_FAIL(PTIE_EFORMAT,
                         "%s: [planes] %s: expected a data set such as /entry/data/%s, found '%s'",
                         path, name, name, text);
    }
    if (!text[0])
        return PTIE_FAIL(PTIE_EINVAL, "%s: missing key '%s' in [planes] (expected its channel)",
                         path, name);
    const char *wrong = ptie_mix_parse(plane->mix, &file->rig, text, expected);
    if (!wrong) return PTIE_OK;
    return PTIE_FAIL(PTIE_EFORMAT, "%s: [planes] %s: expected %s, found '%.80s'", path, name, wrong,
                     text);
}

static ptie_status set_plane(ptie_plane *plane, const ptie_rig_file *file, int role,
                             const char *path) {
    const ptie_plane_keys *keys = &file->plane[role];
    const double z_m =
        or_else(keys->defocus_m, role == PTIE_ZERO ? 0 : ptie_plane_steps[role] * file->defocus_m);
    if (isnan(z_m))
        return PTIE_FAIL(PTIE_EINVAL,
                         "%s: missing key 'defocus' in [optics] (expected a length such as 10 mm), "
                         "or in [%s]",
                         path, ptie_role_names[role]);
    *plane = (ptie_plane){.used = true,
                          .defocus_m = z_m,
                          .gain = or_else(keys->gain, 1),
                          .shift_x_px = or_else(keys->shift_x_px, 0),
                          .shift_y_px = or_else(keys->shift_y_px, 0),
                          .magnification = or_else(keys->magnification, 1),
                          .rotation_rad = or_else(keys->rotation_rad, 0)};
    return set_origin(plane, file, role, path);
}

/* A plane that the set does not have is a mistake in either. */
static ptie_status check_unused(const ptie_rig_file *file, int role, const char *path) {
    if (!file->planes[role][0]) return PTIE_OK;
    return PTIE_FAIL(PTIE_EINVAL, "%s: [planes] %s has no place in set '%s'", path,
                     ptie_role_names[role], ptie_set_names[file->set]);
}

static ptie_status convert(ptie_rig_file *file, const char *path) {
    ptie_rig *rig = &file->rig;
    rig->pixel_m = file->pitch_m / file->magnification;
    rig->polarity = file->polarity - 1;
    rig->one_plane = file->set == PTIE_SET_REFERENCE;
    if (rig->layout == PTIE_LAYOUT_MOSAIC && rig->angle_deg[0] == rig->angle_deg[1])
        return PTIE_FAIL(
            PTIE_EINVAL,
            "%s: missing key 'mosaic' in [planes] (expected sony, crysta or four angles)", path);
    for (int i = 0; i < PTIE_ROLES; i++) {
        rig->plane[i].used = ptie_set_has((ptie_plane_set)file->set, i);
        PTIE_TRY(rig->plane[i].used ? set_plane(&rig->plane[i], file, i, path)
                                    : check_unused(file, i, path));
    }
    PTIE_TRY(ptie_rig_check_planes(rig, path));
    PTIE_TRY(resolve(rig->reference, "reference", path));
    PTIE_TRY(resolve(rig->dark, "dark", path));
    return resolve(rig->mask, "mask", path);
}

ptie_status ptie_rig_parse(ptie_rig *rig, const char *text, const char *path) {
    ptie_rig_file file;
    ptie_rig_file_defaults(&file);
    file.pitch_m = file.defocus_m = (double)NAN;
    PTIE_TRY(ptie_ini_read(&file, ptie_rig_keys, ptie_rig_key_count, text, path));
    PTIE_TRY(convert(&file, path));
    *rig = file.rig;
    return PTIE_OK;
}

ptie_status ptie_rig_read_text(char **text, const char *path) {
    size_t bytes;
    return ptie_read_file(text, &bytes, path, MAX_RIG_BYTES);
}

ptie_status ptie_rig_read(ptie_rig *rig, const char *path) {
    char *text;
    PTIE_TRY(ptie_rig_read_text(&text, path));
    ptie_status status = ptie_rig_parse(rig, text, path);
    ptie_free(text);
    return status;
}

static double unless(double value, double otherwise) {
    return value == otherwise ? (double)NAN : value;
}

/* The file's form of a plane: what is not as by default. */
static ptie_plane_keys keys_of(const ptie_plane *plane, double expected_m) {
    return (ptie_plane_keys){.defocus_m = unless(plane->defocus_m, expected_m),
                             .gain = unless(plane->gain, 1),
                             .shift_x_px = unless(plane->shift_x_px, 0),
                             .shift_y_px = unless(plane->shift_y_px, 0),
                             .magnification = unless(plane->magnification, 1),
                             .rotation_rad = unless(plane->rotation_rad, 0)};
}

static void print_origin(ptie_text *text, const ptie_rig *rig, const ptie_plane *plane) {
    if (rig->layout == PTIE_LAYOUT_SEPARATE)
        ptie_text_append(text, "%s", plane->source);
    else
        ptie_mix_print(text, rig, plane->mix);
}

char *ptie_rig_print(const ptie_rig *rig) {
    const double defocus_m = rig->plane[PTIE_PLUS].defocus_m;
    ptie_rig_file file;
    ptie_rig_file_defaults(&file);
    file.rig = *rig;
    file.pitch_m = rig->pixel_m;
    file.defocus_m = defocus_m;
    file.set = (int)ptie_rig_set(rig);
    file.polarity = rig->polarity + 1;
    ptie_text text = {0};
    for (int i = 0; i < PTIE_ROLES; i++) {
        if (!rig->plane[i].used) continue;
        ptie_text origin = {0};
        print_origin(&origin, rig, &rig->plane[i]);
        snprintf(file.planes[i], sizeof file.planes[i], "%s", origin.data ? origin.data : "");
        text.failed |= origin.failed;
        ptie_text_free(&origin);
        file.plane[i] = keys_of(&rig->plane[i], ptie_plane_steps[i] * defocus_m);
    }
    ptie_ini_print(&text, &file, ptie_rig_keys, ptie_rig_key_count);
    if (!text.failed) return text.data;
    ptie_text_free(&text);
    return NULL;
}
