/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbered files, one frame each: the images of a folder, or those that fit a pattern.  Opened one
 * at a time; all like the first. */
#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "io/array.h"
#include "io/pattern.h"
#include "io/reader.h"
#include "io/recording.h"

typedef struct sequence {
    char **paths; /* in order */
    size_t count, capacity;
    ptie_recording_info frame; /* what every file must be */
} sequence;

static bool is_folder(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

static bool sequence_claims(const char *path) {
    struct stat info;
    ptie_pattern pattern;
    return is_folder(path) || (stat(path, &info) != 0 && ptie_pattern_find(&pattern, path));
}

static bool is_image(const char *path) {
    static const char *const endings[] = {".png", ".tif", ".tiff", ".npy"};
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < sizeof endings / sizeof *endings; i++)
        if (strcasecmp(dot, endings[i]) == 0) return true;
    return false;
}

/* Digits compare as one number, so that 2 comes before 10. */
static int compare_natural(const char *a, const char *b) {
    while (*a && *b) {
        if (!isdigit((unsigned char)*a) || !isdigit((unsigned char)*b)) {
            if (*a != *b) return (unsigned char)*a - (unsigned char)*b;
            a++, b++;
            continue;
        }
        a += strspn(a, "0");
        b += strspn(b, "0");
        size_t a_digits = strspn(a, "0123456789"), b_digits = strspn(b, "0123456789");
        if (a_digits != b_digits) return a_digits < b_digits ? -1 : 1;
        int order = strncmp(a, b, a_digits);
        if (order) return order;
        a += a_digits, b += b_digits;
    }
    return (unsigned char)*a - (unsigned char)*b;
}

static int by_number(const void *a, const void *b) {
    char *const *left = a, *const *right = b;
    return compare_natural(*left, *right);
}

/* Do two names differ in their numbers only? */
static bool same_but_numbers(const char *a, const char *b) {
    for (;;) {
        a += strspn(a, "0123456789");
        b += strspn(b, "0123456789");
        if (*a != *b) return false;
        if (!*a) return true;
        a++, b++;
    }
}

static void sequence_close(void *state) {
    sequence *files = state;
    if (!files) return;
    for (size_t i = 0; i < files->count; i++) ptie_free(files->paths[i]);
    ptie_free(files->paths);
    ptie_free(files);
}

static ptie_status add_path(sequence *files, const char *path) {
    PTIE_TRY(
        ptie_array_room(&files->paths, files->count, &files->capacity, sizeof *files->paths, path));
    files->paths[files->count] = ptie_strdup(path);
    if (!files->paths[files->count]) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", path);
    files->count++;
    return PTIE_OK;
}

/* NULL at the end with errno 0, or where reading fails. */
static const struct dirent *next_entry(DIR *entries) {
    errno = 0;
    return readdir(entries);
}

/* Adds the folder's files that fit the pattern, in order; without one, all its images. */
static ptie_status add_files(sequence *files, const char *folder, const char *lead,
                             const ptie_pattern *pattern) {
    char path[4096];
    DIR *entries = opendir(folder);
    if (!entries)
        return PTIE_FAIL(PTIE_EIO, "%s: cannot read the folder: %s", folder, strerror(errno));
    ptie_status status = PTIE_OK;
    for (const struct dirent *entry; status == PTIE_OK && (entry = next_entry(entries));) {
        if (entry->d_name[0] == '.' && !pattern) continue;
        int length = snprintf(path, sizeof path, "%s%s", lead, entry->d_name);
        if (length < 0 || (size_t)length >= sizeof path) continue;
        if (pattern ? ptie_pattern_number(pattern, path) >= 0 : is_image(path))
            status = add_path(files, path);
    }
    if (status == PTIE_OK && errno) /* of the entry that ended it: a frame must not be missing quietly */
        status = PTIE_FAIL(PTIE_EIO, "%s: cannot read the folder: %s", folder, strerror(errno));
    closedir(entries);
    if (files->count > 0) qsort(files->paths, files->count, sizeof *files->paths, by_number);
    return status;
}

static ptie_status add_folder(sequence *files, const char *path) {
    char lead[4096];
    size_t length = strlen(path);
    snprintf(lead, sizeof lead, "%s%s", path, path[length - 1] == '/' ? "" : "/");
    PTIE_TRY(add_files(files, path, lead, NULL));
    for (size_t i = 1; i < files->count; i++)
        if (!same_but_numbers(files->paths[0], files->paths[i]))
            return PTIE_FAIL(PTIE_EFORMAT,
                             "%s: images of several kinds, such as %s and %s (give a pattern like "
                             "flow_%%02d.png)",
                             path, files->paths[0] + strlen(lead), files->paths[i] + strlen(lead));
    return PTIE_OK;
}

static ptie_status add_pattern(sequence *files, const ptie_pattern *pattern) {
    char lead[4096]; /* up to the last slash */
    const char *slash = strrchr(pattern->text, '/');
    snprintf(lead, sizeof lead, "%.*s", slash ? (int)(slash - pattern->text) + 1 : 0,
             pattern->text);
    return add_files(files, *lead ? lead : ".", lead, pattern);
}

/* Opens file `i`, which must be like the first. */
static ptie_status open_file(const sequence *files, size_t i, ptie_recording **out) {
    ptie_recording *file;
    *out = NULL;
    PTIE_TRY(ptie_io_open(&file, files->paths[i]));
    const ptie_recording_info *found = ptie_io_info(file), *expected = &files->frame;
    ptie_status status = PTIE_OK;
    if (found->frames != 1)
        status =
            PTIE_FAIL(PTIE_EUNSUPPORTED, "%s: part of a sequence (expected 1 frame, found %lld)",
                      files->paths[i], (long long)found->frames);
    else if (expected->frames &&
             (found->width_px != expected->width_px || found->height_px != expected->height_px ||
              strcmp(found->sample, expected->sample) != 0))
        status = PTIE_FAIL(PTIE_ESIZE,
                           "%s: unlike the first frame (expected %d x %d %s, found %d x %d %s)",
                           files->paths[i], expected->width_px, expected->height_px,
                           expected->sample, found->width_px, found->height_px, found->sample);
    if (status != PTIE_OK) {
        ptie_io_close(file);
        return status;
    }
    *out = file;
    return PTIE_OK;
}

static ptie_status sequence_load(sequence *files, ptie_recording_info *info, const char *path) {
    ptie_pattern pattern;
    ptie_recording *first;
    if (is_folder(path))
        PTIE_TRY(add_folder(files, path));
    else if (ptie_pattern_find(&pattern, path))
        PTIE_TRY(add_pattern(files, &pattern));
    if (files->count == 0)
        return PTIE_FAIL(PTIE_EIO, "%s: no frames (expected numbered images: .png .tif .tiff .npy)",
                         path);
    PTIE_TRY(open_file(files, 0, &first));
    *info = files->frame = *ptie_io_info(first);
    ptie_io_close(first);
    info->frames = (int64_t)files->count;
    snprintf(info->format, sizeof info->format, "%.6s sequence", files->frame.format);
    return PTIE_OK;
}

static ptie_status sequence_open(void **state, ptie_recording_info *info, const char *path,
                                 const char *inside) {
    (void)inside;
    sequence *files;
    PTIE_TRY(ptie_alloc_status(&files, 1, sizeof *files, path));
    ptie_status status = sequence_load(files, info, path);
    if (status != PTIE_OK) {
        sequence_close(files);
        files = NULL;
    }
    *state = files;
    return status;
}

static ptie_status sequence_read(void *state, int64_t frame, float *data) {
    const sequence *files = state;
    ptie_recording *file;
    PTIE_TRY(open_file(files, (size_t)frame, &file));
    ptie_status status = ptie_io_read(file, 0, data);
    ptie_io_close(file);
    return status;
}

const ptie_reader ptie_read_sequence = {
    .name = "sequence",
    .claims = sequence_claims,
    .open = sequence_open,
    .read = sequence_read,
    .close = sequence_close};
