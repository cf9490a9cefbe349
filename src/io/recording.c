/* SPDX-License-Identifier: BSD-3-Clause */
/* Finds the reader of a path and checks what it delivers. */
#include "io/recording.h"

#include <string.h>
#include <unistd.h>

#include "base/image.h"
#include "base/memory.h"
#include "io/input.h"
#include "io/reader.h"

struct ptie_recording {
    const ptie_reader *reader;
    void *state;
    char *path; /* as given, for messages */
    ptie_recording_info info;
};

ptie_status ptie_info_set_size(ptie_recording_info *info, const char *path, uint64_t width,
                               uint64_t height) {
    if (width < 1 || height < 1)
        return PTIE_FAIL(PTIE_EFORMAT,
                         "%s: empty frame (expected at least 1 x 1 px, found %llu x %llu)", path,
                         (unsigned long long)width, (unsigned long long)height);
    if (width > PTIE_LONGEST_SIDE || height > PTIE_LONGEST_SIDE)
        return PTIE_FAIL(PTIE_EUNSUPPORTED,
                         "%s: frame too large (expected at most %d px a side, found %llu x %llu)",
                         path, PTIE_LONGEST_SIDE, (unsigned long long)width,
                         (unsigned long long)height);
    info->width_px = (int32_t)width;
    info->height_px = (int32_t)height;
    return PTIE_OK;
}

void ptie_info_set_frames(ptie_recording_info *info, int64_t there, int64_t announced) {
    info->frames = there < announced ? there : announced;
    info->recorded = announced;
    if (there < announced)
        snprintf(info->warning, sizeof info->warning, "file is cut short: %lld of %lld frames are there",
                 (long long)there, (long long)announced);
}

ptie_status ptie_check_fits(const char *path, uint64_t needed, uint64_t found, uint64_t densest) {
    if (needed / densest <= found) return PTIE_OK;
    return PTIE_FAIL(PTIE_EFORMAT,
                     "%s: file too short for its frames (expected %llu bytes, found %llu)", path,
                     (unsigned long long)(needed / densest), (unsigned long long)found);
}

/* Splits "file.h5:/path/in/file" in place; returns the part inside the file, or "".  A colon that
   belongs to the name of an existing file stays. */
static const char *split_path(char *path) {
    if (access(path, F_OK) == 0) return "";
    for (size_t i = strlen(path); i-- > 0;) {
        if (strncmp(path + i, ":/", 2) != 0) continue;
        path[i] = 0;
        if (access(path, F_OK) == 0) return path + i + 1;
        path[i] = ':';
    }
    return "";
}

/* Is it this reader's?  head: NULL while only those are asked that go by the path. */
static bool is_kind(const ptie_reader *reader, const char *path, const unsigned char *head) {
    return head ? reader->probe && reader->probe(head) : reader->claims && reader->claims(path);
}

/* NULL if there is none. */
static const ptie_reader *choose(const char *path, const unsigned char *head) {
    static const ptie_reader *const readers[] = {
        &ptie_read_sequence, &ptie_read_mraw, &ptie_read_raw, &ptie_read_cine, &ptie_read_npy,
        &ptie_read_png,      &ptie_read_tiff, &ptie_read_h5,  &ptie_read_mat};
    for (size_t i = 0; i < sizeof readers / sizeof *readers; i++)
        if (is_kind(readers[i], path, head)) return readers[i];
    return NULL;
}

static ptie_status find_reader(const ptie_reader **out, const char *path, const char *inside) {
    unsigned char head[PTIE_HEAD_BYTES];
    const ptie_reader *reader = choose(path, NULL);
    if (!reader) {
        PTIE_TRY(ptie_input_head(path, head, sizeof head));
        reader = choose(path, head);
    }
    if (!reader)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: unknown kind of file (expected MRAW, CINE, NPY, PNG, TIFF, HDF5, MAT or raw)", path);
    if (*inside && !reader->takes_inside)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: %s files have no data sets (expected no ':', found ':%s')",
                         path, reader->name, inside);
    *out = reader;
    return PTIE_OK;
}

static ptie_status open_reader(ptie_recording *recording, char *file) {
    const char *inside = split_path(file);
    PTIE_TRY(find_reader(&recording->reader, file, inside));
    memcpy(recording->info.format, recording->reader->name, strlen(recording->reader->name));
    return recording->reader->open(&recording->state, &recording->info, file, inside);
}

ptie_status ptie_io_open(ptie_recording **out, const char *path) {
    ptie_recording *recording;
    *out = NULL;
    PTIE_TRY(ptie_alloc_status(&recording, 1, sizeof *recording, path));
    recording->path = ptie_strdup(path);
    recording->info.frame_step = 1;
    char *file = ptie_strdup(path);
    ptie_status status = recording->path && file
                             ? open_reader(recording, file)
                             : PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", path);
    ptie_free(file);
    if (status != PTIE_OK) {
        ptie_io_close(recording);
        return status;
    }
    *out = recording;
    return PTIE_OK;
}

ptie_status ptie_io_choose(int64_t *count, ptie_frame_range range, int64_t recorded, const char *path) {
    const int64_t end = range.end ? range.end : recorded;
    if (range.first >= recorded)
        return PTIE_FAIL(PTIE_EINVAL, "%s: first frame out of range (expected 0..%lld, found %lld)", path,
                         (long long)recorded - 1, (long long)range.first);
    if (end > recorded || end <= range.first)
        return PTIE_FAIL(PTIE_EINVAL, "%s: end of the frames out of range (expected %lld..%lld, found %lld)",
                         path, (long long)range.first + 1, (long long)recorded, (long long)end);
    *count = (end - range.first - 1) / range.step + 1;
    return PTIE_OK;
}

ptie_status ptie_io_describe(ptie_recording_info *info, const char *path) {
    ptie_recording *recording;
    *info = (ptie_recording_info){.frame_step = 1};
    const ptie_status status = ptie_io_open(&recording, path);
    if (status == PTIE_OK) {
        *info = recording->info;
        ptie_io_close(recording);
        return PTIE_OK;
    }
    const ptie_reader *reader = choose(path, NULL);
    if (status != PTIE_EIO || !reader || !reader->describe) return status;
    snprintf(info->format, sizeof info->format, "%s", reader->name);
    return reader->describe(info, path);
}

bool ptie_io_has_data_sets(const char *path) {
    const ptie_reader *reader;
    return find_reader(&reader, path, "") == PTIE_OK && reader->has_data_sets;
}

void ptie_io_close(ptie_recording *recording) {
    if (!recording) return;
    if (recording->reader) recording->reader->close(recording->state);
    ptie_free(recording->path);
    ptie_free(recording);
}

const ptie_recording_info *ptie_io_info(const ptie_recording *recording) {
    return &recording->info;
}

ptie_status ptie_io_read(ptie_recording *recording, int64_t frame, float *data) {
    char where[PTIE_MESSAGE_BYTES];
    PTIE_TRY(recording->reader->read(recording->state, frame, data));
    snprintf(where, sizeof where, "%s: frame %lld", recording->path, (long long)frame);
    return ptie_image_finite(data, recording->info.width_px, recording->info.height_px, where);
}
