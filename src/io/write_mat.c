/* SPDX-License-Identifier: BSD-3-Clause */
/* MAT-file version 5, uncompressed, as MATLAB and Octave load it: what goes with the map, then the map [H, W, T],
 * column-major as they are.  Frames are turned and appended as they come; the sizes in front of them are filled in at the end.
 */
#include <string.h>

#include <ptie/version.h>

#include "base/memory.h"
#include "io/endian.h"
#include "io/stream.h"
#include "io/writer.h"

/* Data types and array classes of the format (MathWorks, "MAT-File Format", tables 1-1 and 1-3). */
enum { INT8 = 1, UINT8 = 2, UINT16 = 4, INT32 = 5, UINT32 = 6, SINGLE = 7, DOUBLE = 9, MATRIX = 14 };
enum { CHAR_CLASS = 4, DOUBLE_CLASS = 6, SINGLE_CLASS = 7, UINT8_CLASS = 9, UINT16_CLASS = 11 };

#define LARGEST_VARIABLE 0x7fffffffull /* bytes: sizes are 32 bits, signed in some readers */
#define NAME_BYTES 64                  /* MATLAB keeps 63 characters */

typedef struct mat_output {
    const ptie_writer_job *job;
    ptie_stream stream;
    char name[NAME_BYTES];
    long map_at; /* where the map begins */
    int64_t frames; /* appended */
    unsigned char *samples, *turned;
} mat_output;

/* A variable before its data. */
typedef struct variable {
    const char *name;
    uint32_t class, type;
    uint32_t dims[3], rank;
    uint64_t bytes; /* of the data */
} variable;

static uint64_t padded(uint64_t bytes) {
    return (bytes + 7) / 8 * 8;
}

static void pad(FILE *out, uint64_t bytes) {
    ptie_write_le(out, 0, (size_t)(padded(bytes) - bytes));
}

static void write_tag(FILE *out, uint32_t type, uint64_t bytes) {
    ptie_write_le(out, type, 4);
    ptie_write_le(out, bytes, 4);
}

/* Bytes behind the variable's own tag. */
static uint64_t variable_bytes(const variable *v) {
    return 16 + 8 + padded(4 * v->rank) + 8 + padded(strlen(v->name)) + 8 + padded(v->bytes);
}

static void begin_variable(FILE *out, const variable *v) {
    const size_t length = strlen(v->name);
    write_tag(out, MATRIX, variable_bytes(v));
    write_tag(out, UINT32, 8);
    ptie_write_le(out, v->class, 8); /* no flags, nothing sparse */
    write_tag(out, INT32, 4 * v->rank);
    for (uint32_t d = 0; d < v->rank; d++) ptie_write_le(out, v->dims[d], 4);
    pad(out, 4 * v->rank);
    write_tag(out, INT8, length);
    fwrite(v->name, 1, length, out);
    pad(out, length);
    write_tag(out, v->type, v->bytes);
}

/* A column of numbers. */
static void write_numbers(FILE *out, const char *name, const double *values, size_t count) {
    begin_variable(out, &(variable){.name = name,
                                    .class = DOUBLE_CLASS,
                                    .type = DOUBLE,
                                    .dims = {(uint32_t)count, 1},
                                    .rank = 2,
                                    .bytes = 8 * count});
    for (size_t i = 0; i < count; i++) {
        uint64_t bits;
        memcpy(&bits, values + i, sizeof bits);
        ptie_write_le(out, bits, 8);
    }
}

/* A row of characters; what is not ASCII becomes '?', since readers differ on everything else. */
static void write_text(FILE *out, const char *name, const char *text) {
    const size_t length = text ? strlen(text) : 0;
    begin_variable(out, &(variable){.name = name,
                                    .class = CHAR_CLASS,
                                    .type = UINT16,
                                    .dims = {length > 0, (uint32_t)length},
                                    .rank = 2,
                                    .bytes = 2 * length});
    for (size_t i = 0; i < length; i++)
        ptie_write_le(out, (unsigned char)text[i] < 128 ? (unsigned char)text[i] : '?', 2);
    pad(out, 2 * length);
}

static void write_header(FILE *out) {
    char text[125];
    memset(text, ' ', sizeof text);
    int length = snprintf(text, sizeof text, "MATLAB 5.0 MAT-file, written by ptie " PTIE_VERSION_STRING);
    text[length] = ' ';
    memset(text + 116, 0, 8); /* no subsystem data */
    fwrite(text, 1, 124, out);
    ptie_write_le(out, 0x0100, 2);
    fwrite("IM", 1, 2, out); /* little-endian */
}

/* The map with `frames` frames. */
static variable map_of(const mat_output *mat, int64_t frames) {
    const ptie_writer_job *job = mat->job;
    const bool is_float = job->stored.kind == 'f', is_byte = job->stored.bytes == 1;
    return (variable){.name = mat->name,
                      .class = is_float ? SINGLE_CLASS : is_byte ? UINT8_CLASS : UINT16_CLASS,
                      .type = is_float ? SINGLE : is_byte ? UINT8 : UINT16,
                      .dims = {(uint32_t)job->info.height_px, (uint32_t)job->info.width_px,
                               (uint32_t)frames},
                      .rank = 3,
                      .bytes = (uint64_t)frames * ptie_job_bytes(job)};
}

static ptie_status check_size(const mat_output *mat, int64_t frames) {
    const uint64_t frame_bytes = ptie_job_bytes(mat->job), most = (LARGEST_VARIABLE - 256) / frame_bytes;
    if ((uint64_t)frames <= most) return PTIE_OK;
    return PTIE_FAIL(PTIE_EUNSUPPORTED,
                     "%s: too large for a MAT-file of version 5 (expected at most %llu frames of %llu bytes, "
                     "found %lld); write .h5, which MATLAB reads with h5read",
                     mat->job->path, (unsigned long long)most, (unsigned long long)frame_bytes,
                     (long long)frames);
}

/* Letters, digits and '_', beginning with a letter. */
static void name_variable(char name[NAME_BYTES], const char *from) {
    const bool is_letter = (from[0] >= 'a' && from[0] <= 'z') || (from[0] >= 'A' && from[0] <= 'Z');
    snprintf(name, NAME_BYTES, "%s%s", is_letter ? "" : "map_", from);
    for (char *c = name; *c; c++)
        if (*c == '-' || *c == '/') *c = '_';
}

static void mat_discard(void *state) {
    mat_output *mat = state;
    ptie_stream_discard(&mat->stream);
    ptie_free(mat->samples);
    ptie_free(mat->turned);
    ptie_free(mat);
}

static ptie_status prepare(mat_output *mat) {
    const ptie_writer_job *job = mat->job;
    name_variable(mat->name, job->name);
    PTIE_TRY(check_size(mat, job->info.frames));
    PTIE_TRY(ptie_alloc_status(&mat->samples, ptie_job_bytes(job), 1, job->path));
    PTIE_TRY(ptie_alloc_status(&mat->turned, ptie_job_bytes(job), 1, job->path));
    return ptie_stream_open(&mat->stream, job->path, job->overwrite);
}

static void describe(mat_output *mat) {
    const ptie_writer_job *job = mat->job;
    FILE *out = mat->stream.out;
    write_header(out);
    write_text(out, "unit", job->info.unit);
    write_numbers(out, "frame_rate_hz", &job->info.frame_rate_hz, 1);
    write_numbers(out, "pixel_m", &job->info.pixel_m, 1);
    write_numbers(out, "first_frame", &(double){(double)job->info.first_frame}, 1);
    write_numbers(out, "frame_step", &(double){(double)(job->info.frame_step ? job->info.frame_step : 1)}, 1);
    if (job->source) write_text(out, "recording", job->source);
    if (job->command) write_text(out, "command", job->command);
}

static ptie_status mat_create(void **state, const ptie_writer_job *job) {
    mat_output *mat;
    *state = NULL;
    PTIE_TRY(ptie_alloc_status(&mat, 1, sizeof *mat, job->path));
    mat->job = job;
    ptie_status status = prepare(mat);
    if (status == PTIE_OK) describe(mat);
    if (status == PTIE_OK) status = ptie_stream_check(&mat->stream);
    if (status != PTIE_OK) {
        mat_discard(mat);
        return status;
    }
    *state = mat;
    return PTIE_OK;
}

/* Rows become columns. */
static void turn(const mat_output *mat) {
    const size_t width = (size_t)mat->job->info.width_px, height = (size_t)mat->job->info.height_px;
    const size_t bytes = mat->job->stored.bytes;
    for (size_t y = 0; y < height; y++)
        for (size_t x = 0; x < width; x++)
            memcpy(mat->turned + (x * height + y) * bytes, mat->samples + (y * width + x) * bytes, bytes);
}

/* "/entry/metrics/phase/mgm" becomes metrics_phase_mgm. */
static ptie_status mat_add_column(void *state, const char *path, const double *values, int64_t count) {
    mat_output *mat = state;
    char name[NAME_BYTES];
    static const char entry[] = "/entry/";
    name_variable(name, strncmp(path, entry, strlen(entry)) == 0 ? path + strlen(entry) : path);
    write_numbers(mat->stream.out, name, values, (size_t)count);
    return ptie_stream_check(&mat->stream);
}

static void begin_map(mat_output *mat) {
    const variable map = map_of(mat, 0);
    mat->map_at = ftell(mat->stream.out);
    begin_variable(mat->stream.out, &map);
}

static ptie_status mat_append(void *state, const float *frame) {
    mat_output *mat = state;
    PTIE_TRY(ptie_job_encode(mat->job, mat->samples, frame));
    turn(mat);
    PTIE_TRY(check_size(mat, ++mat->frames));
    if (mat->frames == 1) begin_map(mat);
    fwrite(mat->turned, 1, ptie_job_bytes(mat->job), mat->stream.out);
    return ptie_stream_check(&mat->stream);
}

static ptie_status mat_complete(void *state, int64_t frames) {
    mat_output *mat = state;
    const variable map = map_of(mat, frames);
    pad(mat->stream.out, map.bytes);
    fseek(mat->stream.out, mat->map_at, SEEK_SET);
    begin_variable(mat->stream.out, &map);
    ptie_status status = ptie_stream_complete(&mat->stream);
    mat_discard(mat); /* what is left of it */
    return status;
}

const ptie_writer_format ptie_write_mat = {.endings = {".mat"},
                                           .create = mat_create,
                                           .append = mat_append,
                                           .add_column = mat_add_column,
                                           .complete = mat_complete,
                                           .discard = mat_discard};
