/* SPDX-License-Identifier: BSD-3-Clause */
/* NumPy's .npy: (T, H, W), the data at byte 128.  T is filled in at the end. */
#include <string.h>

#include "base/memory.h"
#include "io/stream.h"
#include "io/writer.h"

#define HEADER_BYTES 128

typedef struct npy_output {
    ptie_stream stream;
    const ptie_writer_job *job;
    unsigned char *samples; /* a frame as stored */
} npy_output;

static void write_header(const npy_output *npy, int64_t frames) {
    const ptie_sample stored = npy->job->stored;
    char header[HEADER_BYTES + 1] = "\x93NUMPY\x01";
    header[8] = HEADER_BYTES - 10; /* little-endian u16: what follows */
    int used = snprintf(header + 10, sizeof header - 10,
                        "{'descr': '%c%c%zu', 'fortran_order': False, 'shape': (%lld, %d, %d), }",
                        stored.bytes == 1 ? '|' : '<', stored.kind, stored.bytes,
                        (long long)frames, npy->job->info.height_px, npy->job->info.width_px);
    memset(header + 10 + used, ' ', HEADER_BYTES - 10 - (size_t)used);
    header[HEADER_BYTES - 1] = '\n';
    fwrite(header, 1, HEADER_BYTES, npy->stream.out);
}

static void npy_discard(void *state) {
    npy_output *npy = state;
    ptie_stream_discard(&npy->stream);
    ptie_free(npy->samples);
    ptie_free(npy);
}

static ptie_status npy_create(void **state, const ptie_writer_job *job) {
    npy_output *npy;
    *state = NULL;
    PTIE_TRY(ptie_alloc_status(&npy, 1, sizeof *npy, job->path));
    npy->job = job;
    ptie_status status = ptie_alloc_status(&npy->samples, ptie_job_bytes(job), 1, job->path);
    if (status == PTIE_OK) status = ptie_stream_open(&npy->stream, job->path, job->overwrite);
    if (status != PTIE_OK) {
        npy_discard(npy);
        return status;
    }
    write_header(npy, job->info.frames);
    *state = npy;
    return PTIE_OK;
}

static ptie_status npy_append(void *state, const float *frame) {
    const npy_output *npy = state;
    PTIE_TRY(ptie_job_encode(npy->job, npy->samples, frame));
    fwrite(npy->samples, 1, ptie_job_bytes(npy->job), npy->stream.out);
    return ptie_stream_check(&npy->stream);
}

static ptie_status npy_complete(void *state, int64_t frames) {
    npy_output *npy = state;
    ptie_status status = ptie_stream_restart(npy->stream.out, npy->job->path);
    if (status == PTIE_OK) {
        write_header(npy, frames);
        status = ptie_stream_complete(&npy->stream);
    }
    npy_discard(npy); /* what is left of it */
    return status;
}

const ptie_writer_format ptie_write_npy = {.endings = {".npy"},
                                           .create = npy_create,
                                           .append = npy_append,
                                           .complete = npy_complete,
                                           .discard = npy_discard};
