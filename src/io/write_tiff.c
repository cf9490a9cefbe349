/* SPDX-License-Identifier: BSD-3-Clause */
/* float32 TIFF, one page per frame, as ImageJ and Fiji scale it.  Written here rather than by libtiff: the
 * frames follow each other without gaps from byte 16 on and the directories come last, so that a file of any
 * number of frames is written in one pass, may be mapped into memory, and becomes BigTIFF only if it must.
 */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "io/endian.h"
#include "io/stream.h"
#include "io/writer.h"

#define DATA_START 16                   /* both kinds of header fit in front */
#define LARGEST_PLAIN 0xffffffffull     /* bytes of a file with 32-bit offsets */
#define DIRECTORY_BYTES 512             /* more than one takes */

enum { SHORT = 3, ASCII = 2, LONG = 4, RATIONAL = 5, LONG8 = 16 };

typedef struct tiff_output {
    ptie_stream stream;
    char *path;
    uint64_t width, height;
    ptie_recording_info info;
} tiff_output;

/* Where the parts of a file lie, and how offsets are stored. */
typedef struct layout {
    FILE *out;
    bool big;
    uint64_t frames, frame_bytes;
    uint64_t text_at, text_bytes; /* ImageJ's description */
    uint64_t resolution_at;
    uint64_t resolution; /* numerator and denominator as stored */
} layout;

static void tiff_discard(void *state) {
    tiff_output *tiff = state;
    ptie_stream_discard(&tiff->stream);
    ptie_free(tiff->path);
    ptie_free(tiff);
}

static ptie_status tiff_create(void **state, const ptie_writer_job *job) {
    static const char space[DATA_START] = {0};
    tiff_output *tiff;
    *state = NULL;
    PTIE_TRY(ptie_alloc_status(&tiff, 1, sizeof *tiff, job->path));
    ptie_status status = ptie_stream_open(&tiff->stream, job->path, job->overwrite);
    tiff->path = ptie_strdup(job->path);
    if (status == PTIE_OK && !tiff->path) status = PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", job->path);
    if (status != PTIE_OK) {
        tiff_discard(tiff);
        return status;
    }
    tiff->width = (uint64_t)job->info.width_px;
    tiff->height = (uint64_t)job->info.height_px;
    tiff->info = job->info;
    fwrite(space, 1, sizeof space, tiff->stream.out);
    *state = tiff;
    return PTIE_OK;
}

static ptie_status tiff_append(void *state, const float *frame) {
    const tiff_output *tiff = state;
    ptie_write_floats(tiff->stream.out, frame, tiff->width * tiff->height);
    return ptie_stream_check(&tiff->stream);
}

/* What ImageJ reads: number of frames, scale, time between frames, unit of the values. */
static void describe(ptie_text *text, const ptie_recording_info *info, uint64_t frames) {
    ptie_text_append(text, "ImageJ=1.53t\nimages=%llu\nframes=%llu\n", (unsigned long long)frames,
                     (unsigned long long)frames);
    if (info->pixel_m > 0) ptie_text_append(text, "unit=um\n");
    if (info->frame_rate_hz > 0) ptie_text_append(text, "finterval=%.9g\n", 1 / info->frame_rate_hz);
    if (info->unit[0]) ptie_text_append(text, "vunit=%s\n", info->unit);
    ptie_text_append(text, "loop=false\n");
}

/* Pixels per um as a fraction of 32-bit numbers, the larger one near 4e9. */
static uint64_t resolution_of(double pixel_m) {
    const double pixel_um = pixel_m > 0 ? 1e6 * pixel_m : 1;
    const double below = pixel_um < 1 ? 4e9 * pixel_um : 4e9;
    return (uint64_t)llround(below) << 32 | (uint64_t)llround(below / pixel_um);
}

static void write_offset(const layout *l, uint64_t offset) {
    ptie_write_le(l->out, offset, l->big ? 8 : 4);
}

static void write_header(const layout *l, uint64_t first_directory) {
    fwrite("II", 1, 2, l->out);
    ptie_write_le(l->out, l->big ? 43 : 42, 2);
    if (l->big) {
        ptie_write_le(l->out, 8, 2); /* bytes of an offset */
        ptie_write_le(l->out, 0, 2);
    }
    write_offset(l, first_directory);
}

static void write_entry(const layout *l, unsigned tag, unsigned type, uint64_t count, uint64_t value) {
    ptie_write_le(l->out, tag, 2);
    ptie_write_le(l->out, type, 2);
    write_offset(l, count);
    write_offset(l, value);
}

/* A directory ends with the offset of the next: right behind it, or 0. */
static void write_directory(const layout *l, const tiff_output *tiff, uint64_t frame, uint64_t at) {
    const uint64_t entries = frame == 0 ? 14 : 13;
    const uint64_t bytes = l->big ? 8 + 20 * entries + 8 : 2 + 12 * entries + 4;
    const uint64_t resolution = l->big ? l->resolution : l->resolution_at; /* 8 bytes fit into an entry */
    const unsigned offset_type = l->big ? LONG8 : LONG;
    ptie_write_le(l->out, entries, l->big ? 8 : 2);
    write_entry(l, 256, LONG, 1, tiff->width);
    write_entry(l, 257, LONG, 1, tiff->height);
    write_entry(l, 258, SHORT, 1, 32); /* bits per sample */
    write_entry(l, 259, SHORT, 1, 1);  /* no compression */
    write_entry(l, 262, SHORT, 1, 1);  /* 0 is black */
    if (frame == 0) write_entry(l, 270, ASCII, l->text_bytes, l->text_at);
    write_entry(l, 273, offset_type, 1, DATA_START + frame * l->frame_bytes); /* the only strip */
    write_entry(l, 277, SHORT, 1, 1);                                         /* samples per pixel */
    write_entry(l, 278, LONG, 1, tiff->height);                               /* rows per strip */
    write_entry(l, 279, offset_type, 1, l->frame_bytes);
    write_entry(l, 282, RATIONAL, 1, resolution);
    write_entry(l, 283, RATIONAL, 1, resolution);
    write_entry(l, 296, SHORT, 1, 1); /* the description names the unit */
    write_entry(l, 339, SHORT, 1, 3); /* IEEE floating point */
    write_offset(l, frame + 1 < l->frames ? at + bytes : 0);
}

/* Behind the frames: description, resolution, directories; then the header. */
static void write_tail(const tiff_output *tiff, uint64_t frames, const ptie_text *text) {
    const uint64_t frame_bytes = 4 * tiff->width * tiff->height;
    const uint64_t data_end = DATA_START + frames * frame_bytes;
    layout l = {.out = tiff->stream.out,
                .big = data_end + text->length + frames * DIRECTORY_BYTES > LARGEST_PLAIN,
                .frames = frames,
                .frame_bytes = frame_bytes,
                .text_at = data_end,
                .text_bytes = (text->length + 8) / 8 * 8, /* at least one NUL */
                .resolution = resolution_of(tiff->info.pixel_m)};
    l.resolution_at = l.text_at + l.text_bytes;
    fwrite(text->data, 1, text->length, l.out);
    for (uint64_t i = text->length; i < l.text_bytes; i++) fputc(0, l.out);
    ptie_write_le(l.out, l.resolution, 8);
    const uint64_t first = l.resolution_at + 8;
    uint64_t at = first;
    for (uint64_t frame = 0; frame < frames; frame++) {
        write_directory(&l, tiff, frame, at);
        at = (uint64_t)ftello(l.out);
    }
    rewind(l.out);
    write_header(&l, first);
}

static ptie_status tiff_complete(void *state, int64_t frames) {
    tiff_output *tiff = state;
    ptie_text text = {0};
    describe(&text, &tiff->info, (uint64_t)frames);
    ptie_status status = text.failed ? PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", tiff->path) : PTIE_OK;
    if (status == PTIE_OK) {
        write_tail(tiff, (uint64_t)frames, &text);
        status = ptie_stream_complete(&tiff->stream);
    }
    ptie_text_free(&text);
    tiff_discard(tiff); /* what is left of it */
    return status;
}

const ptie_writer_format ptie_write_tiff = {.endings = {".tif", ".tiff"},
                                            .create = tiff_create,
                                            .append = tiff_append,
                                            .complete = tiff_complete,
                                            .discard = tiff_discard};
