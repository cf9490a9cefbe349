/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/rig.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/ini.h"
#include "base/memory.h"

#define MAX_RIG_BYTES (1 << 20)

/* A rig as a person writes it: pitch of the sensor and magnification instead of the pixel at the object,
   one defocus for both planes unless they differ. */
typedef struct rig_file {
    double wavelength_m, pixel_m, magnification, defocus_m, defocus_plus_m, defocus_minus_m;
    double frame_rate_hz, cutoff_m;
    int planes, polarity, boundary;
    int32_t binning;
    bool zero_border;
    char plus[512], zero[512], minus[512], reference[512];
} rig_file;

static const char *const plane_names[] = {"pair", "triple", "reference", NULL};
static const char *const polarity_names[] = {"negative", "auto", "positive", NULL}; /* index - 1 */
static const char *const boundary_names[] = {"periodic", "mirror", NULL};

#define FIELD(name) offsetof(rig_file, name)
#define LENGTH_KEY(section_, key_, field_, low_, high_)                                            \
    {.section = section_, .name = key_, .kind = PTIE_INI_QUANTITY, .quantity = PTIE_LENGTH,        \
     .offset = FIELD(field_), .low = low_, .high = high_}
#define TEXT_KEY(section_, key_, field_)                                                           \
    {.section = section_, .name = key_, .kind = PTIE_INI_TEXT, .offset = FIELD(field_),            \
     .text_bytes = sizeof((rig_file *)0)->field_}
#define CHOICE_KEY(section_, key_, field_, choices_)                                               \
    {.section = section_, .name = key_, .kind = PTIE_INI_CHOICE, .offset = FIELD(field_),          \
     .choices = choices_}

static const ptie_ini_key rig_keys[] = {
    {.section = "optics", .name = "wavelength", .kind = PTIE_INI_QUANTITY, .quantity = PTIE_LENGTH,
     .offset = FIELD(wavelength_m), .low = 1e-12, .high = 1e-3, .required = true},
    {.section = "optics", .name = "pixel", .kind = PTIE_INI_QUANTITY, .quantity = PTIE_LENGTH,
     .offset = FIELD(pixel_m), .low = 1e-10, .high = 1, .required = true},
    {.section = "optics", .name = "magnification", .kind = PTIE_INI_QUANTITY, .quantity = PTIE_NUMBER,
     .offset = FIELD(magnification), .low = 1e-6, .high = 1e6},
    LENGTH_KEY("optics", "defocus", defocus_m, -1e3, 1e3),
    LENGTH_KEY("optics", "defocus_plus", defocus_plus_m, -1e3, 1e3),
    LENGTH_KEY("optics", "defocus_minus", defocus_minus_m, -1e3, 1e3),
    CHOICE_KEY("planes", "layout", planes, plane_names),
    TEXT_KEY("planes", "plus", plus),
    TEXT_KEY("planes", "zero", zero),
    TEXT_KEY("planes", "minus", minus),
    TEXT_KEY("planes", "reference", reference),
    {.section = "recording", .name = "frame_rate", .kind = PTIE_INI_QUANTITY, .quantity = PTIE_RATE,
     .offset = FIELD(frame_rate_hz), .low = 0, .high = 1e12},
    CHOICE_KEY("flow", "polarity", polarity, polarity_names),
    {.section = "solver", .name = "binning", .kind = PTIE_INI_INTEGER, .offset = FIELD(binning), .low = 1,
     .high = 64},
    CHOICE_KEY("solver", "boundary", boundary, boundary_names),
    LENGTH_KEY("solver", "cutoff", cutoff_m, 0, 1e3),
    {.section = "solver", .name = "zero_border", .kind = PTIE_INI_BOOLEAN, .offset = FIELD(zero_border)},
};
enum { RIG_KEYS = sizeof rig_keys / sizeof *rig_keys };

void ptie_rig_defaults(ptie_rig *rig) {
    *rig = (ptie_rig){.struct_size = sizeof *rig, .wavelength_m = 532e-9, .defocus_plus_m = 10e-3,
                      .defocus_minus_m = -10e-3, .polarity = 0, .binning = 1, .boundary = PTIE_MIRROR,
                      .zero_border = true};
}

/* A path in a rig is relative to the rig's own folder. */
static ptie_status resolve(char *path, size_t bytes, const char *rig_path) {
    const char *slash = strrchr(rig_path, '/');
    if (!path[0] || path[0] == '/' || !slash) return PTIE_OK;
    size_t folder = (size_t)(slash - rig_path) + 1, name = strlen(path) + 1;
    if (folder + name > bytes)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: reference: path longer than %zu bytes", rig_path, bytes - 1);
    memmove(path + folder, path, name);
    memcpy(path, rig_path, folder);
    return PTIE_OK;
}

/* Planes are data sets inside the recording. */
static ptie_status check_data_set(const char *name, const char *key, const char *path) {
    if (!name[0] || name[0] == '/') return PTIE_OK;
    return PTIE_FAIL(PTIE_EFORMAT, "%s: %s: expected a data set such as /entry/data/%s, found '%s'", path,
                     key, key, name);
}

static ptie_status convert(ptie_rig *rig, const rig_file *file, const char *path) {
    const bool plus = !isnan(file->defocus_plus_m), minus = !isnan(file->defocus_minus_m);
    const bool both = !isnan(file->defocus_m);
    if (both && (plus || minus))
        return PTIE_FAIL(PTIE_EINVAL, "%s: 'defocus' does not go with 'defocus_plus' and 'defocus_minus'", path);
    if (!both && plus != minus && (minus || file->planes != PTIE_PLANES_REFERENCE))
        return PTIE_FAIL(PTIE_EINVAL, "%s: missing key '%s' in [optics] (expected a length such as -10 mm)",
                         path, plus ? "defocus_minus" : "defocus_plus");
    double plus_m = both ? file->defocus_m : file->defocus_plus_m;
    double minus_m = both ? -file->defocus_m : minus ? file->defocus_minus_m : -plus_m;
    if (isnan(plus_m) || plus_m == 0)
        return PTIE_FAIL(PTIE_EINVAL, "%s: missing key 'defocus' in [optics] (expected a length such as 10 mm)",
                         path);
    if (file->planes != PTIE_PLANES_REFERENCE && minus_m >= plus_m)
        return PTIE_FAIL(PTIE_EINVAL, "%s: defocus_minus must lie below defocus_plus (found %g m and %g m)",
                         path, minus_m, plus_m);
    PTIE_TRY(check_data_set(file->plus, "plus", path));
    PTIE_TRY(check_data_set(file->zero, "zero", path));
    PTIE_TRY(check_data_set(file->minus, "minus", path));
    ptie_rig_defaults(rig);
    rig->wavelength_m = file->wavelength_m;
    rig->pixel_m = file->pixel_m / file->magnification;
    rig->defocus_plus_m = plus_m;
    rig->defocus_minus_m = minus_m;
    rig->planes = (ptie_planes)file->planes;
    rig->polarity = file->polarity - 1;
    rig->binning = file->binning;
    rig->boundary = (ptie_boundary)file->boundary;
    rig->cutoff_m = file->cutoff_m;
    rig->frame_rate_hz = file->frame_rate_hz;
    rig->zero_border = file->zero_border;
    memcpy(rig->plus, file->plus, sizeof rig->plus);
    memcpy(rig->zero, file->zero, sizeof rig->zero);
    memcpy(rig->minus, file->minus, sizeof rig->minus);
    memcpy(rig->reference, file->reference, sizeof rig->reference);
    return resolve(rig->reference, sizeof rig->reference, path);
}

ptie_status ptie_rig_read(ptie_rig *rig, const char *path) {
    char *text;
    size_t bytes;
    PTIE_TRY(ptie_read_file(&text, &bytes, path, MAX_RIG_BYTES));
    const double none = (double)NAN;
    rig_file file = {.defocus_m = none, .defocus_plus_m = none, .defocus_minus_m = none,
                     .magnification = 1, .polarity = 1, .binning = 1, .boundary = PTIE_MIRROR,
                     .zero_border = true};
    ptie_status status = ptie_ini_read(&file, rig_keys, RIG_KEYS, text, path);
    if (status == PTIE_OK) status = convert(rig, &file, path);
    ptie_free(text);
    return status;
}

char *ptie_rig_print(const ptie_rig *rig) {
    const bool equal = rig->defocus_minus_m == -rig->defocus_plus_m;
    const double none = (double)NAN;
    rig_file file = {.wavelength_m = rig->wavelength_m, .pixel_m = rig->pixel_m, .magnification = 1,
                     .defocus_m = equal ? rig->defocus_plus_m : none,
                     .defocus_plus_m = equal ? none : rig->defocus_plus_m,
                     .defocus_minus_m = equal ? none : rig->defocus_minus_m,
                     .frame_rate_hz = rig->frame_rate_hz, .cutoff_m = rig->cutoff_m,
                     .planes = (int)rig->planes, .polarity = rig->polarity + 1,
                     .boundary = (int)rig->boundary, .binning = rig->binning,
                     .zero_border = rig->zero_border};
    memcpy(file.plus, rig->plus, sizeof file.plus);
    memcpy(file.zero, rig->zero, sizeof file.zero);
    memcpy(file.minus, rig->minus, sizeof file.minus);
    memcpy(file.reference, rig->reference, sizeof file.reference);
    ptie_text text = {0};
    ptie_ini_print(&text, &file, rig_keys, RIG_KEYS);
    if (!text.failed) return text.data;
    ptie_text_free(&text);
    return NULL;
}
