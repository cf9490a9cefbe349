/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/recording.h>: arguments checked, then inward. */
#include <ptie/recording.h>

#include <string.h>

#include "api/params.h"
#include "io/recording.h"

ptie_status ptie_recording_open(ptie_recording **out, const char *path) {
    static const char where[] = "ptie_recording_open";
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    *out = NULL;
    PTIE_TRY(ptie_check_pointer(path, where, "path"));
    return ptie_io_open(out, path);
}

void ptie_recording_close(ptie_recording *recording) {
    ptie_io_close(recording);
}

const ptie_recording_info *ptie_recording_get_info(const ptie_recording *recording) {
    return recording ? ptie_io_info(recording) : NULL;
}

ptie_status ptie_recording_describe(ptie_recording_info *info, const char *path) {
    static const char where[] = "ptie_recording_describe";
    PTIE_TRY(ptie_check_pointer(info, where, "info"));
    PTIE_TRY(ptie_check_pointer(path, where, "path"));
    return ptie_io_describe(info, path);
}

ptie_status ptie_recording_read(ptie_recording *recording, int64_t frame, float *data) {
    static const char where[] = "ptie_recording_read";
    PTIE_TRY(ptie_check_pointer(recording, where, "recording"));
    PTIE_TRY(ptie_check_pointer(data, where, "data"));
    PTIE_TRY(ptie_check_integer(frame, 0, ptie_io_info(recording)->frames - 1, where, "frame"));
    return ptie_io_read(recording, frame, data);
}

static ptie_status check_text(const char *text, size_t bytes, const char *where, const char *name) {
    if (memchr(text, 0, bytes)) return PTIE_OK;
    return PTIE_FAIL(PTIE_EINVAL, "%s: %s is not terminated (expected at most %zu bytes)", where,
                     name, bytes - 1);
}

static ptie_status check_texts(const ptie_recording_info *info, const char *where) {
    PTIE_TRY(check_text(info->unit, sizeof info->unit, where, "unit"));
    PTIE_TRY(check_text(info->sample, sizeof info->sample, where, "sample"));
    PTIE_TRY(check_text(info->camera, sizeof info->camera, where, "camera"));
    PTIE_TRY(check_text(info->date, sizeof info->date, where, "date"));
    return check_text(info->comment, sizeof info->comment, where, "comment");
}

static ptie_status check_info(const ptie_recording_info *info, const char *where) {
    PTIE_TRY(ptie_check_pointer(info, where, "info"));
    PTIE_TRY(ptie_check_integer(info->width_px, 1, 32768, where, "width_px"));
    PTIE_TRY(ptie_check_integer(info->height_px, 1, 32768, where, "height_px"));
    PTIE_TRY(ptie_check_integer(info->frames, 0, INT64_MAX, where, "frames"));
    PTIE_TRY(ptie_check_number(info->frame_rate_hz, 0, 1e15, where, "frame_rate_hz"));
    PTIE_TRY(ptie_check_number(info->pixel_m, 0, 1, where, "pixel_m"));
    PTIE_TRY(ptie_check_number(info->exposure_s, 0, 1e6, where, "exposure_s"));
    PTIE_TRY(ptie_check_integer(info->bit_depth, 0, 64, where, "bit_depth"));
    PTIE_TRY(ptie_check_integer(info->roi_x_px, 0, 32768, where, "roi_x_px"));
    PTIE_TRY(ptie_check_integer(info->roi_y_px, 0, 32768, where, "roi_y_px"));
    PTIE_TRY(ptie_check_integer(info->skip, 0, INT32_MAX, where, "skip"));
    return check_texts(info, where);
}

ptie_status ptie_writer_create(ptie_writer **out, const char *path, const char *name,
                               const ptie_recording_info *info, bool overwrite) {
    static const char where[] = "ptie_writer_create";
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    *out = NULL;
    PTIE_TRY(ptie_check_pointer(path, where, "path"));
    PTIE_TRY(ptie_check_name(name, where));
    PTIE_TRY(check_info(info, where));
    return ptie_io_create(out, &(ptie_writer_job){
                                   .path = path, .name = name, .info = *info, .overwrite = overwrite});
}

ptie_status ptie_writer_append(ptie_writer *writer, const float *frame) {
    static const char where[] = "ptie_writer_append";
    PTIE_TRY(ptie_check_pointer(writer, where, "writer"));
    PTIE_TRY(ptie_check_pointer(frame, where, "frame"));
    return ptie_io_append(writer, frame);
}

ptie_status ptie_writer_close(ptie_writer *writer) {
    PTIE_TRY(ptie_check_pointer(writer, "ptie_writer_close", "writer"));
    return ptie_io_complete(writer);
}

void ptie_writer_discard(ptie_writer *writer) {
    ptie_io_discard(writer);
}
