/* SPDX-License-Identifier: BSD-3-Clause */
/* NumPy's .npy, versions 1 to 3: (H, W) is one frame, (T, H, W) are T. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "io/endian.h"
#include "io/input.h"
#include "io/reader.h"
#include "io/raster.h"

#define MAGIC "\x93NUMPY"
#define HEADER_LIMIT 65536 /* bytes; NumPy itself writes 118 */

typedef struct npy {
    FILE *stream;
    char *path;
    uint64_t start; /* of the data in the file */
    ptie_raster raster;
} npy;

static bool npy_probe(const unsigned char *head) {
    return memcmp(head, MAGIC, 6) == 0;
}

static void npy_close(void *state) {
    npy *file = state;
    if (!file) return;
    if (file->stream) fclose(file->stream);
    ptie_free(file->path);
    ptie_free(file);
}

/* What follows "'key':" in the header, or NULL. */
static const char *value_of(const char *header, const char *key) {
    const char *found = strstr(header, key);
    if (!found) return NULL;
    found += strlen(key);
    found += strspn(found, "'\" ");
    if (*found != ':') return NULL;
    return found + 1 + strspn(found + 1, " ");
}

static ptie_status parse_type(npy *file, const char *header) {
    const char *text = value_of(header, "descr");
    if (!text) return PTIE_FAIL(PTIE_EFORMAT, "%s: NPY header without 'descr'", file->path);
    /* A quote, byte order, kind, size, and the quote again: '<f4' */
    bool simple =
        strlen(text) > 4 && strchr("'\"", text[0]) && strchr("<>|", text[1]) && text[4] == text[0];
    if (simple) file->raster.sample = (ptie_sample){text[2], (size_t)(text[3] - '0')};
    if (!ptie_sample_known(file->raster.sample))
        return PTIE_FAIL(PTIE_EUNSUPPORTED,
                         "%s: sample type not read (expected integers or f4, f8, found %.*s)",
                         file->path, (int)strcspn(text, ","), text);
    file->raster.swapped = file->raster.sample.bytes > 1 && (text[1] == '<') != ptie_machine_is_little();
    return PTIE_OK;
}

/* Sizes in "(3, 4, 5)"; -1 if it is nothing like that. */
static int parse_shape(const char *text, uint64_t shape[4]) {
    int rank = 0;
    if (!text || *text++ != '(') return -1;
    for (text += strspn(text, " "); *text && *text != ')'; text += strspn(text, ", ")) {
        char *end;
        if (*text < '0' || *text > '9' || rank == 4) return -1;
        errno = 0;
        shape[rank++] = strtoull(text, &end, 10);
        if (errno) return -1;
        text = end;
    }
    return *text == ')' ? rank : -1;
}

static ptie_status parse_header(npy *file, ptie_recording_info *info, const char *header) {
    uint64_t shape[4] = {0};
    PTIE_TRY(parse_type(file, header));
    const char *order = value_of(header, "fortran_order");
    if (!order)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: NPY header without 'fortran_order'", file->path);
    if (strncmp(order, "False", 5) != 0)
        return PTIE_FAIL(PTIE_EUNSUPPORTED,
                         "%s: array in Fortran order (save it with numpy.ascontiguousarray)",
                         file->path);
    int rank = parse_shape(value_of(header, "shape"), shape);
    if (rank < 0)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: NPY header without a valid 'shape'", file->path);
    if (rank != 2 && rank != 3)
        return PTIE_FAIL(PTIE_EUNSUPPORTED, "%s: array has %d dimensions (expected 2 or 3)",
                         file->path, rank);
    PTIE_TRY(ptie_info_set_size(info, file->path, shape[rank - 1], shape[rank - 2]));
    uint64_t frames = rank == 3 ? shape[0] : 1;
    if (frames < 1 || frames > INT64_MAX)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: array has no valid number of frames (found %llu)",
                         file->path, (unsigned long long)frames);
    info->frames = (int64_t)frames;
    ptie_sample_name(info->sample, file->raster.sample);
    file->raster.width = info->width_px;
    file->raster.height = info->height_px;
    return PTIE_OK;
}

/* Reads the header's text (NUL-terminated, freed by the caller). */
static ptie_status read_header(npy *file, char **header) {
    unsigned char lead[12]; /* magic, version, length of two or four bytes */
    *header = NULL;
    size_t lead_bytes = fread(lead, 1, 8, file->stream) == 8 && lead[6] > 1 ? 12 : 10;
    if (fread(lead + 8, 1, lead_bytes - 8, file->stream) != lead_bytes - 8)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: NPY header is cut short", file->path);
    if (lead[6] < 1 || lead[6] > 3)
        return PTIE_FAIL(PTIE_EUNSUPPORTED, "%s: NPY version not read (expected 1 to 3, found %d)",
                         file->path, lead[6]);
    uint64_t bytes = ptie_get_le(lead + 8, lead_bytes - 8);
    if (bytes > HEADER_LIMIT)
        return PTIE_FAIL(PTIE_EFORMAT,
                         "%s: NPY header too long (expected at most %d bytes, found %llu)",
                         file->path, HEADER_LIMIT, (unsigned long long)bytes);
    PTIE_TRY(ptie_alloc_status(header, (size_t)bytes + 1, 1, file->path));
    if (fread(*header, 1, (size_t)bytes, file->stream) != (size_t)bytes)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: NPY header is cut short", file->path);
    file->start = lead_bytes + bytes;
    return PTIE_OK;
}

static ptie_status npy_load(npy *file, ptie_recording_info *info, const char *path) {
    uint64_t file_bytes;
    char *header;
    file->path = ptie_strdup(path);
    if (!file->path) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", path);
    PTIE_TRY(ptie_input_open(&file->stream, path, &file_bytes));
    ptie_status status = read_header(file, &header);
    if (status == PTIE_OK) status = parse_header(file, info, header);
    ptie_free(header);
    PTIE_TRY(status);
    uint64_t frame_bytes = ptie_raster_bytes(&file->raster);
    uint64_t frames_there = (file_bytes - file->start) / frame_bytes;
    if ((uint64_t)info->frames > frames_there)
        return PTIE_FAIL(PTIE_EFORMAT,
                         "%s: file is cut short (expected %lld frames of %llu bytes, found "
                         "%llu)",
                         path, (long long)info->frames, (unsigned long long)frame_bytes,
                         (unsigned long long)frames_there);
    return PTIE_OK;
}

static ptie_status npy_open(void **state, ptie_recording_info *info, const char *path,
                            const char *inside) {
    (void)inside;
    npy *file;
    PTIE_TRY(ptie_alloc_status(&file, 1, sizeof *file, path));
    ptie_status status = npy_load(file, info, path);
    if (status != PTIE_OK) {
        npy_close(file);
        file = NULL;
    }
    *state = file;
    return status;
}

static ptie_status npy_read(void *state, int64_t frame, float *data) {
    const npy *file = state;
    const uint64_t at = file->start + (uint64_t)frame * ptie_raster_bytes(&file->raster);
    return ptie_raster_read(&file->raster, file->stream, at, data, file->path, frame);
}

const ptie_reader ptie_read_npy = {
    .name = "NPY", .probe = npy_probe, .open = npy_open, .read = npy_read, .close = npy_close};
