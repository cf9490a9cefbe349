/* SPDX-License-Identifier: BSD-3-Clause */
/* TIFF, one page per frame, as ImageJ and Fiji scale it.  Written here rather than by
 * libtiff: the frames follow each other without gaps from byte 16 on and the directories come last,
 * so that a file of any number of frames is written in one pass, may be mapped into memory, and
 * becomes BigTIFF only if it must.
 */
#include "base/memory.h"
#include "io/stream.h"
#include "io/tiff_tail.h"
#include "io/writer.h"

typedef struct tiff_output {
    ptie_stream stream;
    const ptie_writer_job *job;
    unsigned char *samples; /* a frame as stored */
} tiff_output;

static void tiff_discard(void *state) {
    tiff_output *tiff = state;
    ptie_stream_discard(&tiff->stream);
    ptie_free(tiff->samples);
    ptie_free(tiff);
}

static ptie_status tiff_create(void **state, const ptie_writer_job *job) {
    static const char space[PTIE_TIFF_DATA] = {0};
    tiff_output *tiff;
    *state = NULL;
    PTIE_TRY(ptie_alloc_status(&tiff, 1, sizeof *tiff, job->path));
    tiff->job = job;
    ptie_status status = ptie_alloc_status(&tiff->samples, ptie_job_bytes(job), 1, job->path);
    if (status == PTIE_OK) status = ptie_stream_open(&tiff->stream, job->path, job->overwrite);
    if (status != PTIE_OK) {
        tiff_discard(tiff);
        return status;
    }
    fwrite(space, 1, sizeof space, tiff->stream.out);
    *state = tiff;
    return PTIE_OK;
}

static ptie_status tiff_append(void *state, const float *frame) {
    const tiff_output *tiff = state;
    PTIE_TRY(ptie_job_encode(tiff->job, tiff->samples, frame));
    fwrite(tiff->samples, 1, ptie_job_bytes(tiff->job), tiff->stream.out);
    return ptie_stream_check(&tiff->stream);
}

static ptie_status tiff_complete(void *state, int64_t frames) {
    tiff_output *tiff = state;
    ptie_writer_job job = *tiff->job;
    job.info.frames = frames;
    ptie_status status = ptie_tiff_write_tail(tiff->stream.out, &job, PTIE_TIFF_LARGEST);
    if (status == PTIE_OK) status = ptie_stream_complete(&tiff->stream);
    tiff_discard(tiff); /* what is left of it */
    return status;
}

const ptie_writer_format ptie_write_tiff = {.endings = {".tif", ".tiff"},
                                            .create = tiff_create,
                                            .append = tiff_append,
                                            .complete = tiff_complete,
                                            .discard = tiff_discard};
