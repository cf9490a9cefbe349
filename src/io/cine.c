/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/cine.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "io/clean.h"
#include "io/endian.h"

enum { FILE_HEADER_BYTES = 44, IMAGE_HEADER_BYTES = 40, MARK_AT = 140, LENGTH_AT = 142 };
enum { MOST_BLOCKS = 64, BLOCK_TIMES = 1002 };

/* The part of SETUP that the file has. */
typedef struct setup {
    unsigned char bytes[65536]; /* its length is a 16-bit number */
    size_t length;
} setup;

bool ptie_cine_probe(const unsigned char *head) {
    return head[0] == 'C' && head[1] == 'I' && ptie_get_le(head + 2, 2) == FILE_HEADER_BYTES &&
           ptie_get_le(head + 6, 2) <= 1;
}

static bool read_at(FILE *stream, uint64_t at, void *bytes, size_t count) {
    return at <= INT64_MAX && fseeko(stream, (off_t)at, SEEK_SET) == 0 &&
           fread(bytes, 1, count, stream) == count;
}

static int64_t signed_32(const unsigned char *bytes) {
    return (int32_t)(uint32_t)ptie_get_le(bytes, 4);
}

/* --- SETUP: fields beyond its length do not exist --------------------------------------------- */

static bool has(const setup *s, size_t offset, size_t bytes) {
    return offset + bytes <= s->length;
}

static uint64_t field(const setup *s, size_t offset, size_t bytes) {
    return has(s, offset, bytes) ? ptie_get_le(s->bytes + offset, bytes) : 0;
}

static double double_field(const setup *s, size_t offset) {
    const uint64_t bits = field(s, offset, 8);
    double value;
    memcpy(&value, &bits, sizeof value);
    return isfinite(value) && value > 0 ? value : 0;
}

static void text_field(char *out, size_t capacity, const setup *s, size_t offset, size_t bytes) {
    if (has(s, offset, bytes))
        ptie_clean_copy(out, capacity, (const char *)s->bytes + offset, bytes);
}

/* The first field is the oldest; later ones replace what had become too small. */
static double rate_of(const setup *s) {
    const double precise = double_field(s, 13472);
    if (precise > 0) return precise;
    return has(s, 768, 4) ? (double)field(s, 768, 4) : (double)field(s, 0, 2);
}

static double exposure_of(const setup *s) {
    if (field(s, 1568, 4) > 0) return (double)field(s, 1568, 4) / 1e9;
    return (double)(has(s, 772, 4) ? field(s, 772, 4) : field(s, 2, 2)) / 1e6;
}

static void take_setup(ptie_cine *cine, const setup *s) {
    cine->flip_vertical = field(s, 760, 4) != 0;
    cine->real_bits = (int64_t)field(s, 896, 4);
    cine->has_levels = has(s, 5736, 4);
    cine->black_level = (int32_t)(uint32_t)field(s, 5732, 4);
    cine->white_level = (int32_t)(uint32_t)field(s, 5736, 4);
    cine->nominal_rate_hz = rate_of(s);
    cine->exposure_s = exposure_of(s);
    cine->serial = (int64_t)field(s, 743, 4);
    cine->camera_version = (int64_t)field(s, 792, 4);
    text_field(cine->model, sizeof cine->model, s, 12432, 256);
    text_field(cine->description, sizeof cine->description, s, 1596, 4096);
}

static ptie_status read_setup(ptie_cine *cine, FILE *stream, uint64_t at, uint64_t *end,
                              const char *path) {
    setup *s;
    PTIE_TRY(ptie_alloc_status(&s, 1, sizeof *s, path));
    const bool marked =
        read_at(stream, at, s->bytes, LENGTH_AT + 2) && memcmp(s->bytes + MARK_AT, "ST", 2) == 0;
    const size_t length = marked ? (size_t)ptie_get_le(s->bytes + LENGTH_AT, 2) : 0;
    if (marked && length > LENGTH_AT && read_at(stream, at, s->bytes, length)) s->length = length;
    if (s->length > 0) take_setup(cine, s);
    *end = at + s->length;
    const bool found = s->length > 0;
    ptie_free(s);
    return found ? PTIE_OK
                 : PTIE_FAIL(PTIE_EFORMAT, "%s: damaged CINE: no SETUP block, or cut", path);
}

/* --- time stamps ------------------------------------------------------------------------------ */

/* Seconds after `origin_s`, from a fraction of 32 bits (its last two are flags) and Unix seconds.
 */
static double time_of(const unsigned char *stamp, uint64_t origin_s) {
    const double fraction = (double)(ptie_get_le(stamp, 4) & ~3ull) / 4294967296.0;
    return (double)((int64_t)ptie_get_le(stamp + 4, 4) - (int64_t)origin_s) + fraction;
}

/* Rate from the first and the last of the stamps at `at`; 0 if they say none. */
static double rate_from_stamps(const ptie_cine *cine, FILE *stream, uint64_t at, uint64_t count) {
    unsigned char first[8], last[8];
    const uint64_t intervals = (uint64_t)cine->images - 1;
    if (intervals < 1 || count <= intervals) return 0;
    if (!read_at(stream, at, first, 8) || !read_at(stream, at + 8 * intervals, last, 8)) return 0;
    const uint64_t origin_s = ptie_get_le(first + 4, 4);
    const double duration_s = time_of(last, origin_s) - time_of(first, origin_s);
    return duration_s > 0 ? (double)intervals / duration_s : 0;
}

/* Blocks of {bytes, type} lie between SETUP and the offsets. */
static void find_stamps(ptie_cine *cine, FILE *stream, uint64_t at) {
    unsigned char tag[8];
    for (int block = 0; block < MOST_BLOCKS && at + 8 <= cine->offsets_at; block++) {
        if (!read_at(stream, at, tag, 8)) return;
        const uint64_t bytes = ptie_get_le(tag, 4);
        if (bytes < 8 || bytes > cine->offsets_at - at) return;
        if (ptie_get_le(tag + 4, 2) == BLOCK_TIMES)
            cine->true_rate_hz = rate_from_stamps(cine, stream, at + 8, (bytes - 8) / 8);
        at += bytes;
    }
}

/* --- the whole -------------------------------------------------------------------------------- */

static void take_image_header(ptie_cine *cine, const unsigned char *image) {
    cine->width = signed_32(image + 4);
    cine->height = signed_32(image + 8);
    cine->bits_per_pixel = (int)ptie_get_le(image + 14, 2);
    cine->packing = (int)signed_32(image + 16);
    cine->pixels_per_metre = signed_32(image + 24);
}

ptie_status ptie_cine_read(ptie_cine *cine, FILE *stream, uint64_t file_bytes, const char *path) {
    unsigned char head[FILE_HEADER_BYTES], image[IMAGE_HEADER_BYTES];
    uint64_t setup_end;
    *cine = (ptie_cine){0};
    if (!read_at(stream, 0, head, sizeof head) ||
        !read_at(stream, ptie_get_le(head + 24, 4), image, sizeof image))
        return PTIE_FAIL(PTIE_EFORMAT, "%s: damaged CINE: headers are cut short", path);
    cine->compression = (int)ptie_get_le(head + 4, 2);
    cine->first_image = signed_32(head + 16);
    cine->images = (int64_t)ptie_get_le(head + 20, 4);
    cine->offsets_at = ptie_get_le(head + 32, 4);
    cine->trigger_s = ptie_get_le(head + 40, 4);
    take_image_header(cine, image);
    PTIE_TRY(read_setup(cine, stream, ptie_get_le(head + 28, 4), &setup_end, path));
    if (cine->images < 1 || cine->offsets_at > file_bytes ||
        (uint64_t)cine->images > (file_bytes - cine->offsets_at) / 8)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: damaged CINE: no room for the offsets of %lld images",
                         path, (long long)cine->images);
    find_stamps(cine, stream, setup_end);
    return PTIE_OK;
}
