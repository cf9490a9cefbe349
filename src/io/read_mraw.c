/* SPDX-License-Identifier: BSD-3-Clause */
/* Photron MRAW: frames back to back without a header, which is the .cih or .cihx file beside it. */
#include <limits.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/text.h"
#include "io/cih.h"
#include "io/endian.h"
#include "io/input.h"
#include "io/raster.h"
#include "io/reader.h"

#define ROW_ALIGNMENT 16 /* bytes, where 12-bit rows are padded */

typedef struct mraw {
    FILE *stream;
    char header[PATH_MAX], path[PATH_MAX];
    uint64_t file_bytes, frame_bytes;
    ptie_raster raster;
    int unused_bits; /* below the value */
} mraw;

static bool has_ending(const char *path, const char *ending) {
    const char *dot = strrchr(path, '.');
    return dot && strcasecmp(dot, ending) == 0;
}

static bool mraw_claims(const char *path) {
    return has_ending(path, ".mraw") || has_ending(path, ".cihx") || has_ending(path, ".cih");
}

static void mraw_close(void *state) {
    mraw *file = state;
    if (!file) return;
    if (file->stream) fclose(file->stream);
    ptie_free(file);
}

/* The file beside `path` with the first of the endings that is there. */
static ptie_status find_beside(char out[PATH_MAX], const char *path, const char *const *endings,
                               const char *what) {
    const int stem = (int)(strrchr(path, '.') - path);
    for (; *endings; endings++) {
        const int length = snprintf(out, PATH_MAX, "%.*s%s", stem, path, *endings);
        if (length > 0 && length < PATH_MAX && access(out, F_OK) == 0) return PTIE_OK;
    }
    return PTIE_FAIL(PTIE_EIO, "%s: the recording's other file is missing (expected %s beside it)",
                     path, what);
}

static ptie_status find_files(mraw *file, const char *path) {
    static const char *const headers[] = {".cihx", ".CIHX", ".cih", ".CIH", NULL};
    static const char *const data[] = {".mraw", ".MRAW", ".Mraw", NULL};
    PTIE_TRY(ptie_input_check(path, NULL));
    if (strlen(path) >= PATH_MAX) return PTIE_FAIL(PTIE_EINVAL, "%s: path too long", path);
    const bool is_data = has_ending(path, ".mraw");
    strcpy(is_data ? file->path : file->header, path);
    return is_data ? find_beside(file->header, path, headers, "a .cihx or .cih")
                   : find_beside(file->path, path, data, "the .mraw");
}

/* How samples are stored. */
static ptie_status take_packing(mraw *file, ptie_recording_info *info, const ptie_cih *cih) {
    const int64_t bits = cih->color_bit;
    if (*cih->format && strcasecmp(cih->format, "MRaw") != 0)
        return PTIE_FAIL(PTIE_EUNSUPPORTED,
                         "%s: frames are saved in another format (expected MRaw, found %s)",
                         file->header, cih->format);
    if (strcasecmp(cih->color, "Color") == 0)
        return PTIE_FAIL(PTIE_EUNSUPPORTED, "%s: colour recording (expected Mono or Raw)",
                         file->header);
    if (bits != 8 && bits != 10 && bits != 12 && bits != 16)
        return PTIE_FAIL(PTIE_EUNSUPPORTED,
                         "%s: bits of a sample (expected 8, 10, 12 or 16, found %lld)",
                         file->header, (long long)bits);
    file->raster.packed_bits = bits == 10 || bits == 12 ? (int)bits : 0;
    file->raster.sample = (ptie_sample){'u', bits == 8 ? 1 : 2};
    file->raster.swapped = bits == 16 && !ptie_machine_is_little();
    const int64_t depth = cih->depth >= 1 && cih->depth <= bits ? cih->depth : bits;
    info->bit_depth = (int32_t)depth;
    file->unused_bits = strcasecmp(cih->side, "Higher") == 0 ? (int)(bits - depth) : 0;
    snprintf(info->sample, sizeof info->sample, "u%d%s", (int)bits,
             file->raster.packed_bits ? " packed" : "");
    return PTIE_OK;
}

/* Some programs pad the rows of 12-bit frames.  Where that makes a difference, the size of the
   whole file decides. */
static ptie_status choose_rows(mraw *file, uint64_t frames) {
    ptie_raster padded = file->raster;
    const uint64_t plain = ptie_raster_bytes(&file->raster);
    const uint64_t row = ((uint64_t)padded.width * 12 + 7) / 8;
    padded.row_bytes = (row + ROW_ALIGNMENT - 1) / ROW_ALIGNMENT * ROW_ALIGNMENT;
    file->frame_bytes = plain;
    if (file->raster.packed_bits != 12 || ptie_raster_bytes(&padded) == plain) return PTIE_OK;
    if (plain * frames == file->file_bytes) return PTIE_OK;
    if (ptie_raster_bytes(&padded) * frames == file->file_bytes) {
        file->raster = padded;
        file->frame_bytes = ptie_raster_bytes(&padded);
        return PTIE_OK;
    }
    return PTIE_FAIL(
        PTIE_EFORMAT,
        "%s: size fits neither plain nor padded 12-bit rows (expected %llu frames of %llu or %llu "
        "bytes, found %llu bytes)",
        file->path, (unsigned long long)frames, (unsigned long long)plain,
        (unsigned long long)ptie_raster_bytes(&padded), (unsigned long long)file->file_bytes);
}

static ptie_status count_frames(mraw *file, ptie_recording_info *info, const ptie_cih *cih) {
    if (cih->frames < 1 || cih->frames > INT64_MAX >> 40)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: no valid number of frames (found %lld)", file->header,
                         (long long)cih->frames);
    PTIE_TRY(choose_rows(file, (uint64_t)cih->frames));
    const int64_t there = (int64_t)(file->file_bytes / file->frame_bytes);
    PTIE_TRY(ptie_check_fits(file->path, file->frame_bytes, file->file_bytes, 1));
    ptie_info_set_frames(info, there, cih->frames);
    return PTIE_OK;
}

/* In s; the exact one in ns where there is one, else the nominal "1/N" (of which a CIHX has the N).
 */
static double exposure_of(const ptie_cih *cih) {
    const char *slash = strchr(cih->shutter, '/');
    double number;
    if (cih->exposure_ns > 0) return cih->exposure_ns / 1e9;
    if (ptie_parse_quantity(slash ? slash + 1 : cih->shutter, PTIE_NUMBER, &number)) return 0;
    return number > 1e-9 ? 1 / number : 0;
}

static void take_facts(ptie_recording_info *info, const ptie_cih *cih) {
    const bool numbered = *cih->trigger >= '0' && *cih->trigger <= '9';
    memcpy(info->camera, cih->camera, sizeof info->camera);
    memcpy(info->comment, cih->comment, sizeof info->comment);
    snprintf(info->date, sizeof info->date, "%.15s%s%.15s", cih->date, *cih->time ? " " : "",
             cih->time);
    if (*cih->trigger)
        snprintf(info->trigger, sizeof info->trigger, "%s%s", numbered ? "mode " : "",
                 cih->trigger);
    info->exposure_s = exposure_of(cih);
    info->skip = cih->skip > 1 ? cih->skip : 1;
    info->frame_rate_hz = cih->rate_hz > 0 ? cih->rate_hz / (double)info->skip : 0;
    info->white_level = (double)((1 << info->bit_depth) - 1);
    info->roi_x_px = cih->x > 0 && cih->x < PTIE_LONGEST_SIDE ? (int32_t)cih->x : 0;
    info->roi_y_px = cih->y > 0 && cih->y < PTIE_LONGEST_SIDE ? (int32_t)cih->y : 0;
}

static ptie_status load_header(mraw *file, ptie_recording_info *info, ptie_cih *cih) {
    PTIE_TRY(ptie_cih_read(cih, file->header));
    PTIE_TRY(take_packing(file, info, cih));
    PTIE_TRY(ptie_info_set_size(info, file->header, (uint64_t)cih->width, (uint64_t)cih->height));
    file->raster.width = info->width_px;
    file->raster.height = info->height_px;
    take_facts(info, cih);
    return PTIE_OK;
}

static ptie_status mraw_load(mraw *file, ptie_recording_info *info, const char *path) {
    ptie_cih cih;
    PTIE_TRY(find_files(file, path));
    PTIE_TRY(load_header(file, info, &cih));
    PTIE_TRY(ptie_input_open(&file->stream, file->path, &file->file_bytes));
    return count_frames(file, info, &cih);
}

static ptie_status mraw_describe(ptie_recording_info *info, const char *path) {
    ptie_cih cih;
    mraw *file;
    PTIE_TRY(ptie_alloc_status(&file, 1, sizeof *file, path));
    snprintf(file->header, sizeof file->header, "%s", path);
    const bool is_header = !has_ending(path, ".mraw");
    const ptie_status status = is_header ? load_header(file, info, &cih) : find_files(file, path);
    ptie_free(file);
    PTIE_TRY(status);
    info->recorded = cih.frames;
    snprintf(info->warning, sizeof info->warning,
             "this is the header alone: the frames (.mraw) are not beside it");
    return PTIE_OK;
}

static ptie_status mraw_open(void **state, ptie_recording_info *info, const char *path,
                             const char *inside) {
    (void)inside;
    mraw *file;
    PTIE_TRY(ptie_alloc_status(&file, 1, sizeof *file, path));
    const ptie_status status = mraw_load(file, info, path);
    if (status != PTIE_OK) {
        mraw_close(file);
        file = NULL;
    }
    *state = file;
    return status;
}

static ptie_status mraw_read(void *state, int64_t frame, float *data) {
    const mraw *file = state;
    const uint64_t at = (uint64_t)frame * file->frame_bytes;
    PTIE_TRY(ptie_raster_read(&file->raster, file->stream, at, data, file->path, frame));
    const size_t count = (size_t)file->raster.width * (size_t)file->raster.height;
    if (file->unused_bits > 0)
        for (size_t i = 0; i < count; i++) data[i] = (float)((int32_t)data[i] >> file->unused_bits);
    return PTIE_OK;
}

const ptie_reader ptie_read_mraw = {.name = "MRAW",
                                    .claims = mraw_claims,
                                    .open = mraw_open,
                                    .describe = mraw_describe,
                                    .read = mraw_read,
                                    .close = mraw_close};
