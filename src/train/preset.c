/* SPDX-License-Identifier: BSD-3-Clause */
#include "train/preset.h"

#include <stdio.h>
#include <string.h>

#include <ptie/optics.h>

#include "base/file.h"
#include "base/memory.h"

#define MAX_PRESET_BYTES (1 << 20)

/* NULL-terminated: the words of the key `base`, too. */
static const char *const preset_names[] = {"paper", "realistic", NULL};
static const char *const family_names[] = {"parametric", "physical", NULL};
static const char *const propagation_names[] = {"tie-spectral", "tie-stencil", "angular-spectrum",
                                                NULL};
static const char *const boundary_names[] = {"periodic", "mirror", NULL};

/* The built-in presets.
 *
 * Noise of `paper`, the one thing the paper does not state: the linear TIE and its inverse undo each
 * other, so all that separates noisy from clean is camera noise divided by k^2.  Its rms is 0.04397
 * (2 pi / wavelength) sigma N pixel^2 / defocus = 5.3 rad * sigma here; the maps themselves, 1 rad high,
 * have an rms of 0.17 rad (median of 500 samples).  1.5 % .. 15 % are chosen so that the paper's recipe
 * ends near its Table 2 (models/paper.md); they make clouds of one half to five times the flow's own
 * rms, which partly or fully hide it, as its Fig. 4 says.  Only sigma / amplitude matters. */
static ptie_preset built_in(int which, const char *name) {
    ptie_preset paper = {
        .width_px = 256,
        .height_px = 256,
        .mix = ptie_flow_mix_paper(),
        .amplitude_rad = {1, 1},
        .wavelength_m = 532e-9,
        .pixel_m = 20e-6,
        .defocus_m = 10e-3,
        .propagation = PTIE_TIE_SPECTRAL,
        .boundary = PTIE_PERIODIC,
        .noise = {0.015, 0.15},
    };
    /* Diffraction makes most of the artifact; sigma is that of a camera at 25,000 fps. */
    ptie_preset realistic = paper;
    realistic.mix = ptie_flow_mix_realistic();
    realistic.propagation = PTIE_ANGULAR_SPECTRUM;
    realistic.boundary = PTIE_MIRROR;
    realistic.noise = (ptie_range){0.001, 0.01};

    ptie_preset preset = which == 0 ? paper : realistic;
    preset.base = which;
    snprintf(preset.name, sizeof preset.name, "%s", name);
    return preset;
}

#define FIELD(name) offsetof(ptie_preset, name)
#define LENGTH_KEY(key_, field_, low_, high_)                                                      \
    {                                                                                              \
        .section = "optics", .name = key_, .kind = PTIE_INI_QUANTITY, .quantity = PTIE_LENGTH,     \
        .offset = FIELD(field_), .low = low_, .high = high_                                        \
    }
#define RANGE_KEY(section_, key_, field_, quantity_, low_, high_)                                  \
    {                                                                                              \
        .section = section_, .name = key_, .kind = PTIE_INI_RANGE, .quantity = quantity_,          \
        .offset = FIELD(field_), .low = low_, .high = high_                                        \
    }
#define CHOICE_KEY(section_, key_, field_, choices_)                                               \
    {                                                                                              \
        .section = section_, .name = key_, .kind = PTIE_INI_CHOICE, .offset = FIELD(field_),       \
        .choices = choices_                                                                        \
    }
#define SIZE_KEY(key_, field_)                                                                     \
    {                                                                                              \
        .section = "image", .name = key_, .kind = PTIE_INI_INTEGER, .offset = FIELD(field_),       \
        .low = 16, .high = 32768                                                                   \
    }

static const ptie_ini_key fixed_keys[] = {
    {.section = "preset",
     .name = "name",
     .kind = PTIE_INI_TEXT,
     .offset = FIELD(name),
     .text_bytes = sizeof((ptie_preset *)0)->name},
    CHOICE_KEY("preset", "base", base, preset_names),
    SIZE_KEY("width", width_px),
    SIZE_KEY("height", height_px),
    LENGTH_KEY("wavelength", wavelength_m, 1e-12, 1e-2),
    LENGTH_KEY("pixel", pixel_m, 1e-9, 1),
    LENGTH_KEY("defocus", defocus_m, 1e-9, 1e3),
    CHOICE_KEY("optics", "propagation", propagation, propagation_names),
    CHOICE_KEY("optics", "boundary", boundary, boundary_names),
    RANGE_KEY("camera", "noise", noise, PTIE_NUMBER, 0, 1),
    CHOICE_KEY("flow", "family", mix.family, family_names),
    RANGE_KEY("flow", "amplitude", amplitude_rad, PTIE_ANGLE, 1e-6, 1e6),
    RANGE_KEY("flow", "components", mix.components, PTIE_NUMBER, 1, 4),
    RANGE_KEY("flow", "smoothing_px", mix.smoothing_px, PTIE_NUMBER, 0, 64),
    RANGE_KEY("flow", "gradient", mix.gradient, PTIE_NUMBER, 0, 10),
};
enum { FIXED_KEYS = sizeof fixed_keys / sizeof *fixed_keys, KEYS = FIXED_KEYS + PTIE_MORPHOLOGIES };

/* The fixed keys, and the weight of each morphology under its own name. */
static void preset_keys(ptie_ini_key keys[KEYS]) {
    memcpy(keys, fixed_keys, sizeof fixed_keys);
    for (int32_t i = 0; i < PTIE_MORPHOLOGIES; i++)
        keys[FIXED_KEYS + i] = (ptie_ini_key){
            .section = "morphologies",
            .name = ptie_morphology_name(i),
            .kind = PTIE_INI_QUANTITY,
            .quantity = PTIE_NUMBER,
            .offset = FIELD(mix.weight) + (size_t)i * sizeof(double),
            .high = 1e6,
        };
}

static ptie_status check_preset(const ptie_preset *preset, const char *where) {
    if (preset->noise.low == 0 && preset->noise.high > 0)
        return PTIE_FAIL(
            PTIE_EFORMAT,
            "%s: noise: drawn log-uniformly (expected 0, or a range above 0, found 0 .. %g)", where,
            preset->noise.high);
    double weight = 0;
    for (int i = 0; i < PTIE_MORPHOLOGIES; i++) weight += preset->mix.weight[i];
    if (weight <= 0)
        return PTIE_FAIL(PTIE_EFORMAT,
                         "%s: [morphologies]: nothing to draw (expected a weight > 0)", where);
    return PTIE_OK;
}

/* `base` decides what the other keys start from, so a file that names another one is read again. */
static ptie_status read_text(ptie_preset *preset, const char *text, const char *where) {
    ptie_ini_key keys[KEYS];
    preset_keys(keys);
    *preset = built_in(0, "custom");
    PTIE_TRY(ptie_ini_read(preset, keys, KEYS, text, where));
    if (preset->base != 0) {
        *preset = built_in(preset->base, "custom");
        PTIE_TRY(ptie_ini_read(preset, keys, KEYS, text, where));
    }
    if (!preset->name[0]) snprintf(preset->name, sizeof preset->name, "custom");
    return check_preset(preset, where);
}

static ptie_status read_file(ptie_preset *preset, const char *path) {
    char *text;
    size_t bytes;
    PTIE_TRY(ptie_read_file(&text, &bytes, path, MAX_PRESET_BYTES));
    ptie_status status = read_text(preset, text, path);
    ptie_free(text);
    return status;
}

static ptie_status find_built_in(ptie_preset *preset, const char *name) {
    for (int i = 0; preset_names[i]; i++)
        if (strcmp(name, preset_names[i]) == 0) {
            *preset = built_in(i, name);
            return PTIE_OK;
        }
    return PTIE_FAIL(PTIE_ENAME, "%s: unknown preset (did you mean '%s'? a file ends in .ini)",
                     name, ptie_nearest_word(name, preset_names));
}

static bool is_path(const char *name) {
    size_t length = strlen(name);
    return strchr(name, '/') || (length >= 4 && strcmp(name + length - 4, ".ini") == 0);
}

static ptie_status print_text(ptie_preset *preset) {
    ptie_ini_key keys[KEYS];
    preset_keys(keys);
    ptie_text text = {0};
    ptie_ini_print(&text, preset, keys, KEYS);
    if (text.failed) {
        ptie_text_free(&text);
        return PTIE_FAIL(PTIE_ENOMEM, "preset %s: out of memory", preset->name);
    }
    preset->text = text.data;
    return PTIE_OK;
}

ptie_status ptie_preset_read(ptie_preset **out, const char *name) {
    *out = NULL;
    ptie_preset *preset;
    PTIE_TRY(ptie_alloc_status(&preset, 1, sizeof *preset, "preset"));
    ptie_status status = is_path(name) ? read_file(preset, name) : find_built_in(preset, name);
    if (status == PTIE_OK) status = print_text(preset);
    if (status != PTIE_OK) {
        ptie_preset_free(preset);
        return status;
    }
    *out = preset;
    return PTIE_OK;
}

void ptie_preset_free(ptie_preset *preset) {
    if (!preset) return;
    ptie_free(preset->text);
    ptie_free(preset);
}

const char *ptie_preset_name(int32_t which) {
    enum { COUNT = sizeof preset_names / sizeof *preset_names - 1 };
    return which >= 0 && which < COUNT ? preset_names[which] : NULL;
}

const char *ptie_preset_text(const ptie_preset *preset) {
    return preset->text;
}

void ptie_preset_size(const ptie_preset *preset, int32_t *width_px, int32_t *height_px) {
    *width_px = preset->width_px;
    *height_px = preset->height_px;
}
