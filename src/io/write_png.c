/* SPDX-License-Identifier: BSD-3-Clause */
/* Grey PNG, one file per frame.  Integers are stored as they are; other values are spread over 16 bits,
 * and text chunks say how they come back.  All files keep their ".part" names until the last one is
 * complete. */
#include <errno.h>
#include <math.h>
#include <png.h>
#include <string.h>
#include <unistd.h>

#include "base/image.h"
#include "base/file.h"
#include "base/text.h"
#include "io/array.h"
#include "io/endian.h"
#include "io/pattern.h"
#include "io/png_keys.h"
#include "io/writer.h"

#define PATH_BYTES 4096

typedef struct png_output {
    ptie_writer_job job;
    bool numbered;
    ptie_pattern pattern;
    ptie_output_file *files;
    size_t count, capacity;
    unsigned char *row; /* big-endian samples */
    unsigned char *integers; /* a frame as stored; NULL when values are spread */
} png_output;

/* One pass of libpng over a file. */
typedef struct encoder {
    const png_output *output;
    const float *frame;
    double offset, scale; /* value = offset + scale * sample */
    FILE *stream;
    png_structp png;
    png_infop info;
    char message[128];
} encoder;

static void on_error(png_structp png, png_const_charp message) {
    encoder *e = png_get_error_ptr(png);
    snprintf(e->message, sizeof e->message, "%s", message);
    longjmp(png_jmpbuf(png), 1);
}

static void on_warning(png_structp png, png_const_charp message) {
    (void)png, (void)message;
}

static void write_bytes(png_structp png, png_bytep bytes, size_t count) {
    if (fwrite(bytes, 1, count, png_get_io_ptr(png)) != count) png_error(png, strerror(errno));
}

static void flush_nothing(png_structp png) {
    (void)png; /* closing the stream flushes */
}

static void png_discard(void *state) {
    png_output *output = state;
    for (size_t i = 0; i < output->count; i++) ptie_output_discard(&output->files[i]);
    ptie_free(output->files);
    ptie_free(output->row);
    ptie_free(output->integers);
    ptie_free(output);
}

/* Frames that an older, longer sequence has behind the last of `count` would pass for ours: they
 * go, or stay with all the others. */
static ptie_status check_behind(const png_output *output, int64_t count) {
    char path[PATH_BYTES];
    if (!output->numbered || output->job.overwrite) return PTIE_OK;
    PTIE_TRY(ptie_pattern_name(&output->pattern, count, path, sizeof path));
    if (access(path, F_OK) != 0) return PTIE_OK;
    return PTIE_FAIL(PTIE_EEXIST,
                     "%s: exists already, behind the last of %lld frames (use -f to remove it)",
                     path, (long long)count);
}

static ptie_status png_create(void **state, const ptie_writer_job *job) {
    png_output *output;
    ptie_pattern pattern = {0};
    *state = NULL;
    bool numbered = ptie_pattern_find(&pattern, job->path);
    if (!numbered && job->info.frames > 1)
        return PTIE_FAIL(PTIE_EINVAL,
                         "%s: one PNG for %lld frames (expected a pattern such as flow_%%04d.png)",
                         job->path, (long long)job->info.frames);
    PTIE_TRY(ptie_alloc_status(&output, 1, sizeof *output, job->path));
    output->job = *job;
    output->numbered = numbered;
    output->pattern = pattern;
    ptie_status status = ptie_alloc_status(&output->row, (size_t)job->info.width_px, 2, job->path);
    if (status == PTIE_OK && job->stored.kind == 'u' && !(job->low < job->high))
        status = ptie_alloc_status(&output->integers, ptie_job_bytes(job), 1, job->path);
    if (status == PTIE_OK && job->info.frames > 0) status = check_behind(output, job->info.frames);
    if (status != PTIE_OK) {
        png_discard(output);
        return status;
    }
    *state = output;
    return PTIE_OK;
}

/* Spreads the wanted range, or that of the frame, over the 16 bits. */
static void find_scale(encoder *e, size_t count) {
    double low = e->output->job.low, high = e->output->job.high;
    if (!(low < high)) {
        const ptie_extent extent = ptie_image_extent(e->frame, count);
        low = (double)extent.low;
        high = (double)extent.high;
    }
    e->offset = low;
    e->scale = (high - low) / 65535;
}

static unsigned sample_of(const encoder *e, float value) {
    const double sample = e->scale > 0 ? ((double)value - e->offset) / e->scale : 0;
    return (unsigned)lrint(fmin(fmax(sample, 0), 65535));
}

/* libpng wants key and text writable, and copies both. */
static void set_note(const encoder *e, const char *key, const char *value) {
    char key_copy[32], value_copy[64];
    snprintf(key_copy, sizeof key_copy, "%s", key);
    snprintf(value_copy, sizeof value_copy, "%s", value);
    png_text text = {.compression = PNG_TEXT_COMPRESSION_NONE, .key = key_copy, .text = value_copy};
    png_set_text(e->png, e->info, &text, 1);
}

static void set_number(const encoder *e, const char *key, double value) {
    char text[32];
    ptie_print(text, sizeof text, "%.17g", value);
    set_note(e, key, text);
}

static void set_notes(const encoder *e) {
    const ptie_writer_job *job = &e->output->job;
    set_note(e, PTIE_PNG_NAME, job->name);
    set_note(e, PTIE_PNG_UNIT, job->info.unit);
    if (!e->output->integers) {
        set_number(e, PTIE_PNG_OFFSET, e->offset);
        set_number(e, PTIE_PNG_SCALE, e->scale);
    }
    set_number(e, PTIE_PNG_RATE, job->info.frame_rate_hz);
    set_number(e, PTIE_PNG_PIXEL, job->info.pixel_m);
}

/* A row of big-endian samples. */
static const unsigned char *encode_row(const encoder *e, size_t y, size_t width) {
    const png_output *output = e->output;
    const size_t bytes = output->job.stored.bytes;
    const unsigned char *integers = output->integers ? output->integers + y * width * bytes : NULL;
    if (integers && bytes == 1) return integers;
    for (size_t x = 0; x < width; x++) {
        const unsigned sample = integers ? (unsigned)ptie_get_le(integers + 2 * x, 2)
                                         : sample_of(e, e->frame[y * width + x]);
        output->row[2 * x] = (unsigned char)(sample >> 8);
        output->row[2 * x + 1] = (unsigned char)sample;
    }
    return output->row;
}

static void encode(encoder *e) {
    const png_output *output = e->output;
    const size_t width = (size_t)output->job.info.width_px;
    const size_t height = (size_t)output->job.info.height_px;
    const int bits = output->integers ? 8 * (int)output->job.stored.bytes : 16;
    png_set_write_fn(e->png, e->stream, write_bytes, flush_nothing);
    png_set_IHDR(e->png, e->info, (png_uint_32)width, (png_uint_32)height, bits,
                 PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    set_notes(e);
    png_write_info(e->png, e->info);
    for (size_t y = 0; y < height; y++) png_write_row(e->png, encode_row(e, y, width));
    png_write_end(e->png, NULL);
}

/* libpng fails by jumping; here the jump ends, and no local variable of a step survives it. */
static bool guarded(encoder *e, void (*step)(encoder *)) {
    if (setjmp(png_jmpbuf(e->png))) return false;
    step(e);
    return true;
}

static ptie_status write_stream(encoder *e, const char *path) {
    e->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, e, on_error, on_warning);
    if (e->png) e->info = png_create_info_struct(e->png);
    ptie_status status = e->info ? PTIE_OK : PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", path);
    if (status == PTIE_OK && !guarded(e, encode))
        status = PTIE_FAIL(PTIE_EIO, "%s: cannot write: %s", path, e->message);
    png_destroy_write_struct(&e->png, &e->info);
    return status;
}

static ptie_status write_file(encoder *e, const ptie_output_file *file) {
    PTIE_TRY(ptie_output_stream(file, &e->stream));
    ptie_status status = write_stream(e, file->path);
    ptie_status closed = ptie_close_written(e->stream, file->path);
    return status != PTIE_OK ? status : closed;
}

static ptie_status file_name(const png_output *output, size_t number, char path[PATH_BYTES]) {
    if (output->numbered)
        return ptie_pattern_name(&output->pattern, (int64_t)number, path, PATH_BYTES);
    if (number > 0)
        return PTIE_FAIL(PTIE_EINVAL,
                         "%s: one PNG for several frames (expected a pattern such as "
                         "flow_%%04d.png)",
                         output->job.path);
    snprintf(path, PATH_BYTES, "%s", output->job.path);
    return PTIE_OK;
}

static ptie_status png_append(void *state, const float *frame) {
    png_output *output = state;
    char path[PATH_BYTES];
    const int32_t width = output->job.info.width_px, height = output->job.info.height_px;
    PTIE_TRY(file_name(output, output->count, path));
    PTIE_TRY(ptie_image_finite(frame, width, height, path));
    if (output->integers) PTIE_TRY(ptie_job_encode(&output->job, output->integers, frame));
    PTIE_TRY(ptie_array_room(&output->files, output->count, &output->capacity,
                             sizeof *output->files, path));
    ptie_output_file *file = &output->files[output->count];
    PTIE_TRY(ptie_output_open(file, path, output->job.overwrite));
    if (output->count > 0) ptie_output_unlock(file); /* the first guards them all */
    output->count++;
    encoder e = {.output = output, .frame = frame};
    find_scale(&e, (size_t)width * (size_t)height);
    return write_file(&e, file);
}

static void remove_behind(const png_output *output) {
    char path[PATH_BYTES];
    for (size_t i = output->count; file_name(output, i, path) == PTIE_OK && remove(path) == 0;) i++;
}

static ptie_status png_complete(void *state, int64_t frames) {
    png_output *output = state;
    char path[PATH_BYTES];
    ptie_status status = check_behind(output, frames);
    size_t left = output->count; /* the first, which guards them all, comes last */
    while (left > 0 && status == PTIE_OK) status = ptie_output_commit(&output->files[--left]);
    if (status != PTIE_OK)
        for (size_t i = left + 1; i < output->count; i++)
            if (file_name(output, i, path) == PTIE_OK) remove(path);
    if (status == PTIE_OK && output->numbered) remove_behind(output);
    png_discard(output);
    return status;
}

const ptie_writer_format ptie_write_png = {.endings = {".png"},
                                           .create = png_create,
                                           .append = png_append,
                                           .complete = png_complete,
                                           .discard = png_discard};
