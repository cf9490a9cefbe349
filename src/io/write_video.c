/* SPDX-License-Identifier: BSD-3-Clause */
/* Video: YUV4MPEG2 of our own, and MP4 by sending the same to ffmpeg.  Values from job->low to job->high become 256 levels,
 * and these grey or colours.  Without a range, bytes are what they are, and others are scaled by the first frame.
 */
#include <math.h>
#include <string.h>

#include "base/image.h"
#include "base/memory.h"
#include "io/encoder.h"
#include "io/stream.h"
#include "io/writer.h"

#define PLAYED_HZ 25.0

enum { LEVELS = 256, MARK_BYTES = 6 }; /* "FRAME\n" */

typedef struct video {
    const ptie_writer_job *job;
    ptie_stream stream;     /* Y4M; for MP4 only its file is open */
    ptie_encoder *encoder;  /* MP4 */
    size_t pixels, planes;  /* 1: grey, 3: Y' Cb Cr */
    bool ranged;            /* low and high are known */
    double low, high;
    unsigned char level[3][LEVELS]; /* of each plane */
    unsigned char *frame;           /* the mark, then the planes */
} video;

/* ITU-R BT.601, 16..235 for Y' and 16..240 for Cb and Cr. */
static void convert_colour(video *v, int level, uint32_t colour) {
    const double r = (colour >> 16 & 255) / 255.0, g = (colour >> 8 & 255) / 255.0,
                 b = (colour & 255) / 255.0;
    v->level[0][level] = (unsigned char)lrint(16 + 65.481 * r + 128.553 * g + 24.966 * b);
    v->level[1][level] = (unsigned char)lrint(128 - 37.797 * r - 74.203 * g + 112 * b);
    v->level[2][level] = (unsigned char)lrint(128 + 112 * r - 93.786 * g - 18.214 * b);
}

static void make_levels(video *v) {
    for (int level = 0; level < LEVELS; level++) {
        v->level[0][level] = (unsigned char)level; /* grey uses all 256 */
        if (v->job->colours) convert_colour(v, level, v->job->colours[level]);
    }
}

static ptie_status put(video *v, const void *bytes, size_t count) {
    if (v->encoder) return ptie_encoder_write(v->encoder, bytes, count);
    fwrite(bytes, 1, count, v->stream.out);
    return ptie_stream_check(&v->stream);
}

static ptie_status write_header(video *v) {
    const ptie_writer_job *job = v->job;
    const double rate = job->played_hz > 0 ? job->played_hz : PLAYED_HZ;
    long long above = llround(1000 * rate), below = 1000;
    while (below > 1 && above % 10 == 0) above /= 10, below /= 10;
    char header[160];
    int length = snprintf(header, sizeof header, "YUV4MPEG2 W%d H%d F%lld:%lld Ip A1:1 %s\n",
                          job->info.width_px, job->info.height_px, above, below,
                          v->planes == 1 ? "Cmono XCOLORRANGE=FULL" : "C444 XCOLORRANGE=LIMITED");
    return put(v, header, (size_t)length);
}

static void video_discard(void *state) {
    video *v = state;
    ptie_encoder_stop(v->encoder);
    ptie_stream_discard(&v->stream);
    ptie_free(v->frame);
    ptie_free(v);
}

static ptie_status prepare(video *v) {
    const ptie_writer_job *job = v->job;
    v->planes = job->colours ? 3 : 1;
    v->pixels = (size_t)job->info.width_px * (size_t)job->info.height_px;
    v->ranged = job->low < job->high;
    v->low = job->low;
    v->high = job->high;
    if (!v->ranged && job->stored.bytes == 1) v->ranged = true, v->low = 0, v->high = LEVELS - 1;
    make_levels(v);
    PTIE_TRY(ptie_alloc_status(&v->frame, MARK_BYTES + v->planes * v->pixels, 1, job->path));
    memcpy(v->frame, "FRAME\n", MARK_BYTES);
    return PTIE_OK;
}

static ptie_status open_y4m(video *v) {
    return ptie_stream_open(&v->stream, v->job->path, v->job->overwrite);
}

static ptie_status open_mp4(video *v) {
    PTIE_TRY(ptie_output_open(&v->stream.file, v->job->path, v->job->overwrite));
    return ptie_encoder_start(&v->encoder, v->job->path, v->stream.file.part);
}

static ptie_status create(void **state, const ptie_writer_job *job, ptie_status (*open)(video *)) {
    video *v;
    *state = NULL;
    PTIE_TRY(ptie_alloc_status(&v, 1, sizeof *v, job->path));
    v->job = job;
    ptie_status status = prepare(v);
    if (status == PTIE_OK) status = open(v);
    if (status == PTIE_OK) status = write_header(v);
    if (status != PTIE_OK) {
        video_discard(v);
        return status;
    }
    *state = v;
    return PTIE_OK;
}

static ptie_status y4m_create(void **state, const ptie_writer_job *job) {
    return create(state, job, open_y4m);
}

static ptie_status mp4_create(void **state, const ptie_writer_job *job) {
    return create(state, job, open_mp4);
}

static ptie_status video_append(void *state, const float *frame) {
    video *v = state;
    PTIE_TRY(ptie_image_finite(frame, v->job->info.width_px, v->job->info.height_px, v->job->path));
    if (!v->ranged) {
        const ptie_extent extent = ptie_image_extent(frame, v->pixels);
        v->ranged = true;
        v->low = (double)extent.low;
        v->high = (double)extent.high;
    }
    const double scale = v->high > v->low ? (LEVELS - 1) / (v->high - v->low) : 0;
    unsigned char *planes = v->frame + MARK_BYTES;
    for (size_t i = 0; i < v->pixels; i++) {
        const double level = scale * ((double)frame[i] - v->low);
        const long at = lrint(fmin(fmax(level, 0), LEVELS - 1));
        for (size_t p = 0; p < v->planes; p++) planes[p * v->pixels + i] = v->level[p][at];
    }
    return put(v, v->frame, MARK_BYTES + v->planes * v->pixels);
}

static ptie_status y4m_complete(void *state, int64_t frames) {
    (void)frames;
    video *v = state;
    ptie_status status = ptie_stream_complete(&v->stream);
    video_discard(v); /* what is left of it */
    return status;
}

static ptie_status mp4_complete(void *state, int64_t frames) {
    (void)frames;
    video *v = state;
    ptie_status status = ptie_encoder_finish(v->encoder);
    v->encoder = NULL;
    if (status == PTIE_OK) status = ptie_output_commit(&v->stream.file);
    video_discard(v); /* what is left of it */
    return status;
}

const ptie_writer_format ptie_write_y4m = {.endings = {".y4m"},
                                           .create = y4m_create,
                                           .append = video_append,
                                           .complete = y4m_complete,
                                           .discard = video_discard,
                                           .needs_range = true};
const ptie_writer_format ptie_write_mp4 = {.endings = {".mp4"},
                                           .create = mp4_create,
                                           .append = video_append,
                                           .complete = mp4_complete,
                                           .discard = video_discard,
                                           .needs_range = true};
