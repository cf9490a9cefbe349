/* SPDX-License-Identifier: BSD-3-Clause */
/* TIFF and BigTIFF: every page is a frame; strips or tiles, 8 to 64 bits, integer or float. */
#include <string.h>
#include <tiffio.h>

#include "io/array.h"
#include "io/input.h"
#include "io/raster.h"
#include "io/reader.h"
#include "io/tiff_notes.h"

/* The densest codec (Zstandard) codes a block of 128 KiB in 4 bytes. */
#define DENSEST 32768
/* A tile may be larger than the image, by this at most. */
#define TILE_MARGIN_PX 4096

typedef struct tiff_stack {
    TIFF *tiff;
    char *path;
    uint64_t file_bytes;
    uint64_t *pages; /* offset of each page's directory */
    int64_t page_count;
    size_t page_capacity;
    int32_t width, height;
    ptie_sample sample;
    char message[128]; /* libtiff's first complaint */
    FILE *images;         /* of a stack behind one page, else NULL: */
    ptie_raster raster;
    uint64_t first_image; /* where it begins */
} tiff_stack;

static bool tiff_probe(const unsigned char *head) {
    static const char magic[4][5] = {"II*\0", "MM\0*", "II+\0", "MM\0+"};
    for (size_t i = 0; i < 4; i++)
        if (memcmp(head, magic[i], 4) == 0) return true;
    return false;
}

static int on_error(TIFF *tiff, void *user, const char *module, const char *format,
                    va_list arguments) {
    (void)tiff, (void)module;
    tiff_stack *stack = user;
    if (!stack->message[0]) vsnprintf(stack->message, sizeof stack->message, format, arguments);
    return 1; /* told: the process-wide handler, which prints, is not called */
}

static int on_warning(TIFF *tiff, void *user, const char *module, const char *format,
                      va_list arguments) {
    (void)tiff, (void)user, (void)module, (void)format, (void)arguments;
    return 1;
}

static ptie_status damaged(tiff_stack *stack, int64_t page) {
    ptie_status status =
        PTIE_FAIL(PTIE_EFORMAT, "%s: damaged TIFF (page %lld): %s", stack->path, (long long)page,
                  stack->message[0] ? stack->message : "no reason given");
    stack->message[0] = 0;
    return status;
}

static void tiff_close(void *state) {
    tiff_stack *stack = state;
    if (!stack) return;
    if (stack->tiff) TIFFClose(stack->tiff);
    if (stack->images) fclose(stack->images);
    ptie_free(stack->pages);
    ptie_free(stack->path);
    ptie_free(stack);
}

static uint16_t tag16(TIFF *tiff, uint32_t tag) {
    uint16_t value = 0;
    TIFFGetFieldDefaulted(tiff, tag, &value);
    return value;
}

static ptie_status refuse(const tiff_stack *stack, const char *what, const char *expected,
                          unsigned found) {
    return PTIE_FAIL(PTIE_EUNSUPPORTED, "%s: page %lld: %s (expected %s, found %u)", stack->path,
                     (long long)stack->page_count, what, expected, found);
}

/* The current page's sample type. */
static ptie_status page_sample(const tiff_stack *stack, ptie_sample *sample) {
    const unsigned channels = tag16(stack->tiff, TIFFTAG_SAMPLESPERPIXEL);
    const unsigned meaning = tag16(stack->tiff, TIFFTAG_PHOTOMETRIC);
    const unsigned format = tag16(stack->tiff, TIFFTAG_SAMPLEFORMAT);
    const unsigned bits = tag16(stack->tiff, TIFFTAG_BITSPERSAMPLE);
    if (channels != 1) return refuse(stack, "colour image", "1 sample per pixel", channels);
    if (meaning != PHOTOMETRIC_MINISBLACK)
        return refuse(stack, "not a grey image", "photometric interpretation 1", meaning);
    const char kind = format == SAMPLEFORMAT_UINT     ? 'u'
                      : format == SAMPLEFORMAT_INT    ? 'i'
                      : format == SAMPLEFORMAT_IEEEFP ? 'f'
                                                      : 0;
    *sample = (ptie_sample){kind, bits % 8 == 0 ? bits / 8 : 0};
    if (!ptie_sample_known(*sample))
        return refuse(stack, kind == 'f' ? "float sample" : "sample type",
                      kind == 'f' ? "32 or 64 bits" : "integers of 8, 16, 32 or 64 bits", bits);
    return PTIE_OK;
}

static ptie_status check_tiles(const tiff_stack *stack) {
    uint32_t width = 0, height = 0;
    TIFFGetField(stack->tiff, TIFFTAG_TILEWIDTH, &width);
    TIFFGetField(stack->tiff, TIFFTAG_TILELENGTH, &height);
    if (width >= 1 && height >= 1 && width <= (uint32_t)stack->width + TILE_MARGIN_PX &&
        height <= (uint32_t)stack->height + TILE_MARGIN_PX)
        return PTIE_OK;
    return PTIE_FAIL(PTIE_EFORMAT, "%s: page %lld: bad tile size %u x %u", stack->path,
                     (long long)stack->page_count, width, height);
}

/* Checks the current page against the first one. */
static ptie_status check_page(tiff_stack *stack, ptie_recording_info *info) {
    uint32_t width = 0, height = 0;
    ptie_sample sample;
    ptie_recording_info page;
    TIFFGetField(stack->tiff, TIFFTAG_IMAGEWIDTH, &width);
    TIFFGetField(stack->tiff, TIFFTAG_IMAGELENGTH, &height);
    PTIE_TRY(ptie_info_set_size(&page, stack->path, width, height));
    PTIE_TRY(page_sample(stack, &sample));
    if (stack->page_count == 0) {
        stack->width = info->width_px = page.width_px;
        stack->height = info->height_px = page.height_px;
        stack->sample = sample;
        ptie_sample_name(info->sample, sample);
    }
    if (page.width_px != stack->width || page.height_px != stack->height ||
        sample.kind != stack->sample.kind || sample.bytes != stack->sample.bytes)
        return PTIE_FAIL(
            PTIE_EUNSUPPORTED,
            "%s: page %lld differs from page 0 (expected %d x %d %c%zu, found %d x %d %c%zu)",
            stack->path, (long long)stack->page_count, stack->width, stack->height,
            stack->sample.kind, 8 * stack->sample.bytes, page.width_px, page.height_px, sample.kind,
            8 * sample.bytes);
    if (TIFFIsTiled(stack->tiff)) PTIE_TRY(check_tiles(stack));
    bool plain = tag16(stack->tiff, TIFFTAG_COMPRESSION) == COMPRESSION_NONE;
    return ptie_check_fits(stack->path, (uint64_t)width * height * sample.bytes, stack->file_bytes,
                           plain ? 1 : DENSEST);
}

/* Remembers where the current page is. */
static ptie_status add_page(tiff_stack *stack) {
    PTIE_TRY(ptie_array_room(&stack->pages, (size_t)stack->page_count, &stack->page_capacity,
                             sizeof *stack->pages, stack->path));
    stack->pages[stack->page_count++] = TIFFCurrentDirOffset(stack->tiff);
    return PTIE_OK;
}

/* Is the link that ends the current directory in the file?  To libtiff a missing one is the last. */
static bool has_link(const tiff_stack *stack) {
    TIFF *tiff = stack->tiff;
    const bool big = TIFFIsBigTIFF(tiff);
    const tmsize_t count_bytes = big ? 8 : 2;
    const uint64_t at = TIFFCurrentDirOffset(tiff);
    unsigned char bytes[8];
    uint64_t entries = 0;
    TIFFGetSeekProc(tiff)(TIFFClientdata(tiff), at, SEEK_SET);
    if (TIFFGetReadProc(tiff)(TIFFClientdata(tiff), bytes, count_bytes) != count_bytes)
        return false;
    for (tmsize_t i = 0; i < count_bytes; i++)
        entries = entries << 8 | bytes[TIFFIsBigEndian(tiff) ? i : count_bytes - 1 - i];
    return at + (big ? 8 + 20 * entries + 8 : 2 + 12 * entries + 4) <= stack->file_bytes;
}

/* Walks the pages; previews and masks are not frames. */
static ptie_status list_pages(tiff_stack *stack, ptie_recording_info *info) {
    for (int64_t page = 0;; page++) {
        uint32_t kind = 0;
        TIFFGetField(stack->tiff, TIFFTAG_SUBFILETYPE, &kind);
        if (!(kind & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK))) {
            PTIE_TRY(check_page(stack, info));
            PTIE_TRY(add_page(stack));
        }
        if (!has_link(stack))
            return PTIE_FAIL(PTIE_EFORMAT, "%s: file is cut short (page %lld)", stack->path,
                             (long long)page);
        if (TIFFLastDirectory(stack->tiff)) break;
        if (!TIFFReadDirectory(stack->tiff)) return damaged(stack, page + 1);
    }
    if (stack->page_count == 0)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: TIFF without an image", stack->path);
    info->frames = stack->page_count;
    return PTIE_OK;
}

/* A stack of ImageJ's above 4 GiB: the first image has a directory, the others follow it. */
static ptie_status take_images(tiff_stack *stack, ptie_recording_info *info, int64_t images) {
    uint64_t *offsets = NULL;
    if (TIFFIsTiled(stack->tiff) || tag16(stack->tiff, TIFFTAG_COMPRESSION) != COMPRESSION_NONE ||
        !TIFFGetField(stack->tiff, TIFFTAG_STRIPOFFSETS, &offsets) || !offsets)
        return PTIE_FAIL(PTIE_EUNSUPPORTED, "%s: stack of %lld images behind one compressed page", stack->path,
                         (long long)images);
    stack->raster = (ptie_raster){.width = stack->width,
                                  .height = stack->height,
                                  .sample = stack->sample,
                                  .swapped = TIFFIsByteSwapped(stack->tiff)};
    const uint64_t frame_bytes = ptie_raster_bytes(&stack->raster);
    stack->first_image = offsets[0];
    if (stack->first_image > stack->file_bytes) return damaged(stack, 0);
    PTIE_TRY(ptie_check_fits(stack->path, frame_bytes, stack->file_bytes - stack->first_image, 1));
    const int64_t there = (int64_t)((stack->file_bytes - stack->first_image) / frame_bytes);
    ptie_info_set_frames(info, there, images);
    return ptie_input_open(&stack->images, stack->path, NULL);
}

/* What the first page says of the stack. */
static ptie_status take_description(tiff_stack *stack, ptie_recording_info *info) {
    char *text = NULL;
    float per_unit = 0;
    if (!TIFFGetField(stack->tiff, TIFFTAG_IMAGEDESCRIPTION, &text)) return PTIE_OK;
    if (!TIFFGetField(stack->tiff, TIFFTAG_XRESOLUTION, &per_unit)) per_unit = 0;
    const int64_t images = ptie_tiff_notes(info, text, (double)per_unit);
    return stack->page_count == 1 && images > 1 ? take_images(stack, info, images) : PTIE_OK;
}

static ptie_status go_to_page(tiff_stack *stack, int64_t page) {
    if (TIFFCurrentDirOffset(stack->tiff) == stack->pages[page]) return PTIE_OK;
    return TIFFSetSubDirectory(stack->tiff, stack->pages[page]) ? PTIE_OK : damaged(stack, page);
}

/* Opens quietly, and without a memory map ("m"): a file that shrinks is an error, not a SIGBUS. */
static ptie_status open_tiff(tiff_stack *stack) {
    TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
    if (!options) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", stack->path);
    TIFFOpenOptionsSetErrorHandlerExtR(options, on_error, stack);
    TIFFOpenOptionsSetWarningHandlerExtR(options, on_warning, stack);
    stack->tiff = TIFFOpenExt(stack->path, "rm", options);
    TIFFOpenOptionsFree(options);
    return stack->tiff ? PTIE_OK : damaged(stack, 0);
}

static ptie_status tiff_load(tiff_stack *stack, ptie_recording_info *info, const char *path) {
    stack->path = ptie_strdup(path);
    if (!stack->path) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", path);
    PTIE_TRY(ptie_input_check(path, &stack->file_bytes));
    PTIE_TRY(open_tiff(stack));
    PTIE_TRY(list_pages(stack, info));
    PTIE_TRY(go_to_page(stack, 0));
    return take_description(stack, info);
}

static ptie_status tiff_open(void **state, ptie_recording_info *info, const char *path,
                             const char *inside) {
    (void)inside;
    tiff_stack *stack;
    PTIE_TRY(ptie_alloc_status(&stack, 1, sizeof *stack, path));
    ptie_status status = tiff_load(stack, info, path);
    if (status != PTIE_OK) {
        tiff_close(stack);
        stack = NULL;
    }
    *state = stack;
    return status;
}

static ptie_status read_rows(tiff_stack *stack, int64_t frame, float *data, unsigned char *row) {
    const size_t width = (size_t)stack->width;
    for (uint32_t y = 0; y < (uint32_t)stack->height; y++) {
        if (TIFFReadScanline(stack->tiff, row, y, 0) < 0) return damaged(stack, frame);
        ptie_sample_convert(data + y * width, row, width, stack->sample);
    }
    return PTIE_OK;
}

/* Copies one tile; what sticks out of the image is dropped. */
static void place_tile(const tiff_stack *stack, float *data, const unsigned char *tile, uint32_t x,
                       uint32_t y, uint32_t tile_width, uint32_t tile_height) {
    const uint32_t width = (uint32_t)stack->width, height = (uint32_t)stack->height;
    const size_t columns = width - x < tile_width ? width - x : tile_width;
    const size_t rows = height - y < tile_height ? height - y : tile_height;
    for (size_t r = 0; r < rows; r++)
        ptie_sample_convert(data + (y + r) * width + x, tile + r * tile_width * stack->sample.bytes,
                            columns, stack->sample);
}

static ptie_status read_tiles(tiff_stack *stack, int64_t frame, float *data, unsigned char *tile) {
    uint32_t tile_width = 0, tile_height = 0;
    TIFFGetField(stack->tiff, TIFFTAG_TILEWIDTH, &tile_width);
    TIFFGetField(stack->tiff, TIFFTAG_TILELENGTH, &tile_height);
    for (uint32_t y = 0; y < (uint32_t)stack->height; y += tile_height)
        for (uint32_t x = 0; x < (uint32_t)stack->width; x += tile_width) {
            if (TIFFReadTile(stack->tiff, tile, x, y, 0, 0) < 0) return damaged(stack, frame);
            place_tile(stack, data, tile, x, y, tile_width, tile_height);
        }
    return PTIE_OK;
}

static ptie_status tiff_read(void *state, int64_t frame, float *data) {
    tiff_stack *stack = state;
    unsigned char *buffer; /* one row or one tile */
    if (stack->images)
        return ptie_raster_read(&stack->raster, stack->images,
                                stack->first_image + (uint64_t)frame * ptie_raster_bytes(&stack->raster), data,
                                stack->path, frame);
    PTIE_TRY(go_to_page(stack, frame));
    bool tiled = TIFFIsTiled(stack->tiff);
    tmsize_t bytes = tiled ? TIFFTileSize(stack->tiff) : TIFFScanlineSize(stack->tiff);
    if (bytes < stack->width * (tmsize_t)stack->sample.bytes && !tiled)
        return damaged(stack, frame);
    PTIE_TRY(ptie_alloc_status(&buffer, (size_t)bytes, 1, stack->path));
    ptie_status status =
        tiled ? read_tiles(stack, frame, data, buffer) : read_rows(stack, frame, data, buffer);
    ptie_free(buffer);
    return status;
}

const ptie_reader ptie_read_tiff = {
    .name = "TIFF", .probe = tiff_probe, .open = tiff_open, .read = tiff_read, .close = tiff_close};
