/* SPDX-License-Identifier: BSD-3-Clause */
/* PNG: grey of 1 to 16 bits; colour and alpha only where they say nothing. */
#include <png.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "io/endian.h"
#include "io/input.h"
#include "io/png_keys.h"
#include "io/reader.h"

/* One byte of DEFLATE stands for at most 1032. */
#define DENSEST 1032
#define CHUNK_LIMIT (8 << 20)             /* bytes */
#define MEMORY_LIMIT ((size_t)2 * CHUNK_LIMIT) /* of one block of libpng's: a chunk, a row of pixels, zlib's tables */

typedef struct grey_png {
    char *path;
    int32_t width, height;
    double offset, scale; /* value = offset + scale * sample */
} grey_png;

/* One pass of libpng over the file. */
typedef struct decoder {
    const char *path;
    FILE *stream;
    uint64_t file_bytes;
    png_structp png;
    png_infop info;
    unsigned char *pixels; /* rows of row_bytes */
    png_bytep *rows;
    size_t row_bytes, channels;
    bool wide; /* 16 bits */
    bool short_of_memory;
    char message[128];
} decoder;

static bool png_probe(const unsigned char *head) {
    return memcmp(head, "\x89PNG\r\n\x1a\n", 8) == 0;
}

static void on_error(png_structp png, png_const_charp message) {
    decoder *d = png_get_error_ptr(png);
    snprintf(d->message, sizeof d->message, "%s", message);
    longjmp(png_jmpbuf(png), 1);
}

static void on_warning(png_structp png, png_const_charp message) {
    (void)png, (void)message;
}

/* libpng takes a chunk's word for its size, and only warns when that is above the limit set below. */
static png_voidp allocate(png_structp png, png_alloc_size_t bytes) {
    decoder *d = png_get_mem_ptr(png);
    void *memory = bytes <= MEMORY_LIMIT ? ptie_alloc(bytes, 1) : NULL;
    d->short_of_memory |= !memory && bytes <= MEMORY_LIMIT;
    return memory;
}

static void release(png_structp png, png_voidp memory) {
    (void)png;
    ptie_free(memory);
}

static void decoder_stop(decoder *d) {
    png_destroy_read_struct(&d->png, &d->info, NULL);
    if (d->stream) fclose(d->stream);
    ptie_free(d->pixels);
    ptie_free(d->rows);
}

/* Without memory libpng skips chunks, or takes what follows them for others. */
static ptie_status short_of_memory(const decoder *d) {
    return d->short_of_memory ? PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", d->path) : PTIE_OK;
}

/* libpng fails by jumping; here the jump ends, and no local variable of a step survives it. */
static ptie_status guarded(decoder *d, void (*step)(decoder *)) {
    if (setjmp(png_jmpbuf(d->png))) {
        PTIE_TRY(short_of_memory(d));
        return PTIE_FAIL(PTIE_EFORMAT, "%s: damaged PNG: %s", d->path, d->message);
    }
    step(d);
    return short_of_memory(d);
}

static void read_info(decoder *d) {
    png_set_user_limits(d->png, PTIE_LONGEST_SIDE, PTIE_LONGEST_SIDE);
    png_set_chunk_malloc_max(d->png, CHUNK_LIMIT);
    png_init_io(d->png, d->stream);
    png_read_info(d->png, d->info);
}

/* Samples come out as stored: unpacked, in the machine's byte order, palettes as colours. */
static void set_transformations(decoder *d) {
    int depth = png_get_bit_depth(d->png, d->info);
    bool palette = png_get_color_type(d->png, d->info) == PNG_COLOR_TYPE_PALETTE;
    if (palette)
        png_set_palette_to_rgb(d->png);
    else
        png_set_packing(d->png);
    if (png_get_valid(d->png, d->info, PNG_INFO_tRNS)) png_set_tRNS_to_alpha(d->png);
    if (depth == 16 && ptie_machine_is_little()) png_set_swap(d->png);
    png_set_interlace_handling(d->png);
    png_read_update_info(d->png, d->info);
    d->row_bytes = png_get_rowbytes(d->png, d->info);
    d->channels = png_get_channels(d->png, d->info);
    d->wide = png_get_bit_depth(d->png, d->info) == 16;
}

static void read_pixels(decoder *d) {
    png_read_image(d->png, d->rows);
    png_read_end(d->png, NULL);
}

/* Reads up to the pixels. */
static ptie_status decoder_start(decoder *d, const char *path) {
    *d = (decoder){.path = path};
    PTIE_TRY(ptie_input_open(&d->stream, path, &d->file_bytes));
    d->png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, d, on_error, on_warning, d, allocate, release);
    if (d->png) d->info = png_create_info_struct(d->png);
    if (!d->info) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", path);
    return guarded(d, read_info);
}

/* Checks the size against the file's before anything is allocated for it. */
static ptie_status check_size(const decoder *d, ptie_recording_info *info) {
    uint64_t width = png_get_image_width(d->png, d->info),
             height = png_get_image_height(d->png, d->info);
    PTIE_TRY(ptie_info_set_size(info, d->path, width, height));
    return ptie_check_fits(d->path, height * png_get_rowbytes(d->png, d->info), d->file_bytes,
                           DENSEST);
}

static ptie_status read_image(decoder *d) {
    ptie_recording_info size;
    PTIE_TRY(check_size(d, &size));
    PTIE_TRY(guarded(d, set_transformations));
    size_t height = (size_t)size.height_px;
    PTIE_TRY(ptie_alloc_status(&d->pixels, height, d->row_bytes, d->path));
    PTIE_TRY(ptie_alloc_status(&d->rows, height, sizeof *d->rows, d->path));
    for (size_t y = 0; y < height; y++) d->rows[y] = d->pixels + y * d->row_bytes;
    return guarded(d, read_pixels);
}

/* Value of a text chunk, or NULL. */
static const char *text_of(const decoder *d, const char *key) {
    png_textp texts;
    int count = png_get_text(d->png, d->info, &texts, NULL);
    for (int i = 0; i < count; i++)
        if (strcmp(texts[i].key, key) == 0) return texts[i].text;
    return NULL;
}

static void take_number(const decoder *d, const char *key, double *value) {
    const char *text = text_of(d, key);
    double number;
    if (text && !ptie_parse_quantity(text, PTIE_NUMBER, &number)) *value = number;
}

static void take_notes(const decoder *d, grey_png *image, ptie_recording_info *info) {
    const char *unit = text_of(d, PTIE_PNG_UNIT);
    if (unit) snprintf(info->unit, sizeof info->unit, "%s", unit);
    image->scale = 1;
    take_number(d, PTIE_PNG_OFFSET, &image->offset);
    take_number(d, PTIE_PNG_SCALE, &image->scale);
    take_number(d, PTIE_PNG_RATE, &info->frame_rate_hz);
    take_number(d, PTIE_PNG_PIXEL, &info->pixel_m);
}

static void png_close(void *state) {
    grey_png *image = state;
    if (!image) return;
    ptie_free(image->path);
    ptie_free(image);
}

static ptie_status png_load(grey_png *image, decoder *d, ptie_recording_info *info,
                            const char *path) {
    image->path = ptie_strdup(path);
    if (!image->path) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", path);
    PTIE_TRY(decoder_start(d, path));
    PTIE_TRY(check_size(d, info));
    take_notes(d, image, info);
    info->frames = 1;
    image->width = info->width_px;
    image->height = info->height_px;
    const bool scaled = image->offset != 0 || image->scale != 1;
    snprintf(info->sample, sizeof info->sample, "%s",
             scaled ? "f32" : png_get_bit_depth(d->png, d->info) == 16 ? "u16" : "u8");
    return PTIE_OK;
}

static ptie_status png_open(void **state, ptie_recording_info *info, const char *path,
                            const char *inside) {
    (void)inside;
    grey_png *image;
    decoder d = {0};
    PTIE_TRY(ptie_alloc_status(&image, 1, sizeof *image, path));
    ptie_status status = png_load(image, &d, info, path);
    decoder_stop(&d);
    if (status != PTIE_OK) {
        png_close(image);
        image = NULL;
    }
    *state = image;
    return status;
}

static unsigned sample_at(const unsigned char *row, size_t index, bool wide) {
    uint16_t value;
    if (!wide) return row[index];
    memcpy(&value, row + 2 * index, sizeof value);
    return value;
}

/* The value of one pixel; colour and transparency are refused. */
static ptie_status grey_of(const decoder *d, size_t x, size_t y, unsigned *value) {
    unsigned c[4] = {0};
    for (size_t i = 0; i < d->channels; i++)
        c[i] = sample_at(d->rows[y], x * d->channels + i, d->wide);
    if (d->channels >= 3 && (c[0] != c[1] || c[0] != c[2]))
        return PTIE_FAIL(
            PTIE_EUNSUPPORTED,
            "%s: colour image (expected grey, found red %u, green %u, blue %u at x=%zu, y=%zu)",
            d->path, c[0], c[1], c[2], x, y);
    if (d->channels % 2 == 0 && c[d->channels - 1] != (d->wide ? 65535u : 255u))
        return PTIE_FAIL(PTIE_EUNSUPPORTED,
                         "%s: transparent image (expected opaque, found alpha %u at x=%zu, "
                         "y=%zu)",
                         d->path, c[d->channels - 1], x, y);
    *value = c[0];
    return PTIE_OK;
}

static ptie_status take_values(const decoder *d, const grey_png *image, float *data) {
    for (size_t y = 0; y < (size_t)image->height; y++)
        for (size_t x = 0; x < (size_t)image->width; x++) {
            unsigned value = 0;
            PTIE_TRY(grey_of(d, x, y, &value));
            *data++ = (float)(image->offset + image->scale * value);
        }
    return PTIE_OK;
}

static ptie_status png_read(void *state, int64_t frame, float *data) {
    (void)frame;
    const grey_png *image = state;
    decoder d;
    ptie_status status = decoder_start(&d, image->path);
    if (status == PTIE_OK) status = read_image(&d);
    if (status == PTIE_OK && (png_get_image_width(d.png, d.info) != (png_uint_32)image->width ||
                              png_get_image_height(d.png, d.info) != (png_uint_32)image->height))
        status =
            PTIE_FAIL(PTIE_EFORMAT, "%s: the file changed while it was being read", image->path);
    if (status == PTIE_OK) status = take_values(&d, image, data);
    decoder_stop(&d);
    return status;
}

const ptie_reader ptie_read_png = {
    .name = "PNG", .probe = png_probe, .open = png_open, .read = png_read, .close = png_close};
