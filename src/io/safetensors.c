/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/safetensors.h"

#include <assert.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "io/endian.h"
#include "io/input.h"
#include "io/stream.h"

#define LENGTH_BYTES 8
#define HEADER_LIMIT 100000000u /* of the format */
#define DATA_ALIGNMENT 8

struct ptie_safetensors {
    unsigned char *header; /* JSON text */
    json_t *json;          /* owns names, keys and values */
    float *data;
    ptie_tensor_view *tensors; /* in the order of their data */
    size_t tensor_count;
    ptie_note *notes;
    size_t note_count;
};

/* Number of elements; false if it does not fit into `limit`. */
static bool element_count(const int64_t *shape, int32_t rank, uint64_t limit, uint64_t *count) {
    *count = 1;
    for (int32_t d = 0; d < rank; d++) {
        if (shape[d] < 0) return false;
        if (shape[d] > 0 && *count > limit / (uint64_t)shape[d]) return false;
        *count *= (uint64_t)shape[d];
    }
    return *count <= limit;
}

/* --- writing -------------------------------------------------------------------------------------
 */

static uint64_t view_bytes(const ptie_tensor_view *tensor) {
    uint64_t count = 0;
    bool fits = element_count(tensor->shape, tensor->rank, UINT64_MAX / sizeof(float), &count);
    assert(fits);
    (void)fits;
    return count * sizeof(float);
}

static json_t *tensor_entry(const ptie_tensor_view *tensor, uint64_t begin) {
    json_t *shape = json_array();
    for (int32_t d = 0; d < tensor->rank; d++)
        json_array_append_new(shape, json_integer(tensor->shape[d]));
    return json_pack("{s:s, s:o, s:[I,I]}", "dtype", "F32", "shape", shape, "data_offsets",
                     (json_int_t)begin, (json_int_t)(begin + view_bytes(tensor)));
}

/* The header as JSON text, freed with free(); NULL when memory is short. */
static char *header_text(const ptie_tensor_view *tensors, size_t tensor_count,
                         const ptie_note *notes, size_t note_count) {
    json_t *header = json_object();
    json_t *metadata = json_object();
    bool failed = !header || !metadata;
    for (size_t i = 0; i < note_count && !failed; i++)
        failed = json_object_set_new(metadata, notes[i].key, json_string(notes[i].value)) != 0;
    if (note_count > 0 && !failed) failed = json_object_set(header, "__metadata__", metadata) != 0;
    uint64_t begin = 0;
    for (size_t i = 0; i < tensor_count && !failed; i++) {
        failed =
            json_object_set_new(header, tensors[i].name, tensor_entry(&tensors[i], begin)) != 0;
        begin += view_bytes(&tensors[i]);
    }
    char *text =
        failed ? NULL : json_dumps(header, JSON_COMPACT); /* keeps the order of insertion */
    json_decref(metadata);
    json_decref(header);
    return text;
}

static void write_content(FILE *stream, const char *header, const ptie_tensor_view *tensors,
                          size_t count) {
    size_t used = strlen(header);
    size_t padded = (used + DATA_ALIGNMENT - 1) / DATA_ALIGNMENT * DATA_ALIGNMENT;
    ptie_write_le(stream, padded, LENGTH_BYTES);
    fwrite(header, 1, used, stream);
    for (size_t i = used; i < padded; i++) fputc(' ', stream);
    for (size_t i = 0; i < count; i++)
        ptie_write_floats(stream, tensors[i].data, view_bytes(&tensors[i]) / sizeof(float));
}

ptie_status ptie_safetensors_write(const char *path, const ptie_tensor_view *tensors,
                                   size_t tensor_count, const ptie_note *notes, size_t note_count,
                                   bool overwrite) {
    ptie_stream stream;
    char *header = header_text(tensors, tensor_count, notes, note_count);
    if (!header) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", path);
    ptie_status status = ptie_stream_open(&stream, path, overwrite);
    if (status == PTIE_OK) {
        write_content(stream.out, header, tensors, tensor_count);
        status = ptie_stream_complete(&stream);
    }
    free(header);
    return status;
}

/* --- reading -------------------------------------------------------------------------------------
 */

/* A tensor entry and where its data lie. */
typedef struct entry {
    ptie_tensor_view view;
    uint64_t begin, end;
} entry;

static ptie_status damaged(const char *path, const char *name, const char *what) {
    return PTIE_FAIL(PTIE_EFORMAT, "%s: tensor '%s': %s", path, name, what);
}

/* A member that must be an array of `low` to `high` integers >= 0; -1 if it is not. */
static int32_t integers(const json_t *array, size_t low, size_t high, int64_t *values) {
    size_t count = json_array_size(array);
    if (!json_is_array(array) || count < low || count > high) return -1;
    for (size_t i = 0; i < count; i++) {
        const json_t *item = json_array_get(array, i);
        if (!json_is_integer(item) || json_integer_value(item) < 0) return -1;
        values[i] = json_integer_value(item);
    }
    return (int32_t)count;
}

static ptie_status parse_entry(entry *out, const char *path, const char *name, const json_t *object,
                               uint64_t data_bytes) {
    int64_t offsets[2];
    uint64_t count;
    const char *type = json_string_value(json_object_get(object, "dtype"));
    if (!type) return damaged(path, name, "has no dtype");
    if (strcmp(type, "F32") != 0)
        return PTIE_FAIL(PTIE_EUNSUPPORTED,
                         "%s: tensor '%s': type not read (expected F32, found %s)", path, name,
                         type);
    out->view.name = name;
    out->view.rank = integers(json_object_get(object, "shape"), 0, 4, out->view.shape);
    if (out->view.rank < 0) return damaged(path, name, "bad shape (expected 0 to 4 sizes)");
    if (integers(json_object_get(object, "data_offsets"), 2, 2, offsets) < 0)
        return damaged(path, name, "bad data_offsets (expected two numbers)");
    out->begin = (uint64_t)offsets[0];
    out->end = (uint64_t)offsets[1];
    if (out->begin > out->end || out->end > data_bytes)
        return damaged(path, name, "data outside the file");
    if (!element_count(out->view.shape, out->view.rank, data_bytes / sizeof(float), &count))
        return damaged(path, name, "shape larger than the file");
    if (count * sizeof(float) != out->end - out->begin)
        return PTIE_FAIL(PTIE_EFORMAT,
                         "%s: tensor '%s': data do not fit the shape (expected %llu bytes, "
                         "found %llu)",
                         path, name, (unsigned long long)(count * sizeof(float)),
                         (unsigned long long)(out->end - out->begin));
    return PTIE_OK;
}

static int by_position(const void *left, const void *right) {
    const entry *a = left, *b = right;
    if (a->begin != b->begin) return a->begin < b->begin ? -1 : 1;
    return a->end < b->end ? -1 : a->end > b->end; /* empty tensors first */
}

/* Sorted entries must cover the data without hole or overlap. */
static ptie_status check_cover(const char *path, const entry *entries, size_t count,
                               uint64_t data_bytes) {
    uint64_t end = 0;
    for (size_t i = 0; i < count; i++) {
        if (entries[i].begin != end)
            return damaged(path, entries[i].view.name,
                           entries[i].begin > end ? "a hole before its data"
                                                  : "overlaps another tensor");
        end = entries[i].end;
    }
    if (end != data_bytes)
        return PTIE_FAIL(PTIE_EFORMAT,
                         "%s: data that belong to no tensor (expected %llu bytes, found %llu)",
                         path, (unsigned long long)end, (unsigned long long)data_bytes);
    return PTIE_OK;
}

static ptie_status parse_notes(ptie_safetensors *file, const char *path, json_t *metadata) {
    const char *key;
    json_t *value;
    if (!json_is_object(metadata))
        return PTIE_FAIL(PTIE_EFORMAT, "%s: __metadata__ is not an object", path);
    PTIE_TRY(
        ptie_alloc_status(&file->notes, json_object_size(metadata), sizeof *file->notes, path));
    json_object_foreach(metadata, key, value) {
        if (!json_is_string(value))
            return PTIE_FAIL(PTIE_EFORMAT, "%s: __metadata__ '%s' is not a string", path, key);
        file->notes[file->note_count++] = (ptie_note){key, json_string_value(value)};
    }
    return PTIE_OK;
}

/* Fills entries (as many as the header has members) and the notes. */
static ptie_status parse_members(ptie_safetensors *file, const char *path, entry *entries,
                                 uint64_t data_bytes) {
    const char *name;
    json_t *value;
    json_object_foreach(file->json, name, value) {
        if (strcmp(name, "__metadata__") == 0)
            PTIE_TRY(parse_notes(file, path, value));
        else
            PTIE_TRY(parse_entry(&entries[file->tensor_count++], path, name, value, data_bytes));
    }
    qsort(entries, file->tensor_count, sizeof *entries, by_position);
    return check_cover(path, entries, file->tensor_count, data_bytes);
}

static ptie_status parse_header(ptie_safetensors *file, const char *path, size_t header_bytes,
                                uint64_t data_bytes) {
    json_error_t error;
    entry *entries = NULL;
    file->json =
        json_loadb((const char *)file->header, header_bytes, JSON_REJECT_DUPLICATES, &error);
    if (!json_is_object(file->json))
        return PTIE_FAIL(PTIE_EFORMAT, "%s: bad header: %s", path,
                         file->json ? "not a JSON object" : error.text);
    size_t members = json_object_size(file->json);
    PTIE_TRY(ptie_alloc_status(&entries, members, sizeof *entries, path));
    ptie_status status = parse_members(file, path, entries, data_bytes);
    if (status == PTIE_OK)
        status = ptie_alloc_status(&file->tensors, members, sizeof *file->tensors, path);
    for (size_t i = 0; status == PTIE_OK && i < file->tensor_count; i++) {
        file->tensors[i] = entries[i].view;
        file->tensors[i].data = (const float *)((const char *)file->data + entries[i].begin);
    }
    ptie_free(entries);
    return status;
}

/* Reads length, header and data into *file; checks only sizes. */
static ptie_status read_parts(ptie_safetensors *file, const char *path, FILE *stream,
                              uint64_t file_bytes, size_t *header_bytes, uint64_t *data_bytes) {
    unsigned char length[LENGTH_BYTES];
    if (fread(length, 1, sizeof length, stream) != sizeof length)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: too short for a safetensors file", path);
    uint64_t bytes = ptie_get_le(length, LENGTH_BYTES);
    if (bytes > HEADER_LIMIT || bytes > file_bytes - LENGTH_BYTES)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: not a safetensors file, or cut (expected a header within %llu bytes, found %llu)", path,
                         (unsigned long long)file_bytes, (unsigned long long)bytes);
    *header_bytes = (size_t)bytes;
    *data_bytes = file_bytes - LENGTH_BYTES - bytes;
    PTIE_TRY(ptie_alloc_status(&file->header, *header_bytes, 1, path));
    PTIE_TRY(ptie_alloc_status(&file->data, (size_t)*data_bytes, 1, path));
    if (fread(file->header, 1, *header_bytes, stream) != *header_bytes ||
        fread(file->data, 1, (size_t)*data_bytes, stream) != *data_bytes)
        return PTIE_FAIL(PTIE_EIO, "%s: cannot read to the end", path);
    return PTIE_OK;
}

ptie_status ptie_safetensors_read(ptie_safetensors **out, const char *path) {
    FILE *stream;
    ptie_safetensors *file = NULL;
    uint64_t file_bytes, data_bytes = 0;
    size_t header_bytes = 0;
    *out = NULL;
    PTIE_TRY(ptie_input_open(&stream, path, &file_bytes));
    ptie_status status = ptie_alloc_status(&file, 1, sizeof *file, path);
    if (status == PTIE_OK)
        status = read_parts(file, path, stream, file_bytes, &header_bytes, &data_bytes);
    if (status == PTIE_OK) status = parse_header(file, path, header_bytes, data_bytes);
    fclose(stream);
    if (status != PTIE_OK) {
        ptie_safetensors_free(file);
        return status;
    }
    for (uint64_t i = 0; i < data_bytes / sizeof(float); i++)
        file->data[i] = ptie_get_f32((const unsigned char *)&file->data[i]);
    *out = file;
    return PTIE_OK;
}

void ptie_safetensors_free(ptie_safetensors *file) {
    if (!file) return;
    json_decref(file->json);
    ptie_free(file->header);
    ptie_free(file->data);
    ptie_free(file->tensors);
    ptie_free(file->notes);
    ptie_free(file);
}

size_t ptie_safetensors_count(const ptie_safetensors *file) {
    return file->tensor_count;
}

const ptie_tensor_view *ptie_safetensors_tensor(const ptie_safetensors *file, size_t index) {
    return index < file->tensor_count ? &file->tensors[index] : NULL;
}

const ptie_tensor_view *ptie_safetensors_find(const ptie_safetensors *file, const char *name) {
    for (size_t i = 0; i < file->tensor_count; i++)
        if (strcmp(file->tensors[i].name, name) == 0) return &file->tensors[i];
    return NULL;
}

size_t ptie_safetensors_notes(const ptie_safetensors *file, const ptie_note **notes) {
    *notes = file->notes;
    return file->note_count;
}

const char *ptie_safetensors_note(const ptie_safetensors *file, const char *key) {
    for (size_t i = 0; i < file->note_count; i++)
        if (strcmp(file->notes[i].key, key) == 0) return file->notes[i].value;
    return NULL;
}
