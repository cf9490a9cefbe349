/* SPDX-License-Identifier: BSD-3-Clause */
/* MATLAB's level 5 MAT files (v5, v6, and v7 with its deflated variables): a numeric array [H, W]
 * or [H, W, T]. Not by libmatio: it inflates a variable from its beginning for every part that is
 * asked for. */
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "io/endian.h"
#include "io/input.h"
#include "io/mat_source.h"
#include "io/reader.h"
#include "io/sample.h"
#include "io/transpose.h"

enum {
    HEADER_BYTES = 128,
    BLOCK = 4096,
    MATRIX = 14,
    COMPRESSED = 15,
    MOST_DIMS = 8,
    NAME_BYTES = 64
};
enum { CLASS_DOUBLE = 6, CLASS_UINT64 = 15, COMPLEX = 0x0800 };
#define DENSEST 1032 /* bytes that one deflated byte can stand for */

typedef struct variable {
    char name[NAME_BYTES];
    bool numeric; /* real numbers of at most three dimensions */
    uint64_t height, width, frames;
    ptie_sample sample;
    uint64_t data, data_bytes; /* in the element */
} variable;

typedef struct mat {
    FILE *stream;
    char *path;
    uint64_t file_bytes;
    bool swapped; /* in the other byte order */
    ptie_mat_source source;
    variable chosen;
    float *columns; /* one frame as stored */
} mat;

static bool mat_probe(const unsigned char *head) {
    if (memcmp(head, "MATLAB", 6) != 0) return false;
    return memcmp(head + 124, "\0\1IM", 4) == 0 || memcmp(head + 124, "\1\0MI", 4) == 0;
}

static void mat_close(void *state) {
    mat *file = state;
    if (!file) return;
    ptie_mat_source_close(&file->source);
    if (file->stream) fclose(file->stream);
    ptie_free(file->columns);
    ptie_free(file->path);
    ptie_free(file);
}

/* --- elements --------------------------------------------------------------------------------- */

typedef struct element {
    uint32_t type, bytes;
    uint64_t data, next; /* positions in the source */
} element;

static uint32_t word(const mat *file, const unsigned char *bytes) {
    uint32_t value = (uint32_t)ptie_get_le(bytes, 4);
    return file->swapped == ptie_machine_is_little() ? __builtin_bswap32(value) : value;
}

/* Up to four bytes of data fit into the tag itself. */
static element parse_tag(const mat *file, const unsigned char tag[8], uint64_t at) {
    const uint32_t first = word(file, tag), second = word(file, tag + 4);
    if (first >> 16) return (element){first & 0xffff, first >> 16, at + 4, at + 8};
    return (element){first, second, at + 8, at + 8 + ((uint64_t)second + 7) / 8 * 8};
}

static ptie_status read_element(mat *file, uint64_t at, element *out) {
    unsigned char tag[8];
    PTIE_TRY(ptie_mat_source_read(&file->source, at, tag, sizeof tag));
    *out = parse_tag(file, tag, at);
    return PTIE_OK;
}

static ptie_sample sample_of(uint32_t type) {
    static const ptie_sample samples[] = {
        [1] = {'i', 1}, [2] = {'u', 1}, [3] = {'i', 2}, [4] = {'u', 2},  [5] = {'i', 4},
        [6] = {'u', 4}, [7] = {'f', 4}, [9] = {'f', 8}, [12] = {'i', 8}, [13] = {'u', 8}};
    return type < sizeof samples / sizeof *samples ? samples[type] : (ptie_sample){0};
}

/* Dimensions beyond the third must be 1. */
static ptie_status read_dims(mat *file, const element *dims, variable *v) {
    unsigned char bytes[4 * MOST_DIMS];
    uint64_t size[MOST_DIMS] = {1, 1, 1};
    const size_t count = dims->bytes / 4;
    v->numeric = v->numeric && count >= 2 && count <= MOST_DIMS;
    if (!v->numeric) return PTIE_OK;
    PTIE_TRY(ptie_mat_source_read(&file->source, dims->data, bytes, 4 * count));
    for (size_t d = 0; d < count; d++) size[d] = word(file, bytes + 4 * d);
    for (size_t d = 3; d < count; d++) v->numeric = v->numeric && size[d] == 1;
    v->height = size[0];
    v->width = size[1];
    v->frames = size[2];
    return PTIE_OK;
}

static ptie_status read_name(mat *file, const element *name, variable *v) {
    const size_t length = name->bytes < NAME_BYTES - 1 ? name->bytes : NAME_BYTES - 1;
    return ptie_mat_source_read(&file->source, name->data, v->name, length);
}

/* The header of the matrix that the source begins with: flags, dimensions, name, and where its
 * numbers are. */
static ptie_status read_variable(mat *file, variable *v) {
    unsigned char flags[4];
    element matrix, part, dims;
    *v = (variable){0};
    PTIE_TRY(read_element(file, 0, &matrix));
    if (matrix.type != MATRIX) return PTIE_OK;
    PTIE_TRY(read_element(file, matrix.data, &part));
    PTIE_TRY(ptie_mat_source_read(&file->source, part.data, flags, sizeof flags));
    const uint32_t flag = word(file, flags), class = flag & 0xff;
    v->numeric = class >= CLASS_DOUBLE && class <= CLASS_UINT64 && !(flag & COMPLEX);
    PTIE_TRY(read_element(file, part.next, &dims));
    PTIE_TRY(read_dims(file, &dims, v));
    PTIE_TRY(read_element(file, dims.next, &part));
    PTIE_TRY(read_name(file, &part, v));
    if (!v->numeric) return PTIE_OK;
    PTIE_TRY(read_element(file, part.next, &part));
    v->sample = sample_of(part.type);
    v->data = part.data;
    v->data_bytes = part.bytes;
    v->numeric = ptie_sample_known(v->sample);
    return PTIE_OK;
}

/* --- which variable --------------------------------------------------------------------------- */

/* Opens the element at `at` of the file; *next is where the one behind it begins. */
static ptie_status open_element(mat *file, uint64_t at, uint64_t *next) {
    unsigned char tag[8];
    ptie_mat_source_close(&file->source);
    PTIE_TRY(ptie_mat_source_open(&file->source, file->stream, file->path, at,
                                  file->file_bytes - at, false));
    PTIE_TRY(ptie_mat_source_read(&file->source, 0, tag, sizeof tag));
    const element e = parse_tag(file, tag, 0);
    if (e.bytes > file->file_bytes - at - e.data)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: file is cut short (a variable needs %u bytes at %llu)",
                         file->path, e.bytes, (unsigned long long)at);
    const bool deflated = e.type == COMPRESSED;
    const uint64_t start = deflated ? at + e.data : at, end = at + e.data + e.bytes;
    *next = deflated ? end : at + e.next;
    return ptie_mat_source_open(&file->source, file->stream, file->path, start, end - start,
                                deflated);
}

/* Looks for `name`, or without one for the images: matrices that are no vectors.  Leaves the last
   found in `chosen`, its element in *found, and their names in `names`. */
static ptie_status search(mat *file, const char *name, uint64_t *found, size_t *count,
                          ptie_text *names) {
    uint64_t next;
    for (uint64_t at = HEADER_BYTES; at + 8 <= file->file_bytes; at = next) {
        variable v;
        PTIE_TRY(open_element(file, at, &next));
        PTIE_TRY(read_variable(file, &v));
        if (*name ? strcmp(v.name, name) != 0 : !v.numeric || v.width < 2 || v.height < 2) continue;
        ptie_text_append(names, "%s%s", *count ? ", /" : "/", v.name);
        file->chosen = v;
        *found = at;
        ++*count;
        if (*name) break;
    }
    return names->failed ? PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", file->path) : PTIE_OK;
}

static ptie_status choose_variable(mat *file, const char *name, uint64_t *found) {
    ptie_text names = {0};
    size_t count = 0;
    ptie_status status = search(file, name, found, &count, &names);
    if (status == PTIE_OK && count == 0)
        status = *name ? PTIE_FAIL(PTIE_EFORMAT, "%s: no variable '%s'", file->path, name)
                       : PTIE_FAIL(PTIE_EFORMAT, "%s: no numeric array of 2 or 3 dimensions",
                                   file->path);
    else if (status == PTIE_OK && count > 1)
        status = PTIE_FAIL(PTIE_EFORMAT, "%s: several variables (expected %s:/NAME, found %s)",
                           file->path, file->path, names.data);
    ptie_text_free(&names);
    return status;
}

/* --- the reader ------------------------------------------------------------------------------- */

static ptie_status take_shape(mat *file, ptie_recording_info *info) {
    const variable *v = &file->chosen;
    if (!v->numeric)
        return PTIE_FAIL(PTIE_EUNSUPPORTED,
                         "%s: /%s is no array of real numbers with 2 or 3 dimensions", file->path,
                         v->name);
    PTIE_TRY(ptie_info_set_size(info, file->path, v->width, v->height));
    if (v->frames < 1) return PTIE_FAIL(PTIE_EFORMAT, "%s: /%s has no frames", file->path, v->name);
    const uint64_t frame_bytes = v->width * v->height * v->sample.bytes;
    if (v->frames > v->data_bytes / frame_bytes)
        return PTIE_FAIL(
            PTIE_EFORMAT,
            "%s: /%s is cut short (expected %llu frames of %llu bytes, found %llu bytes)",
            file->path, v->name, (unsigned long long)v->frames, (unsigned long long)frame_bytes,
            (unsigned long long)v->data_bytes);
    PTIE_TRY(ptie_check_fits(file->path, v->data_bytes, file->file_bytes,
                             file->source.deflated ? DENSEST : 1));
    info->frames = (int64_t)v->frames;
    ptie_sample_name(info->sample, v->sample);
    snprintf(info->dataset, sizeof info->dataset, "/%s", v->name);
    return PTIE_OK;
}

static ptie_status mat_load(mat *file, ptie_recording_info *info, const char *path,
                            const char *inside) {
    unsigned char head[HEADER_BYTES];
    uint64_t at = 0, next;
    file->path = ptie_strdup(path);
    if (!file->path) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", path);
    PTIE_TRY(ptie_input_open(&file->stream, path, &file->file_bytes));
    PTIE_TRY(ptie_input_head(path, head, sizeof head));
    file->swapped = (head[126] == 'I') != ptie_machine_is_little();
    PTIE_TRY(choose_variable(file, *inside ? inside + 1 : inside, &at));
    PTIE_TRY(open_element(file, at, &next));
    PTIE_TRY(take_shape(file, info));
    return ptie_alloc_status(&file->columns, file->chosen.width * file->chosen.height,
                             sizeof *file->columns, path);
}

static ptie_status mat_open(void **state, ptie_recording_info *info, const char *path,
                            const char *inside) {
    mat *file;
    PTIE_TRY(ptie_alloc_status(&file, 1, sizeof *file, path));
    const ptie_status status = mat_load(file, info, path, inside);
    if (status != PTIE_OK) {
        mat_close(file);
        file = NULL;
    }
    *state = file;
    return status;
}

static ptie_status mat_read(void *state, int64_t frame, float *data) {
    mat *file = state;
    const variable *v = &file->chosen;
    unsigned char block[BLOCK * PTIE_SAMPLE_BYTES];
    const size_t count = (size_t)(v->width * v->height), size = v->sample.bytes;
    uint64_t at = v->data + (uint64_t)frame * count * size;
    for (size_t done = 0; done < count; done += BLOCK, at += BLOCK * size) {
        const size_t now = count - done < BLOCK ? count - done : BLOCK;
        PTIE_TRY(ptie_mat_source_read(&file->source, at, block, now * size));
        if (file->swapped) ptie_sample_swap(block, now, v->sample);
        ptie_sample_convert(file->columns + done, block, now, v->sample);
    }
    ptie_transpose(data, file->columns, (size_t)v->height, (size_t)v->width);
    return PTIE_OK;
}

const ptie_reader ptie_read_mat = {.name = "MAT",
                                   .probe = mat_probe,
                                   .open = mat_open,
                                   .read = mat_read,
                                   .close = mat_close,
                                   .has_data_sets = true,
                                   .takes_inside = true};
