/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/tiff_tail.h"

#include <math.h>

#include "base/text.h"
#include "io/endian.h"
#include "io/stream.h"

#define DIRECTORY_BYTES 512 /* more than one takes */

enum { ASCII = 2, SHORT = 3, LONG = 4, RATIONAL = 5, LONG8 = 16 };

/* Where the parts of a file lie, and how offsets are stored. */
typedef struct layout {
    FILE *out;
    bool big;
    uint64_t width, height, frames, frame_bytes;
    ptie_sample stored;
    uint64_t text_at, text_bytes; /* ImageJ's description */
    uint64_t resolution;          /* numerator and denominator as stored */
    uint64_t resolution_at;
} layout;

/* What ImageJ reads: number of frames, scale, time between frames, unit of the values. */
static void describe(ptie_text *text, const ptie_writer_job *job) {
    const ptie_recording_info *info = &job->info;
    const long long frames = info->frames;
    ptie_text_append(text, "ImageJ=1.53t\nimages=%lld\nframes=%lld\n", frames, frames);
    if (frames > 1) ptie_text_append(text, "hyperstack=true\n");
    if (info->pixel_m > 0) ptie_text_append(text, "unit=um\n");
    if (info->frame_rate_hz > 0)
        ptie_text_append(text, "finterval=%.9g\n", 1 / info->frame_rate_hz);
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

static void write_entry(const layout *l, unsigned tag, unsigned type, uint64_t count,
                        uint64_t value) {
    ptie_write_le(l->out, tag, 2);
    ptie_write_le(l->out, type, 2);
    write_offset(l, count);
    write_offset(l, value);
}

/* A directory ends with the offset of the next: right behind it, or 0.  Returns its size. */
static uint64_t write_directory(const layout *l, uint64_t frame, uint64_t at) {
    const uint64_t entries = frame == 0 ? 14 : 13;
    const uint64_t bytes = l->big ? 8 + 20 * entries + 8 : 2 + 12 * entries + 4;
    const uint64_t resolution =
        l->big ? l->resolution : l->resolution_at; /* 8 bytes fit into an entry */
    const unsigned offset_type = l->big ? LONG8 : LONG;
    ptie_write_le(l->out, entries, l->big ? 8 : 2);
    write_entry(l, 256, LONG, 1, l->width);
    write_entry(l, 257, LONG, 1, l->height);
    write_entry(l, 258, SHORT, 1, 8 * l->stored.bytes); /* bits per sample */
    write_entry(l, 259, SHORT, 1, 1);  /* no compression */
    write_entry(l, 262, SHORT, 1, 1);  /* 0 is black */
    if (frame == 0) write_entry(l, 270, ASCII, l->text_bytes, l->text_at);
    write_entry(l, 273, offset_type, 1,
                PTIE_TIFF_DATA + frame * l->frame_bytes); /* the only strip */
    write_entry(l, 277, SHORT, 1, 1);                     /* samples per pixel */
    write_entry(l, 278, LONG, 1, l->height);              /* rows per strip */
    write_entry(l, 279, offset_type, 1, l->frame_bytes);
    write_entry(l, 282, RATIONAL, 1, resolution);
    write_entry(l, 283, RATIONAL, 1, resolution);
    write_entry(l, 296, SHORT, 1, 1); /* the description names the unit */
    write_entry(l, 339, SHORT, 1, l->stored.kind == 'f' ? 3 : 1); /* IEEE floating point, unsigned */
    write_offset(l, frame + 1 < l->frames ? at + bytes : 0);
    return bytes;
}

static layout plan(FILE *out, const ptie_writer_job *job, uint64_t text_length, uint64_t largest) {
    const uint64_t frames = (uint64_t)job->info.frames, frame_bytes = ptie_job_bytes(job);
    const uint64_t data_end = PTIE_TIFF_DATA + frames * frame_bytes;
    const uint64_t text_bytes = (text_length + 8) / 8 * 8; /* at least one NUL */
    return (layout){.out = out,
                    .big = data_end + text_bytes + frames * DIRECTORY_BYTES > largest,
                    .width = (uint64_t)job->info.width_px,
                    .height = (uint64_t)job->info.height_px,
                    .frames = frames,
                    .frame_bytes = frame_bytes,
                    .stored = job->stored,
                    .text_at = data_end,
                    .text_bytes = text_bytes,
                    .resolution = resolution_of(job->info.pixel_m),
                    .resolution_at = data_end + text_bytes};
}

ptie_status ptie_tiff_write_tail(FILE *out, const ptie_writer_job *job, uint64_t largest) {
    ptie_text text = {0};
    describe(&text, job);
    if (text.failed) {
        ptie_text_free(&text);
        return PTIE_FAIL(PTIE_ENOMEM, "TIFF description: out of memory");
    }
    const layout l = plan(out, job, text.length, largest);
    fwrite(text.data, 1, text.length, out);
    for (uint64_t i = text.length; i < l.text_bytes; i++) fputc(0, out);
    ptie_write_le(out, l.resolution, 8);
    const uint64_t first = l.resolution_at + 8;
    uint64_t at = first;
    for (uint64_t frame = 0; frame < l.frames; frame++) at += write_directory(&l, frame, at);
    ptie_text_free(&text);
    PTIE_TRY(ptie_stream_restart(out, job->path));
    write_header(&l, first);
    return PTIE_OK;
}
