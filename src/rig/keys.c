/* SPDX-License-Identifier: BSD-3-Clause */
#include "rig/keys.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "optics/mosaic.h"
#include "rig/channels.h"
#include "rig/planes.h"
#include "rig/rig.h"

#define MOST_DEFOCUS_M 1e3

const char *const ptie_set_names[] = {"pair", "triple", "five", "reference", NULL};
static const char *const layout_names[] = {"separate", "mosaic", "side-by-side", "top-bottom", "quadrants", NULL};
static const char *const demosaic_names[] = {"none", "bilinear", "fourier", NULL};
static const char *const background_names[] = {"none", "plane", "zernike", NULL};
static const char *const polarity_names[] = {"negative", "auto", "positive", NULL}; /* index - 1 */
static const char *const boundary_names[] = {"periodic", "mirror", NULL};
static const char *const method_names[] = {"direct", "max-intensity", "two-poisson", "iterative-dct", "us-tie", NULL};

/* Planes in units of 'defocus'. */
const double ptie_plane_steps[PTIE_ROLES] = {1, -1, 0, 2, -2};

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

/* double: "auto", "l-curve" or a length. */
static const char *parse_cutoff(void *field, const char *text) {
    double value = strcmp(text, "auto") == 0 ? PTIE_CUTOFF_AUTO : PTIE_CUTOFF_CORNER;
    if (value != PTIE_CUTOFF_AUTO && strcmp(text, "l-curve") != 0 &&
        (ptie_parse_quantity(text, PTIE_LENGTH, &value) || !(value >= 0 && value <= 1e3)))
        return "a length such as 3 mm, 0, auto or l-curve";
    memcpy(field, &value, sizeof value);
    return NULL;
}

static void print_cutoff(ptie_text *out, const void *field) {
    const double value = *(const double *)field;
    char text[PTIE_QUANTITY_BYTES];
    ptie_text_append(out, "%s", value == PTIE_CUTOFF_AUTO     ? "auto"
                                : value == PTIE_CUTOFF_CORNER ? "l-curve"
                                                              : ptie_print_quantity(text, value, PTIE_LENGTH));
}

static const ptie_ini_type cutoff_type = {parse_cutoff, print_cutoff};
static const ptie_ini_type frames_type = {parse_frames, print_frames};
static const ptie_ini_type rect_type = {parse_rect, print_rect};

/* clang-format off */
#define KEY(section_, name_, field_, help_, ...)                                                   \
    {.section = section_, .name = name_, .offset = offsetof(ptie_rig_file, field_), .help = help_, __VA_ARGS__}
#define QUANTITY(quantity_, low_, high_)                                                           \
    .kind = PTIE_INI_QUANTITY, .quantity = quantity_, .low = low_, .high = high_
#define LENGTH(low_, high_) QUANTITY(PTIE_LENGTH, low_, high_)
#define NUMBER(low_, high_) QUANTITY(PTIE_NUMBER, low_, high_)
#define INTEGER(low_, high_) .kind = PTIE_INI_INTEGER, .low = low_, .high = high_
#define BOOLEAN .kind = PTIE_INI_BOOLEAN
#define TEXT(field_) .kind = PTIE_INI_TEXT, .text_bytes = sizeof((ptie_rig_file *)0)->field_
#define CHOICE(names_) .kind = PTIE_INI_CHOICE, .choices = names_
#define OWN(type_) .kind = PTIE_INI_OWN, .type = &type_
#define PATH(name_, field_, help_, example_)                                                       \
    KEY("recording", name_, field_, help_, TEXT(field_), .example = example_)
#define PLANE(name_, role_, help_, example_)                                                       \
    KEY("planes", name_, planes[role_], help_, TEXT(planes[role_]), .example = example_)
#define PLANE_LEVEL(section_, role_)                                                               \
    KEY(section_, "defocus", plane[role_].defocus_m, "distance from focus, instead of that in [optics]", \
        LENGTH(-MOST_DEFOCUS_M, MOST_DEFOCUS_M), .example = "10 mm"),                              \
    KEY(section_, "gain", plane[role_].gain, "multiplies the plane", NUMBER(1e-6, 1e6), .example = "1")
#define PLANE_SECTION(section_, role_)                                                             \
    PLANE_LEVEL(section_, role_),                                                                  \
    KEY(section_, "shift_x", plane[role_].shift_x_px, "where the plane lies on the grid of plus, px", \
        NUMBER(-32768, 32768), .example = "0"),                                                    \
    KEY(section_, "shift_y", plane[role_].shift_y_px, "positive: to the right, down", NUMBER(-32768, 32768), \
        .example = "0"),                                                                           \
    KEY(section_, "magnification", plane[role_].magnification, "relative to plus", NUMBER(0.5, 2), .example = "1"), \
    KEY(section_, "rotation", plane[role_].rotation_rad, "positive: from x towards y", QUANTITY(PTIE_ANGLE, -3.15, 3.15), \
        .example = "0 mrad")

const ptie_ini_key ptie_rig_keys[] = {
    KEY("optics", "wavelength", rig.wavelength_m, "of the light", LENGTH(1e-12, 1e-3), .required = true),
    KEY("optics", "pixel", pitch_m, "pitch of the sensor; of the object if magnification is 1", LENGTH(1e-10, 1),
        .required = true),
    KEY("optics", "magnification", magnification, "pixel at the object = pixel / magnification", NUMBER(1e-6, 1e6)),
    KEY("optics", "defocus", defocus_m, "plus lies at +defocus, minus at -defocus, zero in focus",
        LENGTH(-MOST_DEFOCUS_M, MOST_DEFOCUS_M)),

    KEY("planes", "set", set, "pair (plus, minus), triple (and zero), five, reference (plus, no flow)",
        CHOICE(ptie_set_names)),
    KEY("planes", "layout", rig.layout, "separate, mosaic, side-by-side, top-bottom, quadrants", CHOICE(layout_names)),
    KEY("planes", "mosaic", rig.angle_deg, "polarisers of a 2 x 2 cell: sony, crysta, or angles by rows",
        OWN(ptie_mosaic_type), .example = "90 45 135 0"),
    KEY("planes", "roi_x", rig.roi_x, "where the recorded region begins on the sensor, px", INTEGER(0, 32767)),
    KEY("planes", "roi_y", rig.roi_y, "an odd one turns the mosaic over", INTEGER(0, 32767)),
    PLANE("plus", PTIE_PLUS, "data set, or channels: 0, 0.98*0 + 0.02*45, left, top, tl", "/entry/data/plus"),
    PLANE("minus", PTIE_MINUS, "before focus", "/entry/data/minus"),
    PLANE("zero", PTIE_ZERO, "in focus", "/entry/data/zero"),
    PLANE("plus2", PTIE_PLUS2, "farther beyond focus", "/entry/data/plus2"),
    PLANE("minus2", PTIE_MINUS2, "farther before focus", "/entry/data/minus2"),
    PLANE_LEVEL("plus", PTIE_PLUS),
    PLANE_SECTION("minus", PTIE_MINUS),
    PLANE_SECTION("zero", PTIE_ZERO),
    PLANE_SECTION("plus2", PTIE_PLUS2),
    PLANE_SECTION("minus2", PTIE_MINUS2),

    KEY("recording", "frame_rate", rig.frame_rate_hz, "0: as the recording says", QUANTITY(PTIE_RATE, 0, 1e12)),
    PATH("reference", rig.reference, "frames without flow, averaged; beside this file", "noflow.mraw"),
    PATH("dark", rig.dark, "frames without light, averaged", "dark.mraw"),
    PATH("mask", rig.mask, "image of a plane's size: 0 = opaque", "mask.png"),
    KEY("recording", "still_frames", rig.still_first, "frames without flow: their median phase is taken off",
        OWN(frames_type), .example = "0:100"),

    KEY("camera", "saturation", rig.saturation_counts, "largest value of the sensor, counts; 0 = unknown",
        NUMBER(0, 1e9)),
    KEY("camera", "electrons_per_count", rig.electrons_per_count, "0 = unknown", NUMBER(0, 1e9)),
    KEY("camera", "read_noise", rig.read_noise_electrons, "of a dark pixel, electrons", NUMBER(0, 1e9)),

    KEY("preprocess", "demosaic", rig.demosaic, "channels to one grid: none, bilinear, fourier", CHOICE(demosaic_names)),
    KEY("preprocess", "flat_field", rig.flat_field, "divide planes by their reference", BOOLEAN),
    KEY("preprocess", "match_gain", rig.match_gain, "scale planes to equal means", BOOLEAN),
    KEY("preprocess", "mask_below", rig.mask_below, "opaque below this share of the median; 0 = nowhere", NUMBER(0, 1)),
    KEY("preprocess", "background", rig.background, "off the phase outside the flow: none, plane, zernike",
        CHOICE(background_names)),

    KEY("solver", "binning", rig.binning, "averages n x n pixels", INTEGER(1, 64)),
    KEY("solver", "boundary", rig.boundary, "beyond the frame: mirror, periodic", CHOICE(boundary_names)),
    KEY("solver", "method", rig.method, "direct; apertures, uneven light: iterative-dct, us-tie", CHOICE(method_names)),
    KEY("solver", "iterations", rig.max_iterations, "at most, where the method iterates", INTEGER(1, 100000)),
    KEY("solver", "cutoff", rig.cutoff_m, "period above which structures are damped; 0 = off, auto, l-curve",
        OWN(cutoff_type)),
    KEY("solver", "zero_border", rig.zero_border, "the median at the frame's border is 0", BOOLEAN),

    KEY("flow", "polarity", polarity, "sign of the flow's phase: positive, negative (hot gas), auto",
        CHOICE(polarity_names)),
    KEY("flow", "still", rig.still, "region without flow, pixels of the phase: its mean is 0", OWN(rect_type),
        .example = "0,0,200,40"),
};
/* clang-format on */
const size_t ptie_rig_key_count = sizeof ptie_rig_keys / sizeof *ptie_rig_keys;

void ptie_rig_defaults(ptie_rig *rig) {
    *rig = (ptie_rig){.struct_size = sizeof *rig, .wavelength_m = 532e-9, .demosaic = PTIE_DEMOSAIC_BILINEAR,
                      .flat_field = true, .match_gain = true, .boundary = PTIE_MIRROR, .max_iterations = 100,
                      .binning = 1,
                      .zero_border = true};
    for (int i = 0; i < PTIE_ROLES; i++)
        rig->plane[i] = (ptie_plane){.defocus_m = 10e-3 * ptie_plane_steps[i], .gain = 1, .magnification = 1};
    rig->plane[PTIE_PLUS].used = rig->plane[PTIE_MINUS].used = true;
}

void ptie_rig_file_defaults(ptie_rig_file *file) {
    static const double none = (double)NAN;
    *file = (ptie_rig_file){.pitch_m = 20e-6, .magnification = 1, .defocus_m = 10e-3, .polarity = 1};
    ptie_rig_defaults(&file->rig);
    for (int i = 0; i < PTIE_ROLES; i++) file->plane[i] = (ptie_plane_keys){none, none, none, none, none, none};
}
