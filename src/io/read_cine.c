/* SPDX-License-Identifier: BSD-3-Clause */
/* Phantom CINE: 8 and 16 bits, 10 bits packed and companded, 12 bits packed. */
#include <math.h>
#include <string.h>
#include <time.h>

#include "base/memory.h"
#include "io/cine.h"
#include "io/endian.h"
#include "io/input.h"
#include "io/raster.h"
#include "io/reader.h"

enum { CODES = 1024, FIRST_CODE = 64, LAST_CODE = 1014, CLIPPED = 4095 };

typedef struct cine_recording {
    FILE *stream;
    char *path;
    uint64_t file_bytes;
    ptie_cine cine;
    ptie_raster raster;
    float *linear; /* count of each 10-bit code, or NULL */
} cine_recording;

static void cine_close(void *state) {
    cine_recording *file = state;
    if (!file) return;
    if (file->stream) fclose(file->stream);
    ptie_free(file->linear);
    ptie_free(file->path);
    ptie_free(file);
}

/* Ten bits hold twelve through the inverse of the transfer function of ITU-R BT.709, black at 64
   and white at 1014 -> 4064.  Within 2 counts of the camera maker's table. */
static float linear_count(int code) {
    if (code > LAST_CODE) return CLIPPED;
    const double x = (double)(code - FIRST_CODE) / (LAST_CODE - FIRST_CODE);
    const double y = x < 0.08124 ? x / 4.5 : pow((x + 0.0992968) / 1.0992968, 1 / 0.45);
    return (float)floor(64 + 4000 * y + 0.85);
}

static ptie_status make_linear(cine_recording *file) {
    PTIE_TRY(ptie_alloc_status(&file->linear, CODES, sizeof *file->linear, file->path));
    for (int code = 0; code < CODES; code++) file->linear[code] = linear_count(code);
    return PTIE_OK;
}

static ptie_status take_packing(cine_recording *file, ptie_recording_info *info) {
    const ptie_cine *cine = &file->cine;
    const bool plain = cine->packing == PTIE_CINE_PLAIN;
    if (cine->compression != 0 && cine->compression != 2)
        return PTIE_FAIL(PTIE_EUNSUPPORTED,
                         "%s: compressed images (expected compression 0 or 2, found %d)",
                         file->path, cine->compression);
    if (!plain && cine->packing != PTIE_CINE_PACKED_10 && cine->packing != PTIE_CINE_PACKED_12)
        return PTIE_FAIL(PTIE_EUNSUPPORTED,
                         "%s: packing of pixels (expected 0, 256 or 1024, found %d)", file->path,
                         cine->packing);
    if (plain && cine->bits_per_pixel != 8 && cine->bits_per_pixel != 16)
        return PTIE_FAIL(PTIE_EUNSUPPORTED, "%s: bits of a pixel (expected 8 or 16, found %d)",
                         file->path, cine->bits_per_pixel);
    file->raster.packed_bits = plain ? 0 : cine->packing == PTIE_CINE_PACKED_10 ? 10 : 12;
    file->raster.sample = (ptie_sample){'u', cine->bits_per_pixel == 8 ? 1 : 2};
    file->raster.swapped = !ptie_machine_is_little();
    /* Plain images are stored bottom-up, packed ones top-down; the flag turns either. */
    file->raster.bottom_up = info->bottom_up = plain != cine->flip_vertical;
    snprintf(info->sample, sizeof info->sample, "u%d%s",
             plain ? cine->bits_per_pixel : file->raster.packed_bits, plain ? "" : " packed");
    return PTIE_OK;
}

/* Where the pixels of a frame begin, if all of them are in the file: behind an annotation that says
   its size first and theirs last. */
static bool find_frame(const cine_recording *file, int64_t frame, uint64_t *pixels) {
    unsigned char number[8];
    const uint64_t entry = file->cine.offsets_at + 8 * (uint64_t)frame;
    const uint64_t frame_bytes = ptie_raster_bytes(&file->raster);
    if (fseeko(file->stream, (off_t)entry, SEEK_SET) != 0 || fread(number, 1, 8, file->stream) != 8)
        return false;
    const uint64_t at = ptie_get_le(number, 8);
    if (at > file->file_bytes || fseeko(file->stream, (off_t)at, SEEK_SET) != 0) return false;
    if (fread(number, 1, 4, file->stream) != 4) return false;
    const uint64_t annotation = ptie_get_le(number, 4);
    *pixels = at + annotation;
    if (annotation < 8 || *pixels > file->file_bytes || frame_bytes > file->file_bytes - *pixels)
        return false;
    if (fseeko(file->stream, (off_t)(*pixels - 4), SEEK_SET) != 0 ||
        fread(number, 1, 4, file->stream) != 4)
        return false;
    return ptie_get_le(number, 4) >= frame_bytes;
}

/* How many frames from the first on are whole: where a file was cut, all from there on are missing.
 */
static ptie_status count_frames(const cine_recording *file, ptie_recording_info *info) {
    uint64_t pixels;
    int64_t whole = 0,
            missing = file->cine.images; /* frame `whole` - 1 is there, frame `missing` is not */
    if (find_frame(file, missing - 1, &pixels)) whole = missing;
    while (missing - whole > 1) {
        const int64_t middle = (whole + missing) / 2;
        if (find_frame(file, middle - 1, &pixels))
            whole = middle;
        else
            missing = middle;
    }
    if (whole == 0)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: no frame of %d x %d px in the file", file->path,
                         info->width_px, info->height_px);
    ptie_info_set_frames(info, whole, file->cine.images);
    return PTIE_OK;
}

static void take_date(ptie_recording_info *info, uint64_t seconds) {
    const time_t moment = (time_t)seconds;
    struct tm utc;
    if (seconds > 0 && gmtime_r(&moment, &utc))
        strftime(info->date, sizeof info->date, "%Y-%m-%d %H:%M:%S UTC", &utc);
}

/* Cameras say their model since SETUP has room for it, and their version before. */
static void take_camera(ptie_recording_info *info, const ptie_cine *cine) {
    char model[64] = "Phantom";
    if (*cine->model)
        memcpy(model, cine->model, sizeof model);
    else if (cine->camera_version > 0)
        snprintf(model, sizeof model, "Phantom version %lld", (long long)cine->camera_version);
    if (cine->serial > 0)
        snprintf(info->camera, sizeof info->camera, "%.40s, serial %u", model,
                 (unsigned)cine->serial);
    else
        memcpy(info->camera, model, sizeof info->camera);
}

static double level(const cine_recording *file, int64_t stored) {
    return file->linear && stored >= 0 && stored < CODES ? (double)file->linear[stored]
                                                         : (double)stored;
}

static void take_levels(const cine_recording *file, ptie_recording_info *info) {
    const ptie_cine *cine = &file->cine;
    const int64_t bits = file->raster.packed_bits ? file->raster.packed_bits : cine->bits_per_pixel;
    const int64_t real = cine->real_bits >= 1 && cine->real_bits <= bits ? cine->real_bits : bits;
    info->bit_depth = file->linear ? 12 : (int32_t)real;
    if (!cine->has_levels || cine->white_level <= cine->black_level) return;
    info->black_level = level(file, cine->black_level);
    info->white_level = level(file, cine->white_level);
}

static void take_facts(const cine_recording *file, ptie_recording_info *info) {
    const ptie_cine *cine = &file->cine;
    const double rate_hz = cine->true_rate_hz > 0 ? cine->true_rate_hz : cine->nominal_rate_hz;
    take_camera(info, cine);
    take_date(info, cine->trigger_s);
    take_levels(file, info);
    snprintf(info->comment, sizeof info->comment, "%.*s", (int)sizeof info->comment - 1,
             cine->description);
    if (cine->first_image <= 0)
        snprintf(info->trigger, sizeof info->trigger, "at frame %lld",
                 (long long)-cine->first_image);
    else
        snprintf(info->trigger, sizeof info->trigger, "%lld frames before the first",
                 (long long)cine->first_image);
    info->exposure_s = cine->exposure_s;
    info->frame_rate_hz = rate_hz;
    info->skip = 1;
    if (rate_hz > 0 && cine->nominal_rate_hz / rate_hz > 1.5 &&
        cine->nominal_rate_hz / rate_hz < 1e9)
        info->skip = llround(cine->nominal_rate_hz / rate_hz);
    /* A whole number of pixels per metre: what it stands for is a whole number of 10 nm. */
    if (cine->pixels_per_metre > 0)
        info->pixel_m = round(1e8 / (double)cine->pixels_per_metre) / 1e8;
}

/* inside: "", or "/codes" for 10-bit codes as stored. */
static ptie_status cine_load(cine_recording *file, ptie_recording_info *info, const char *path,
                             const char *inside) {
    file->path = ptie_strdup(path);
    if (!file->path) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", path);
    PTIE_TRY(ptie_input_open(&file->stream, path, &file->file_bytes));
    PTIE_TRY(ptie_cine_read(&file->cine, file->stream, file->file_bytes, path));
    PTIE_TRY(take_packing(file, info));
    PTIE_TRY(
        ptie_info_set_size(info, path, (uint64_t)file->cine.width, (uint64_t)file->cine.height));
    file->raster.width = info->width_px;
    file->raster.height = info->height_px;
    PTIE_TRY(ptie_check_fits(path, ptie_raster_bytes(&file->raster), file->file_bytes, 1));
    PTIE_TRY(count_frames(file, info));
    const bool codes = strcmp(inside, "/codes") == 0;
    if (*inside && !codes)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: no such data set (expected :/codes, found ':%s')", path,
                         inside);
    if (file->raster.packed_bits == 10 && !codes) PTIE_TRY(make_linear(file));
    take_facts(file, info);
    return PTIE_OK;
}

static ptie_status cine_open(void **state, ptie_recording_info *info, const char *path,
                             const char *inside) {
    cine_recording *file;
    PTIE_TRY(ptie_alloc_status(&file, 1, sizeof *file, path));
    const ptie_status status = cine_load(file, info, path, inside);
    if (status != PTIE_OK) {
        cine_close(file);
        file = NULL;
    }
    *state = file;
    return status;
}

static ptie_status cine_read(void *state, int64_t frame, float *data) {
    const cine_recording *file = state;
    const size_t count = (size_t)file->raster.width * (size_t)file->raster.height;
    uint64_t at;
    if (!find_frame(file, frame, &at))
        return PTIE_FAIL(PTIE_EFORMAT, "%s: frame %lld lies outside the file", file->path,
                         (long long)frame);
    PTIE_TRY(ptie_raster_read(&file->raster, file->stream, at, data, file->path, frame));
    if (file->linear)
        for (size_t i = 0; i < count; i++) data[i] = file->linear[(int32_t)data[i]];
    return PTIE_OK;
}

const ptie_reader ptie_read_cine = {.name = "CINE",
                                    .probe = ptie_cine_probe,
                                    .open = cine_open,
                                    .read = cine_read,
                                    .close = cine_close,
                                    .takes_inside = true};
