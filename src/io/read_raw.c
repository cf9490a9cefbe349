/* SPDX-License-Identifier: BSD-3-Clause */
/* Raw frames with a JSON file beside them that says how they lie: "jet.raw" and "jet.json". */
#include <jansson.h>
#include <limits.h>
#include <math.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "io/clean.h"
#include "io/endian.h"
#include "io/input.h"
#include "io/raster.h"
#include "io/reader.h"

#define LARGEST_SIDECAR 65536 /* bytes */
#define FARTHEST (INT64_MAX / 4)

typedef struct raw {
    FILE *stream;
    char *path;
    char sidecar[PATH_MAX];
    ptie_raster raster;
    uint64_t offset, stride; /* of the first frame, and from frame to frame */
} raw;

static bool raw_claims(const char *path) {
    static const char *const endings[] = {".raw", ".bin", ".f32", ".u16", ".u8"};
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < sizeof endings / sizeof *endings; i++)
        if (strcasecmp(dot, endings[i]) == 0) return true;
    return false;
}

static void raw_close(void *state) {
    raw *file = state;
    if (!file) return;
    if (file->stream) fclose(file->stream);
    ptie_free(file->path);
    ptie_free(file);
}

/* --- the sidecar ------------------------------------------------------------------------------ */

static ptie_status refuse(const raw *file, const char *key, const char *expected) {
    return PTIE_FAIL(PTIE_EFORMAT, "%s: \"%s\" (expected %s)", file->sidecar, key, expected);
}

/* A whole number low .. high; stays as it is where the key is missing. */
static ptie_status take_integer(const raw *file, const json_t *object, const char *key, int64_t low,
                                int64_t high, int64_t *value) {
    char expected[80];
    const json_t *found = json_object_get(object, key);
    if (!found) return PTIE_OK;
    *value = json_integer_value(found);
    if (json_is_integer(found) && *value >= low && *value <= high) return PTIE_OK;
    snprintf(expected, sizeof expected, "a whole number of %lld .. %lld", (long long)low,
             (long long)high);
    return refuse(file, key, expected);
}

/* "25 kHz" */
static ptie_status take_quantity(const raw *file, const json_t *object, const char *key,
                                 ptie_quantity quantity, double *value) {
    const json_t *found = json_object_get(object, key);
    if (!found) return PTIE_OK;
    const char *text = json_string_value(found);
    const char *expected =
        text ? ptie_parse_quantity(text, quantity, value) : "text with a number and its unit";
    return !expected && *value >= 0 && isfinite(*value)
               ? PTIE_OK
               : refuse(file, key, expected ? expected : "no negative value");
}

static void take_text(const json_t *object, const char *key, char *out, size_t bytes) {
    const char *text = json_string_value(json_object_get(object, key));
    if (text) ptie_clean_copy(out, bytes, text, strlen(text));
}

/* "u16": little-endian; "u16be"; "u10", "u12": packed. */
static ptie_status take_sample(raw *file, ptie_recording_info *info, const json_t *object) {
    static const char known[] =
        "u8 i8 u16 i16 u32 i32 u64 i64 f32 f64, with be for big-endian, or u10 u12 packed";
    const char *text = json_string_value(json_object_get(object, "sample"));
    int64_t bits;
    char digits[4] = "";
    if (!text || !strchr("uif", text[0])) return refuse(file, "sample", known);
    const size_t count = strspn(text + 1, "0123456789");
    const bool big = strcmp(text + 1 + count, "be") == 0;
    snprintf(digits, sizeof digits, "%.*s", (int)count, text + 1);
    if (count > 2 || (text[1 + count] && !big) || !ptie_parse_integer(digits, 1, 64, &bits))
        return refuse(file, "sample", known);
    const bool packed = text[0] == 'u' && !big && (bits == 10 || bits == 12);
    file->raster.packed_bits = packed ? (int)bits : 0;
    file->raster.sample = (ptie_sample){text[0], packed ? 2 : bits % 8 == 0 ? (size_t)bits / 8 : 0};
    if (!ptie_sample_known(file->raster.sample)) return refuse(file, "sample", known);
    file->raster.swapped = bits > 8 && big == ptie_machine_is_little();
    snprintf(info->sample, sizeof info->sample, "%c%d%s", text[0], (int)bits,
             packed ? " packed" : "");
    return PTIE_OK;
}

static ptie_status take_layout(raw *file, ptie_recording_info *info, const json_t *object) {
    int64_t width = 0, height = 0, offset = 0, stride = 0, row = 0;
    PTIE_TRY(take_sample(file, info, object));
    PTIE_TRY(take_integer(file, object, "width", 1, PTIE_LONGEST_SIDE, &width));
    PTIE_TRY(take_integer(file, object, "height", 1, PTIE_LONGEST_SIDE, &height));
    PTIE_TRY(ptie_info_set_size(info, file->sidecar, (uint64_t)width, (uint64_t)height));
    file->raster.width = info->width_px;
    file->raster.height = 1;
    const int64_t shortest = (int64_t)ptie_raster_bytes(&file->raster);
    PTIE_TRY(take_integer(file, object, "row", shortest, 1 << 25, &row));
    file->raster.height = info->height_px;
    file->raster.row_bytes = (uint64_t)row;
    const int64_t frame_bytes = (int64_t)ptie_raster_bytes(&file->raster);
    PTIE_TRY(take_integer(file, object, "offset", 0, FARTHEST, &offset));
    PTIE_TRY(take_integer(file, object, "stride", frame_bytes, FARTHEST, &stride));
    file->offset = (uint64_t)offset;
    file->stride = (uint64_t)(stride > 0 ? stride : frame_bytes);
    file->raster.bottom_up = info->bottom_up = json_is_true(json_object_get(object, "bottom_up"));
    return PTIE_OK;
}

static ptie_status take_facts(const raw *file, ptie_recording_info *info, const json_t *object) {
    int64_t depth = 0;
    PTIE_TRY(take_quantity(file, object, "frame_rate", PTIE_RATE, &info->frame_rate_hz));
    PTIE_TRY(take_quantity(file, object, "pixel", PTIE_LENGTH, &info->pixel_m));
    PTIE_TRY(take_quantity(file, object, "exposure", PTIE_TIME, &info->exposure_s));
    PTIE_TRY(take_integer(file, object, "bit_depth", 1, 64, &depth));
    info->bit_depth = (int32_t)depth;
    take_text(object, "unit", info->unit, sizeof info->unit);
    take_text(object, "camera", info->camera, sizeof info->camera);
    take_text(object, "comment", info->comment, sizeof info->comment);
    return PTIE_OK;
}

/* Names nobody knows are mistakes. */
static ptie_status check_keys(const raw *file, json_t *object) {
    static const char *const keys[] = {
        "width",      "height", "sample",   "offset",    "stride", "row",    "frames",  "bottom_up",
        "frame_rate", "pixel",  "exposure", "bit_depth", "unit",   "camera", "comment", NULL};
    const char *key;
    json_t *value;
    json_object_foreach(object, key, value) {
        const char *const *known = keys;
        while (*known && strcmp(*known, key) != 0) known++;
        if (!*known)
            return PTIE_FAIL(PTIE_EFORMAT, "%s: unknown key \"%s\" (did you mean \"%s\"?)",
                             file->sidecar, key, ptie_nearest_word(key, keys));
    }
    return PTIE_OK;
}

/* `frames`: announced by the sidecar, 0 if it does not say. */
static ptie_status read_sidecar(raw *file, ptie_recording_info *info, int64_t *frames) {
    json_error_t error;
    char *text;
    size_t bytes;
    PTIE_TRY(ptie_read_file(&text, &bytes, file->sidecar, LARGEST_SIDECAR));
    json_t *object = json_loadb(text, bytes, JSON_REJECT_DUPLICATES, &error);
    ptie_free(text);
    if (!object)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: not JSON (line %d): %s", file->sidecar, error.line,
                         error.text);
    ptie_status status = json_is_object(object)
                             ? check_keys(file, object)
                             : PTIE_FAIL(PTIE_EFORMAT, "%s: not a JSON object", file->sidecar);
    if (status == PTIE_OK) status = take_layout(file, info, object);
    if (status == PTIE_OK) status = take_facts(file, info, object);
    if (status == PTIE_OK) status = take_integer(file, object, "frames", 1, FARTHEST, frames);
    json_decref(object);
    return status;
}

/* --- the reader ------------------------------------------------------------------------------- */

static ptie_status count_frames(const raw *file, ptie_recording_info *info, uint64_t file_bytes,
                                int64_t announced) {
    const uint64_t frame_bytes = ptie_raster_bytes(&file->raster);
    if (file_bytes < file->offset || file_bytes - file->offset < frame_bytes)
        return PTIE_FAIL(
            PTIE_EFORMAT,
            "%s: file too short for a frame (expected %llu bytes behind %llu, found %llu in all)",
            file->path, (unsigned long long)frame_bytes, (unsigned long long)file->offset,
            (unsigned long long)file_bytes);
    const int64_t there = 1 + (int64_t)((file_bytes - file->offset - frame_bytes) / file->stride);
    ptie_info_set_frames(info, there, announced > 0 ? announced : there);
    if (announced == 0 && (file_bytes - file->offset - frame_bytes) % file->stride != 0)
        snprintf(info->warning, sizeof info->warning, "bytes are left over behind the last frame");
    return PTIE_OK;
}

static ptie_status raw_load(raw *file, ptie_recording_info *info, const char *path) {
    uint64_t file_bytes;
    int64_t announced = 0;
    file->path = ptie_strdup(path);
    if (!file->path) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", path);
    PTIE_TRY(ptie_input_open(&file->stream, path, &file_bytes));
    const int length =
        snprintf(file->sidecar, PATH_MAX, "%.*s.json", (int)(strrchr(path, '.') - path), path);
    if (length < 0 || length >= PATH_MAX || access(file->sidecar, F_OK) != 0)
        return PTIE_FAIL(PTIE_EIO, "%s: raw frames need a description (expected %s beside them)",
                         path, file->sidecar);
    PTIE_TRY(read_sidecar(file, info, &announced));
    return count_frames(file, info, file_bytes, announced);
}

static ptie_status raw_open(void **state, ptie_recording_info *info, const char *path,
                            const char *inside) {
    (void)inside;
    raw *file;
    PTIE_TRY(ptie_alloc_status(&file, 1, sizeof *file, path));
    const ptie_status status = raw_load(file, info, path);
    if (status != PTIE_OK) {
        raw_close(file);
        file = NULL;
    }
    *state = file;
    return status;
}

static ptie_status raw_read(void *state, int64_t frame, float *data) {
    const raw *file = state;
    const uint64_t at = file->offset + (uint64_t)frame * file->stride;
    return ptie_raster_read(&file->raster, file->stream, at, data, file->path, frame);
}

const ptie_reader ptie_read_raw = {
    .name = "raw", .claims = raw_claims, .open = raw_open, .read = raw_read, .close = raw_close};
