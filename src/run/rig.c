/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/rig.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "optics/mosaic.h"
#include "run/channels.h"
#include "run/planes.h"

#define MAX_RIG_BYTES (1 << 20)
#define MOST_DEFOCUS_M 1e3

/* What a plane's section says; NaN where it says nothing. */
typedef struct plane_keys {
    double defocus_m, gain, shift_x_px, shift_y_px, magnification, rotation_rad;
} plane_keys;

/* A rig as a person writes it: pitch of the sensor and magnification instead of the pixel at the object, one defocus
   for all planes unless they differ, planes as sums of channels. */
typedef struct rig_file {
    ptie_rig rig;
    double pitch_m, magnification, defocus_m;
    int set, polarity;
    char planes[PTIE_ROLES][512];
    plane_keys plane[PTIE_ROLES];
} rig_file;

static const char *const set_names[] = {"pair", "triple", "five", "reference", NULL};
static const char *const layout_names[] = {"separate", "mosaic", "side-by-side", "top-bottom", "quadrants", NULL};
static const char *const demosaic_names[] = {"none", "bilinear", "fourier", NULL};
static const char *const background_names[] = {"none", "plane", "zernike", NULL};
static const char *const polarity_names[] = {"negative", "auto", "positive", NULL}; /* index - 1 */
static const char *const boundary_names[] = {"periodic", "mirror", NULL};

/* Planes in units of 'defocus'. */
static const double steps[PTIE_ROLES] = {1, -1, 0, 2, -2};

/* int64_t[2]: "0:100", end excluded. */
static const char *parse_frames(void *field, const char *text) {
    long long first, end;
    int used = 0;
    if (sscanf(text, "%18lld :%18lld%n", &first, &end, &used) != 2 || text[used] || first < 0 || end <= first)
        return "frames such as 0:100, the end excluded";
    memcpy(field, (int64_t[2]){first, end}, sizeof(int64_t[2]));
    return NULL;
}

static void print_frames(ptie_text *out, const void *field) {
    const int64_t *frames = field;
    if (frames[1] > frames[0]) ptie_text_append(out, "%lld:%lld", (long long)frames[0], (long long)frames[1]);
}

static const char *parse_rect(void *field, const char *text) {
    ptie_rect r;
    int used = 0;
    if (sscanf(text, "%9d ,%9d ,%9d ,%9d%n", &r.x_px, &r.y_px, &r.width_px, &r.height_px, &used) != 4 ||
        text[used] || r.x_px < 0 || r.y_px < 0 || r.width_px < 1 || r.height_px < 1)
        return "a rectangle x,y,width,height in pixels";
    memcpy(field, &r, sizeof r);
    return NULL;
}

static void print_rect(ptie_text *out, const void *field) {
    const ptie_rect *r = field;
    if (r->width_px > 0) ptie_text_append(out, "%d,%d,%d,%d", r->x_px, r->y_px, r->width_px, r->height_px);
}

static const ptie_ini_type frames_type = {parse_frames, print_frames};
static const ptie_ini_type rect_type = {parse_rect, print_rect};

/* clang-format off */
#define FIELD(name) offsetof(rig_file, name)
#define QUANTITY_KEY(section_, key_, field_, quantity_, low_, high_)                               \
    {.section = section_, .name = key_, .kind = PTIE_INI_QUANTITY, .quantity = quantity_,          \
     .offset = FIELD(field_), .low = low_, .high = high_}
#define INTEGER_KEY(section_, key_, field_, low_, high_)                                           \
    {.section = section_, .name = key_, .kind = PTIE_INI_INTEGER, .offset = FIELD(field_),         \
     .low = low_, .high = high_}
#define BOOLEAN_KEY(section_, key_, field_)                                                        \
    {.section = section_, .name = key_, .kind = PTIE_INI_BOOLEAN, .offset = FIELD(field_)}
#define TEXT_KEY(section_, key_, field_)                                                           \
    {.section = section_, .name = key_, .kind = PTIE_INI_TEXT, .offset = FIELD(field_),            \
     .text_bytes = sizeof((rig_file *)0)->field_}
#define CHOICE_KEY(section_, key_, field_, choices_)                                               \
    {.section = section_, .name = key_, .kind = PTIE_INI_CHOICE, .offset = FIELD(field_),          \
     .choices = choices_}
#define OWN_KEY(section_, key_, field_, type_)                                                     \
    {.section = section_, .name = key_, .kind = PTIE_INI_OWN, .offset = FIELD(field_),             \
     .type = &type_}
#define PLANE_KEYS(section_, role_)                                                                \
    QUANTITY_KEY(section_, "defocus", plane[role_].defocus_m, PTIE_LENGTH, -MOST_DEFOCUS_M, MOST_DEFOCUS_M), \
    QUANTITY_KEY(section_, "gain", plane[role_].gain, PTIE_NUMBER, 1e-6, 1e6),                     \
    QUANTITY_KEY(section_, "shift_x", plane[role_].shift_x_px, PTIE_NUMBER, -32768, 32768),        \
    QUANTITY_KEY(section_, "shift_y", plane[role_].shift_y_px, PTIE_NUMBER, -32768, 32768),        \
    QUANTITY_KEY(section_, "magnification", plane[role_].magnification, PTIE_NUMBER, 0.1, 10),     \
    QUANTITY_KEY(section_, "rotation", plane[role_].rotation_rad, PTIE_ANGLE, -3.15, 3.15)

static const ptie_ini_key rig_keys[] = {
    {.section = "optics", .name = "wavelength", .kind = PTIE_INI_QUANTITY, .quantity = PTIE_LENGTH,
     .offset = FIELD(rig.wavelength_m), .low = 1e-12, .high = 1e-3, .required = true},
    {.section = "optics", .name = "pixel", .kind = PTIE_INI_QUANTITY, .quantity = PTIE_LENGTH,
     .offset = FIELD(pitch_m), .low = 1e-10, .high = 1, .required = true},
    QUANTITY_KEY("optics", "magnification", magnification, PTIE_NUMBER, 1e-6, 1e6),
    QUANTITY_KEY("optics", "defocus", defocus_m, PTIE_LENGTH, -MOST_DEFOCUS_M, MOST_DEFOCUS_M),
    CHOICE_KEY("planes", "set", set, set_names),
    CHOICE_KEY("planes", "layout", rig.layout, layout_names),
    OWN_KEY("planes", "mosaic", rig.angle_deg, ptie_mosaic_type),
    INTEGER_KEY("planes", "roi_x", rig.roi_x, 0, 32767),
    INTEGER_KEY("planes", "roi_y", rig.roi_y, 0, 32767),
    TEXT_KEY("planes", "plus", planes[PTIE_PLUS]),
    TEXT_KEY("planes", "minus", planes[PTIE_MINUS]),
    TEXT_KEY("planes", "zero", planes[PTIE_ZERO]),
    TEXT_KEY("planes", "plus2", planes[PTIE_PLUS2]),
    TEXT_KEY("planes", "minus2", planes[PTIE_MINUS2]),
    PLANE_KEYS("plus", PTIE_PLUS),
    PLANE_KEYS("minus", PTIE_MINUS),
    PLANE_KEYS("zero", PTIE_ZERO),
    PLANE_KEYS("plus2", PTIE_PLUS2),
    PLANE_KEYS("minus2", PTIE_MINUS2),
    QUANTITY_KEY("recording", "frame_rate", rig.frame_rate_hz, PTIE_RATE, 0, 1e12),
    TEXT_KEY("recording", "reference", rig.reference),
    TEXT_KEY("recording", "dark", rig.dark),
    TEXT_KEY("recording", "mask", rig.mask),
    OWN_KEY("recording", "still_frames", rig.still_first, frames_type),
    QUANTITY_KEY("camera", "saturation", rig.saturation_counts, PTIE_NUMBER, 0, 1e9),
    QUANTITY_KEY("camera", "electrons_per_count", rig.electrons_per_count, PTIE_NUMBER, 0, 1e9),
    QUANTITY_KEY("camera", "read_noise", rig.read_noise_electrons, PTIE_NUMBER, 0, 1e9),
    CHOICE_KEY("preprocess", "demosaic", rig.demosaic, demosaic_names),
    BOOLEAN_KEY("preprocess", "flat_field", rig.flat_field),
    BOOLEAN_KEY("preprocess", "match_gain", rig.match_gain),
    QUANTITY_KEY("preprocess", "mask_below", rig.mask_below, PTIE_NUMBER, 0, 1),
    CHOICE_KEY("preprocess", "background", rig.background, background_names),
    INTEGER_KEY("solver", "binning", rig.binning, 1, 64),
    CHOICE_KEY("solver", "boundary", rig.boundary, boundary_names),
    QUANTITY_KEY("solver", "cutoff", rig.cutoff_m, PTIE_LENGTH, 0, 1e3),
    BOOLEAN_KEY("solver", "zero_border", rig.zero_border),
    CHOICE_KEY("flow", "polarity", polarity, polarity_names),
    OWN_KEY("flow", "still", rig.still, rect_type),
};
/* clang-format on */
enum { RIG_KEYS = sizeof rig_keys / sizeof *rig_keys };

void ptie_rig_defaults(ptie_rig *rig) {
    *rig = (ptie_rig){.struct_size = sizeof *rig, .wavelength_m = 532e-9, .demosaic = PTIE_DEMOSAIC_BILINEAR,
                      .flat_field = true, .match_gain = true, .boundary = PTIE_MIRROR, .binning = 1,
                      .zero_border = true};
    for (int i = 0; i < PTIE_ROLES; i++)
        rig->plane[i] = (ptie_plane){.defocus_m = 10e-3 * steps[i], .gain = 1, .magnification = 1};
    rig->plane[PTIE_PLUS].used = rig->plane[PTIE_MINUS].used = true;
}

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
static ptie_status set_origin(ptie_plane *plane, const rig_file *file, int role, const char *path) {
    const char *name = ptie_role_names[role], *text = file->planes[role];
    char expected[128];
    if (file->rig.layout == PTIE_LAYOUT_SEPARATE) {
        memcpy(plane->source, text, sizeof plane->source);
        if (!text[0] || text[0] == '/') return PTIE_OK;
        return PTIE_FAIL(PTIE_EFORMAT, "%s: [planes] %s: expected a data set such as /entry/data/%s, found '%s'",
                         path, name, name, text);
    }
    if (!text[0])
        return PTIE_FAIL(PTIE_EINVAL, "%s: missing key '%s' in [planes] (expected its channel)", path, name);
    const char *wrong = ptie_mix_parse(plane->mix, &file->rig, text, expected);
    if (!wrong) return PTIE_OK;
    return PTIE_FAIL(PTIE_EFORMAT, "%s: [planes] %s: expected %s, found '%.80s'", path, name, wrong, text);
}

static ptie_status set_plane(ptie_plane *plane, const rig_file *file, int role, const char *path) {
    const plane_keys *keys = &file->plane[role];
    const double z_m = or_else(keys->defocus_m, role == PTIE_ZERO ? 0 : steps[role] * file->defocus_m);
    if (isnan(z_m))
        return PTIE_FAIL(PTIE_EINVAL, "%s: missing key 'defocus' in [optics] (expected a length such as 10 mm), "
                                      "or in [%s]", path, ptie_role_names[role]);
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
static ptie_status check_unused(const rig_file *file, int role, const char *path) {
    if (!file->planes[role][0]) return PTIE_OK;
    return PTIE_FAIL(PTIE_EINVAL, "%s: [planes] %s has no place in set '%s'", path, ptie_role_names[role],
                     set_names[file->set]);
}

static ptie_status convert(rig_file *file, const char *path) {
    ptie_rig *rig = &file->rig;
    rig->pixel_m = file->pitch_m / file->magnification;
    rig->polarity = file->polarity - 1;
    rig->one_plane = file->set == PTIE_SET_REFERENCE;
    if (rig->layout == PTIE_LAYOUT_MOSAIC && rig->angle_deg[0] == rig->angle_deg[1])
        return PTIE_FAIL(PTIE_EINVAL, "%s: missing key 'mosaic' in [planes] (expected sony, crysta or four angles)",
                         path);
    for (int i = 0; i < PTIE_ROLES; i++) {
        rig->plane[i].used = ptie_set_has((ptie_plane_set)file->set, i);
        PTIE_TRY(rig->plane[i].used ? set_plane(&rig->plane[i], file, i, path) : check_unused(file, i, path));
    }
    PTIE_TRY(ptie_rig_check_planes(rig, path));
    PTIE_TRY(resolve(rig->reference, "reference", path));
    PTIE_TRY(resolve(rig->dark, "dark", path));
    return resolve(rig->mask, "mask", path);
}

static const plane_keys nothing_said = {(double)NAN, (double)NAN, (double)NAN, (double)NAN, (double)NAN, (double)NAN};

ptie_status ptie_rig_read(ptie_rig *rig, const char *path) {
    char *text;
    size_t bytes;
    PTIE_TRY(ptie_read_file(&text, &bytes, path, MAX_RIG_BYTES));
    rig_file file = {.magnification = 1, .defocus_m = (double)NAN, .polarity = 1};
    ptie_rig_defaults(&file.rig);
    for (int i = 0; i < PTIE_ROLES; i++) file.plane[i] = nothing_said;
    ptie_status status = ptie_ini_read(&file, rig_keys, RIG_KEYS, text, path);
    if (status == PTIE_OK) status = convert(&file, path);
    if (status == PTIE_OK) *rig = file.rig;
    ptie_free(text);
    return status;
}

static double unless(double value, double otherwise) {
    return value == otherwise ? (double)NAN : value;
}

/* The file's form of a plane: what is not as by default. */
static plane_keys keys_of(const ptie_plane *plane, double expected_m) {
    return (plane_keys){.defocus_m = unless(plane->defocus_m, expected_m),
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
    rig_file file = {.rig = *rig, .pitch_m = rig->pixel_m, .magnification = 1, .defocus_m = defocus_m,
                     .set = (int)ptie_rig_set(rig), .polarity = rig->polarity + 1};
    ptie_text text = {0};
    for (int i = 0; i < PTIE_ROLES; i++) {
        file.plane[i] = nothing_said;
        if (!rig->plane[i].used) continue;
        ptie_text origin = {0};
        print_origin(&origin, rig, &rig->plane[i]);
        snprintf(file.planes[i], sizeof file.planes[i], "%s", origin.data ? origin.data : "");
        text.failed |= origin.failed;
        ptie_text_free(&origin);
        file.plane[i] = keys_of(&rig->plane[i], steps[i] * defocus_m);
    }
    ptie_ini_print(&text, &file, rig_keys, RIG_KEYS);
    if (!text.failed) return text.data;
    ptie_text_free(&text);
    return NULL;
}
