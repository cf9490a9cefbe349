/* SPDX-License-Identifier: BSD-3-Clause */
/* Photron MRAW, 12 bits packed or 16, and the CIHX file beside it: what a camera would have
 * written. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/image.h"
#include "base/memory.h"
#include "io/cihx.h"
#include "io/stream.h"
#include "io/writer.h"

#define BLOCK 4096 /* samples coded at a time; even */

typedef struct mraw_output {
    ptie_stream data, header;
    ptie_recording_info info;
    int color_bit;
} mraw_output;

static void mraw_discard(void *state) {
    mraw_output *mraw = state;
    ptie_stream_discard(&mraw->data);
    ptie_stream_discard(&mraw->header);
    ptie_free(mraw);
}

/* "X.cihx" of "X.mraw". */
static ptie_status open_header(mraw_output *mraw, const ptie_writer_job *job) {
    const size_t stem = (size_t)(strrchr(job->path, '.') - job->path),
                 bytes = stem + sizeof ".cihx";
    char *path;
    PTIE_TRY(ptie_alloc_status(&path, bytes, 1, job->path));
    snprintf(path, bytes, "%.*s.cihx", (int)stem, job->path);
    const ptie_status status = ptie_stream_open(&mraw->header, path, job->overwrite);
    ptie_free(path);
    return status;
}

/* 12 bits in use are packed unless 16-bit samples are asked for; without a depth there are 12. */
static ptie_status choose_bits(mraw_output *mraw, const ptie_writer_job *job) {
    mraw->info = job->info;
    if (mraw->info.bit_depth == 0)
        mraw->info.bit_depth = strcmp(job->info.sample, "u16") == 0 ? 16 : 12;
    const bool packed = mraw->info.bit_depth == 12 && strcmp(job->info.sample, "u16") != 0;
    mraw->color_bit = packed ? 12 : 16;
    if (mraw->info.bit_depth >= 1 && mraw->info.bit_depth <= 16) return PTIE_OK;
    return PTIE_FAIL(PTIE_EUNSUPPORTED, "%s: bit depth (expected 1 to 16, found %d)", job->path,
                     mraw->info.bit_depth);
}

static ptie_status mraw_create(void **state, const ptie_writer_job *job) {
    mraw_output *mraw;
    *state = NULL;
    PTIE_TRY(ptie_alloc_status(&mraw, 1, sizeof *mraw, job->path));
    ptie_status status = choose_bits(mraw, job);
    if (status == PTIE_OK) status = ptie_stream_open(&mraw->data, job->path, job->overwrite);
    if (status == PTIE_OK) status = open_header(mraw, job);
    if (status != PTIE_OK) {
        mraw_discard(mraw);
        return status;
    }
    *state = mraw;
    return PTIE_OK;
}

/* The nearest count a camera of this depth could deliver. */
static unsigned count_of(float value, float largest) {
    const float clipped = value < 0 ? 0 : value > largest ? largest : value;
    return (unsigned)(clipped + 0.5f);
}

/* Two samples in three bytes, most significant bits first; a last one alone takes two.  Returns the
 * bytes. */
static size_t code_12(unsigned char *out, const float *in, size_t count) {
    for (size_t i = 0; i < count; i += 2, out += 3) {
        const unsigned a = count_of(in[i], 4095), b = i + 1 < count ? count_of(in[i + 1], 4095) : 0;
        out[0] = (unsigned char)(a >> 4);
        out[1] = (unsigned char)(a << 4 | b >> 8);
        if (i + 1 < count) out[2] = (unsigned char)b;
    }
    return (3 * count + 1) / 2;
}

static size_t code_16(unsigned char *out, const float *in, size_t count, float largest) {
    for (size_t i = 0; i < count; i++) {
        const unsigned value = count_of(in[i], largest);
        out[2 * i] = (unsigned char)value;
        out[2 * i + 1] = (unsigned char)(value >> 8);
    }
    return 2 * count;
}

static ptie_status mraw_append(void *state, const float *frame) {
    const mraw_output *mraw = state;
    const size_t count = (size_t)mraw->info.width_px * (size_t)mraw->info.height_px;
    const float largest = (float)((1 << mraw->info.bit_depth) - 1);
    unsigned char block[2 * BLOCK];
    PTIE_TRY(
        ptie_image_finite(frame, mraw->info.width_px, mraw->info.height_px, mraw->data.file.path));
    for (size_t done = 0; done < count; done += BLOCK) {
        const size_t now = count - done < BLOCK ? count - done : BLOCK;
        const size_t bytes = mraw->color_bit == 12 ? code_12(block, frame + done, now)
                                                   : code_16(block, frame + done, now, largest);
        fwrite(block, 1, bytes, mraw->data.out);
    }
    return ptie_stream_check(&mraw->data);
}

/* The header comes last: without it the frames are not a recording. */
static ptie_status complete_both(mraw_output *mraw) {
    char *path = ptie_strdup(mraw->data.file.path);
    if (!path) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", mraw->data.file.path);
    ptie_status status = ptie_stream_complete(&mraw->data);
    if (status == PTIE_OK) {
        status = ptie_stream_complete(&mraw->header);
        if (status != PTIE_OK) remove(path);
    }
    ptie_free(path);
    return status;
}

static ptie_status mraw_complete(void *state, int64_t frames) {
    mraw_output *mraw = state;
    mraw->info.frames = frames;
    ptie_status status = ptie_cihx_write(mraw->header.out, &mraw->info, mraw->color_bit);
    if (status == PTIE_OK) status = ptie_stream_check(&mraw->header);
    if (status == PTIE_OK) status = complete_both(mraw);
    mraw_discard(mraw); /* what is left of it */
    return status;
}

const ptie_writer_format ptie_write_mraw = {.endings = {".mraw"},
                                            .create = mraw_create,
                                            .append = mraw_append,
                                            .complete = mraw_complete,
                                            .discard = mraw_discard};
