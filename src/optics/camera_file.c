/* SPDX-License-Identifier: BSD-3-Clause */
/* Camera files: <ptie/camera.h> as INI text, docs/formats.md; what values are allowed, in files and in programs. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/ini.h"
#include "base/memory.h"
#include "optics/camera.h"
#include "optics/mosaic.h"

#define MAX_CAMERA_BYTES (1 << 20)
#define MOST_GAIN 100

static const char *const layout_names[] = {"separate", "mosaic", NULL};

/* double[4]: a number per pixel of a cell, row by row. */
static const char *parse_cell(void *field, const char *text) {
    double cell[4];
    for (int c = 0; c < 4; c++) {
        char *end;
        cell[c] = ptie_scan_number(text, &end);
        if (end == text || !(cell[c] >= 0 && cell[c] <= MOST_GAIN)) return "four numbers from 0 to 100, row by row";
        text = end;
    }
    if (text[strspn(text, " \t")]) return "four numbers from 0 to 100, row by row";
    memcpy(field, cell, sizeof cell);
    return NULL;
}

static const ptie_ini_type cell_type = {parse_cell, NULL}; /* cameras are not printed */

#define FIELD(name) offsetof(ptie_camera_params, name)
#define QUANTITY_KEY(section_, key_, field_, quantity_, low_, high_)                                \
    {.section = section_, .name = key_, .kind = PTIE_INI_QUANTITY, .quantity = quantity_,          \
     .offset = FIELD(field_), .low = low_, .high = high_}
#define INTEGER_KEY(section_, key_, field_, low_, high_)                                            \
    {.section = section_, .name = key_, .kind = PTIE_INI_INTEGER, .offset = FIELD(field_),         \
     .low = low_, .high = high_}
#define OWN_KEY(section_, key_, field_, type_)                                                      \
    {.section = section_, .name = key_, .kind = PTIE_INI_OWN, .offset = FIELD(field_), .type = &type_}

static const ptie_ini_key camera_keys[] = {
    {.section = "sensor", .name = "layout", .kind = PTIE_INI_CHOICE, .offset = FIELD(layout), .choices = layout_names},
    INTEGER_KEY("sensor", "bits", bits, 8, 16),
    QUANTITY_KEY("sensor", "full_well", full_well, PTIE_NUMBER, 1, 1e9),
    QUANTITY_KEY("sensor", "read_noise", read_noise, PTIE_NUMBER, 0, 1e6),
    QUANTITY_KEY("sensor", "black", black, PTIE_NUMBER, 0, 65535),
    QUANTITY_KEY("sensor", "exposure", exposure, PTIE_NUMBER, 0, 10),
    QUANTITY_KEY("sensor", "pixel_gain", pixel_gain, PTIE_NUMBER, 0, 1),
    QUANTITY_KEY("sensor", "pixel_offset", pixel_offset, PTIE_NUMBER, 0, 65535),
    INTEGER_KEY("sensor", "dust", dust, 0, 1000),
    QUANTITY_KEY("sensor", "dust_depth", dust_depth, PTIE_NUMBER, 0, 1),
    OWN_KEY("mosaic", "angles", angle_deg, ptie_mosaic_type),
    INTEGER_KEY("mosaic", "roi_x", roi_x_px, 0, 32767),
    INTEGER_KEY("mosaic", "roi_y", roi_y_px, 0, 32767),
    QUANTITY_KEY("mosaic", "plus", plus_rad, PTIE_ANGLE, -10, 10),
    QUANTITY_KEY("mosaic", "minus", minus_rad, PTIE_ANGLE, -10, 10),
    QUANTITY_KEY("mosaic", "extinction", extinction, PTIE_NUMBER, 1, (double)INFINITY),
    OWN_KEY("mosaic", "gain", gain, cell_type),
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
    for (size_t i = 0; i < CAMERA_KEYS; i++) {
        const ptie_ini_key *key = &camera_keys[i];
        const char *field = (const char *)params + key->offset;
        double value = key->low;
        int32_t whole;
        if (key->kind == PTIE_INI_QUANTITY) memcpy(&value, field, sizeof value);
        if (key->kind == PTIE_INI_INTEGER) memcpy(&whole, field, sizeof whole), value = whole;
        if (!(value >= key->low && value <= key->high))
            return out_of_range(where, key->name, key->low, key->high, value);
    }
    const double last = ldexp(1, params->bits) - 1;
    if (params->black >= last) return out_of_range(where, "black", 0, last - 1, params->black);
    if (params->layout != PTIE_CAMERA_SEPARATE && params->layout != PTIE_CAMERA_MOSAIC)
        return out_of_range(where, "layout", PTIE_CAMERA_SEPARATE, PTIE_CAMERA_MOSAIC, params->layout);
    for (int c = 0; c < 4; c++) {
        if (params->angle_deg[c] < 0 || params->angle_deg[c] >= 180)
            return out_of_range(where, "angle_deg", 0, 179, params->angle_deg[c]);
        if (!(params->gain[c] >= 0 && params->gain[c] <= MOST_GAIN))
            return out_of_range(where, "gain", 0, MOST_GAIN, params->gain[c]);
    }
    return PTIE_OK;
}

static ptie_status read_text(ptie_camera_params *params, const char *text, const char *path) {
    ptie_camera_params read;
    ptie_camera_params_init(&read);
    PTIE_TRY(ptie_ini_read(&read, camera_keys, CAMERA_KEYS, text, path));
    PTIE_TRY(ptie_camera_check(&read, path));
    *params = read;
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
