/* SPDX-License-Identifier: BSD-3-Clause */
/* Finds the format of an output path and keeps count of its frames. */
#include "io/writer.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "base/text.h"
#include "io/recording.h"

struct ptie_writer {
    const ptie_writer_format *format;
    void *state;
    ptie_writer_job job;
    char *path, *name; /* owned; the job points to them */
    int64_t written;
    bool failed;
};

static const ptie_writer_format *find_format(const char *path) {
    static const ptie_writer_format *const formats[] = {
        &ptie_write_h5,  &ptie_write_mat, &ptie_write_mp4,  &ptie_write_mraw,
        &ptie_write_npy, &ptie_write_png, &ptie_write_tiff, &ptie_write_y4m};
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < sizeof formats / sizeof *formats; i++)
        for (const char *const *ending = formats[i]->endings; *ending; ending++)
            if (strcasecmp(dot, *ending) == 0) return formats[i];
    return NULL;
}

bool ptie_io_needs_range(const char *path) {
    const ptie_writer_format *format = find_format(path);
    return format && format->needs_range;
}

static void writer_free(ptie_writer *writer) {
    ptie_free(writer->path);
    ptie_free(writer->name);
    ptie_free(writer);
}

/* Integers of up to 16 bits ("u16", "u12 packed") stay what they are; everything else is float32. */
static ptie_sample stored_sample(const char *sample) {
    char digits[8];
    int64_t bits;
    snprintf(digits, sizeof digits, "%.*s", sample[0] ? (int)strcspn(sample + 1, " ") : 0, sample + 1);
    if (sample[0] != 'u' || !ptie_parse_integer(digits, 1, 16, &bits))
        return (ptie_sample){'f', sizeof(float)};
    return (ptie_sample){'u', bits > 8 ? 2 : 1};
}

size_t ptie_job_bytes(const ptie_writer_job *job) {
    return (size_t)job->info.width_px * (size_t)job->info.height_px * job->stored.bytes;
}

ptie_status ptie_job_encode(const ptie_writer_job *job, unsigned char *bytes, const float *frame) {
    const size_t width = (size_t)job->info.width_px, count = width * (size_t)job->info.height_px;
    const size_t stored = ptie_sample_store(bytes, frame, count, job->stored);
    if (stored == count) return PTIE_OK;
    return PTIE_FAIL(PTIE_ENUMERIC, "%s: value cannot be stored (at x=%zu, y=%zu expected a whole number "
                     "of %zu bits, found %.9g)", job->path, stored % width, stored / width,
                     8 * job->stored.bytes, (double)frame[stored]);
}

ptie_status ptie_io_create(ptie_writer **out, const ptie_writer_job *job) {
    ptie_writer *writer;
    const char *path = job->path;
    *out = NULL;
    const ptie_writer_format *format = find_format(path);
    if (!format)
        return PTIE_FAIL(
            PTIE_EUNSUPPORTED,
            "%s: cannot write this kind of file (expected .npy .tif .tiff .h5 .hdf5 .png .mat .y4m .mp4 or .mraw)",
            path);
    PTIE_TRY(ptie_alloc_status(&writer, 1, sizeof *writer, path));
    writer->format = format;
    writer->path = ptie_strdup(path);
    writer->name = ptie_strdup(job->name);
    writer->job = *job;
    writer->job.path = writer->path;
    writer->job.name = writer->name;
    writer->job.stored = stored_sample(job->info.sample);
    ptie_status status = writer->path && writer->name
                             ? format->create(&writer->state, &writer->job)
                             : PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", path);
    if (status != PTIE_OK) {
        writer_free(writer);
        return status;
    }
    *out = writer;
    return PTIE_OK;
}

bool ptie_io_has_columns(const ptie_writer *writer) {
    return writer->format->add_column != NULL;
}

ptie_status ptie_io_add_column(ptie_writer *writer, const char *path, const double *values, int64_t count) {
    return writer->format->add_column(writer->state, path, values, count);
}

ptie_status ptie_io_append(ptie_writer *writer, const float *frame) {
    const int64_t planned = writer->job.info.frames;
    if (planned > 0 && writer->written == planned)
        return PTIE_FAIL(PTIE_ESTATE, "%s: too many frames (expected %lld)", writer->path,
                         (long long)planned);
    ptie_status status = writer->format->append(writer->state, frame);
    if (status == PTIE_OK)
        writer->written++;
    else
        writer->failed = true;
    return status;
}

/* Is there what was announced? */
static ptie_status check_frames(const ptie_writer *writer) {
    const int64_t planned = writer->job.info.frames;
    if (writer->failed)
        return PTIE_FAIL(PTIE_EIO, "%s: cannot complete the file: a frame could not be written",
                         writer->path);
    if (writer->written == 0 || (planned > 0 && writer->written < planned))
        return PTIE_FAIL(PTIE_ESTATE, "%s: too few frames (expected %lld, found %lld)",
                         writer->path, (long long)(planned > 0 ? planned : 1),
                         (long long)writer->written);
    return PTIE_OK;
}

ptie_status ptie_io_complete(ptie_writer *writer) {
    ptie_status status = check_frames(writer);
    if (status == PTIE_OK)
        status = writer->format->complete(writer->state, writer->written);
    else
        writer->format->discard(writer->state);
    writer_free(writer);
    return status;
}

void ptie_io_discard(ptie_writer *writer) {
    if (!writer) return;
    writer->format->discard(writer->state);
    writer_free(writer);
}
