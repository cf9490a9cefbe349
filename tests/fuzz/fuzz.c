/* SPDX-License-Identifier: BSD-3-Clause */
#include "fuzz.h"

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "io/input.h"
#include "io/reader.h"
#include "io/recording.h"
#include "support/support.h"

#define MOST_FILES 4
#define MOST_PIXELS (1 << 18) /* read of larger frames only what they say */

void fuzz_check(bool condition, const char *text, const char *file, int line) {
    if (condition) return;
    fprintf(stderr, "%s:%d: not so: %s\n    last message: %s\n", file, line, text, ptie_last_error());
    abort();
}

const char *fuzz_file(const char *name, const void *data, size_t bytes) {
    static struct {
        const char *name;
        char path[1024];
        int descriptor;
    } files[MOST_FILES];
    size_t i = 0;
    while (i < MOST_FILES && files[i].name && strcmp(files[i].name, name) != 0) i++;
    FUZZ_CHECK(i < MOST_FILES);
    if (!files[i].name) {
        files[i].name = name;
        snprintf(files[i].path, sizeof files[i].path, "%s", support_temporary(name));
        files[i].descriptor = open(files[i].path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    }
    FUZZ_CHECK(ftruncate(files[i].descriptor, (off_t)bytes) == 0);
    FUZZ_CHECK(pwrite(files[i].descriptor, data, bytes, 0) == (ssize_t)bytes);
    return files[i].path;
}

char *fuzz_text(const uint8_t *data, size_t bytes) {
    char *text = malloc(bytes + 1);
    FUZZ_CHECK(text != NULL);
    if (bytes > 0) memcpy(text, data, bytes);
    text[bytes] = 0;
    return text;
}

static bool is_one_line(const char *text) {
    for (; *text; text++)
        if ((unsigned char)*text < ' ' || *text == 127) return false;
    return true;
}

void fuzz_status(ptie_status status, const char *where) {
    if (status == PTIE_OK) return;
    const char *message = ptie_last_error();
    FUZZ_CHECK(status != PTIE_ENOMEM && status != PTIE_ESTATE && status != PTIE_ECANCELLED);
    FUZZ_CHECK(strcmp(ptie_status_name(status), "unknown status") != 0);
    FUZZ_CHECK(message[0] != 0 && is_one_line(message));
    FUZZ_CHECK(strstr(message, where) != NULL);
}

static void check_info(const ptie_recording_info *info) {
    FUZZ_CHECK(info->width_px >= 1 && info->width_px <= 32768);
    FUZZ_CHECK(info->height_px >= 1 && info->height_px <= 32768);
    FUZZ_CHECK(info->frames >= 1 && info->first_frame >= 0 && info->frame_step >= 1);
    FUZZ_CHECK(isfinite(info->frame_rate_hz) && info->frame_rate_hz >= 0);
    FUZZ_CHECK(isfinite(info->pixel_m) && info->pixel_m >= 0);
    FUZZ_CHECK(memchr(info->unit, 0, sizeof info->unit) && memchr(info->sample, 0, sizeof info->sample));
    FUZZ_CHECK(info->format[0] && memchr(info->format, 0, sizeof info->format));
}

/* Memory of exactly one frame: a value too many is a crash. */
static void read_frames(ptie_recording *recording, const char *where) {
    const ptie_recording_info *info = ptie_io_info(recording);
    const size_t pixels = (size_t)info->width_px * (size_t)info->height_px;
    if (pixels > MOST_PIXELS) return;
    float *frame = malloc(pixels * sizeof *frame);
    FUZZ_CHECK(frame != NULL);
    const int64_t frames[] = {0, info->frames / 2, info->frames - 1, 0};
    for (size_t i = 0; i < sizeof frames / sizeof *frames; i++) {
        ptie_status status = ptie_io_read(recording, frames[i], frame);
        fuzz_status(status, where);
        for (size_t p = 0; p < pixels && status == PTIE_OK; p++) FUZZ_CHECK(isfinite(frame[p]));
    }
    free(frame);
}

static bool is_hdf5(const char *path) {
    unsigned char head[PTIE_HEAD_BYTES];
    return ptie_input_head(path, head, sizeof head) == PTIE_OK && ptie_read_h5.probe(head);
}

void fuzz_recording(const char *path, const char *where) {
    ptie_recording *recording;
    if (is_hdf5(path)) return; /* docs/formats.md says why */
    ptie_status status = ptie_io_open(&recording, path);
    fuzz_status(status, where);
    FUZZ_CHECK((status == PTIE_OK) == (recording != NULL));
    if (status != PTIE_OK) return;
    check_info(ptie_io_info(recording));
    read_frames(recording, where);
    ptie_io_close(recording);
}

const char *fuzz_frames(const char *name, const uint8_t size[2]) {
    static unsigned char frames[1 << 16];
    if (!frames[1])
        for (size_t i = 0; i < sizeof frames; i++) frames[i] = (unsigned char)(i * 37 + i / 256);
    return fuzz_file(name, frames, (size_t)(size[0] | size[1] << 8));
}

void fuzz_pair(const char *frames, const char *header) {
    char stem[1024];
    snprintf(stem, sizeof stem, "%.*s.", (int)(strrchr(header, '.') - header), header);
    fuzz_recording(frames, stem);
}
