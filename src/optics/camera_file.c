/* SPDX-License-Identifier: BSD-3-Clause */
/* Camera files: <ptie/camera.h> as INI text, docs/formats.md; what values are allowed, in files and in programs. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/ini.h"
#include "base/memory.h"
#include "optics/camera.h"

#define MAX_CAMERA_BYTES (1 << 20)

/* A camera as a person writes it: four numbers of a cell in one line. */
typedef struct camera_file {
    ptie_camera_params params;
    char angles[64], gains[64];
} camera_file;

#define FIELD(name) offsetof(camera_file, params.name)
#define QUANTITY_KEY(section_, key_, field_, quantity_, low_, high_)                                \
    {.section = section_, .name = key_, .kind = PTIE_INI_QUANTITY, .quantity = quantity_,          \
     .offset = FIELD(field_), .low = low_, .high = high_}
#define INTEGER_KEY(section_, key_, field_, low_, high_)                                            \
    {.section = section_, .name = key_, .kind = PTIE_INI_INTEGER, .offset = FIELD(field_),         \
     .low = low_, .high = high_}
#define LINE_KEY(section_, key_, field_)                                                            \
    {.section = section_, .name = key_, .kind = PTIE_INI_TEXT,                                     \
     .offset = offsetof(camera_file, field_), .text_bytes = sizeof((camera_file *)0)->field_}

static const ptie_ini_key camera_keys[] = {
    INTEGER_KEY("sensor", "bits", bits, 8, 16),
    QUANTITY_KEY("sensor", "full_well", full_well, PTIE_NUMBER, 1, 1e9),
    QUANTITY_KEY("sensor", "read_noise", read_noise, PTIE_NUMBER, 0, 1e6),
    QUANTITY_KEY("sensor", "black", black, PTIE_NUMBER, 0, 65535),
    QUANTITY_KEY("sensor", "exposure", exposure, PTIE_NUMBER, 0, 10),
    QUANTITY_KEY("sensor", "pixel_gain", pixel_gain, PTIE_NUMBER, 0, 1),
    QUANTITY_KEY("sensor", "pixel_offset", pixel_offset, PTIE_NUMBER, 0, 65535),
    INTEGER_KEY("sensor", "dust", dust, 0, 1000),
    QUANTITY_KEY("sensor", "dust_depth", dust_depth, PTIE_NUMBER, 0, 1),
    LINE_KEY("mosaic", "angles", angles),
    INTEGER_KEY("mosaic", "roi_x", roi_x_px, 0, 32767),
    INTEGER_KEY("mosaic", "roi_y", roi_y_px, 0, 32767),
    QUANTITY_KEY("mosaic", "plus", plus_rad, PTIE_ANGLE, -10, 10),
    QUANTITY_KEY("mosaic", "minus", minus_rad, PTIE_ANGLE, -10, 10),
    QUANTITY_KEY("mosaic", "extinction", extinction, PTIE_NUMBER, 1, (double)INFINITY),
    LINE_KEY("mosaic", "gain", gains),
    QUANTITY_KEY("minus", "gain", minus_gain, PTIE_NUMBER, 0, 100),
    QUANTITY_KEY("minus", "shift_x", minus_shift_x_px, PTIE_NUMBER, -1000, 1000),
    QUANTITY_KEY("minus", "shift_y", minus_shift_y_px, PTIE_NUMBER, -1000, 1000),
    QUANTITY_KEY("minus", "magnification", minus_magnification, PTIE_NUMBER, 0.5, 2),
    QUANTITY_KEY("minus", "rotation", minus_rotation_rad, PTIE_ANGLE, -0.5, 0.5),
    QUANTITY_KEY("light", "beam", beam_m, PTIE_LENGTH, 0, 1e3),
    QUANTITY_KEY("light", "fringes", fringes, PTIE_NUMBER, 0, 1),
    QUANTITY_KEY("light", "flicker", flicker, PTIE_NUMBER, 0, 1),
    QUANTITY_KEY("nozzle", "length", nozzle_length_m, PTIE_LENGTH, 0, 1e3),
    QUANTITY_KEY("nozzle", "width", nozzle_width_m, PTIE_LENGTH, 0, 1e3),
};
enum { CAMERA_KEYS = sizeof camera_keys / sizeof *camera_keys };

static ptie_status out_of_range(const char *where, const char *name, double low, double high, double found) {
    return PTIE_FAIL(PTIE_EINVAL, "%s: %s is out of range (expected %g..%g, found %g)", where, name, low, high, found);
}

/* The keys' ranges, and what no key says alone. */
ptie_status ptie_camera_check(const ptie_camera_params *params, const char *where) {
    const camera_file file = {.params = *params};
    for (size_t i = 0; i < CAMERA_KEYS; i++) {
        const ptie_ini_key *key = &camera_keys[i];
        const char *field = (const char *)&file + key->offset;
        double value = key->low;
        int32_t whole;
        if (key->kind == PTIE_INI_QUANTITY) memcpy(&value, field, sizeof value);
        if (key->kind == PTIE_INI_INTEGER) memcpy(&whole, field, sizeof whole), value = whole;
        if (!(value >= key->low && value <= key->high))
            return out_of_range(where, key->name, key->low, key->high, value);
    }
    const double last = ldexp(1, params->bits) - 1;
    if (params->black >= last) return out_of_range(where, "black", 0, last - 1, params->black);
    for (int c = 0; c < 4; c++)
        if (!(params->gain[c] >= 0 && params->gain[c] <= 100))
            return out_of_range(where, "gain", 0, 100, params->gain[c]);
    return PTIE_OK;
}

/* Four numbers with white space between them. */
static ptie_status read_cell(double cell[4], const char *text, const char *key, const char *where) {
    const char *at = text;
    for (int c = 0; c < 4; c++) {
        char *end;
        cell[c] = ptie_scan_number(at, &end);
        if (end == at || !isfinite(cell[c])) break;
        at = end;
        if (c == 3 && at[strspn(at, " \t")] == 0) return PTIE_OK;
    }
    return PTIE_FAIL(PTIE_EFORMAT, "%s: %s: expected four numbers, row by row, found '%s'", where, key, text);
}

/* "none", a maker's mosaic, or four angles. */
static ptie_status read_mosaic(ptie_camera_params *params, const char *text, const char *where) {
    static const struct {
        const char *name, *angles;
    } makers[] = {{"sony", "90 45 135 0"}, {"crysta", "0 45 135 90"}};
    double cell[4];
    if (strcmp(text, "none") == 0) return PTIE_OK;
    params->layout = PTIE_CAMERA_MOSAIC;
    for (size_t i = 0; i < sizeof makers / sizeof *makers; i++)
        if (strcmp(text, makers[i].name) == 0) text = makers[i].angles;
    PTIE_TRY(read_cell(cell, text, "angles (none, sony, crysta, or degrees)", where));
    for (int c = 0; c < 4; c++) {
        if (cell[c] < -360 || cell[c] > 360 || cell[c] != rint(cell[c]))
            return PTIE_FAIL(PTIE_EFORMAT, "%s: angles: expected whole degrees from -360 to 360, found %g", where,
                             cell[c]);
        params->angle_deg[c] = (int32_t)cell[c];
    }
    return PTIE_OK;
}

static ptie_status read_text(ptie_camera_params *params, const char *text, const char *path) {
    camera_file file = {.angles = "none", .gains = "1 1 1 1"};
    ptie_camera_params_init(&file.params);
    PTIE_TRY(ptie_ini_read(&file, camera_keys, CAMERA_KEYS, text, path));
    PTIE_TRY(read_mosaic(&file.params, file.angles, path));
    PTIE_TRY(read_cell(file.params.gain, file.gains, "gain", path));
    PTIE_TRY(ptie_camera_check(&file.params, path));
    *params = file.params;
    return PTIE_OK;
}

ptie_status ptie_camera_read(ptie_camera_params *params, const char *path) {
    char *text;
    size_t bytes;
    PTIE_TRY(ptie_read_file(&text, &bytes, path, MAX_CAMERA_BYTES));
    ptie_status status = read_text(params, text, path);
    ptie_free(text);
    return status;
}
