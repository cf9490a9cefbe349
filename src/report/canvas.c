/* SPDX-License-Identifier: BSD-3-Clause */
#include "report/canvas.h"

#include <cairo-svg.h>
#include <math.h>
#include <string.h>
#include <strings.h>

#define POINTS_PER_INCH 72.0
#define MOST_PIXELS 32767 /* per side of a cairo image */

/* A PNG begins with 8 bytes of signature and 25 of IHDR; this chunk (pHYs: 11811 pixels per metre,
   with its CRC) belongs behind them, so that text processors know the printed size.  Cairo writes
   none. */
#define PNG_HEAD 33
static const unsigned char png_resolution[] = {
    0, 0, 0, 9, 'p', 'H', 'Y', 's', 0, 0, 0x2e, 0x23, 0, 0, 0x2e, 0x23, 1, 0x78, 0xa5, 0x3f, 0x76};

static cairo_status_t put(ptie_canvas *canvas, const unsigned char *data, size_t bytes) {
    canvas->written += bytes;
    return fwrite(data, 1, bytes, canvas->stream) == bytes ? CAIRO_STATUS_SUCCESS
                                                           : CAIRO_STATUS_WRITE_ERROR;
}

static cairo_status_t write_bytes(void *closure, const unsigned char *data, unsigned int length) {
    ptie_canvas *canvas = closure;
    size_t head = 0;
    if (canvas->png && canvas->written <= PNG_HEAD) {
        head = PNG_HEAD - canvas->written;
        if (head > length) head = length;
    }
    cairo_status_t status = put(canvas, data, head);
    if (status == CAIRO_STATUS_SUCCESS && canvas->png && canvas->written == PNG_HEAD)
        status = put(canvas, png_resolution, sizeof png_resolution);
    return status == CAIRO_STATUS_SUCCESS ? put(canvas, data + head, length - head) : status;
}

static ptie_status choose_kind(ptie_canvas *canvas, const char *path) {
    const char *ending = strrchr(path, '.');
    canvas->png = ending && strcasecmp(ending, ".png") == 0;
    if (canvas->png || (ending && strcasecmp(ending, ".svg") == 0)) return PTIE_OK;
    return PTIE_FAIL(PTIE_EUNSUPPORTED,
                     "%s: not a kind of figure (expected a name ending in .png or .svg)", path);
}

/* Starts drawing: points as the unit, sans serif, and no hinting, so that text has the same shape
   and width in every format. */
static void start(ptie_canvas *canvas) {
    canvas->cr = cairo_create(canvas->surface);
    if (cairo_surface_get_type(canvas->surface) == CAIRO_SURFACE_TYPE_IMAGE)
        cairo_scale(canvas->cr, PTIE_DPI / POINTS_PER_INCH, PTIE_DPI / POINTS_PER_INCH);
    cairo_font_options_t *options = cairo_font_options_create();
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_set_font_options(canvas->cr, options);
    cairo_font_options_destroy(options);
    ptie_set_colour(canvas->cr, 0xffffff);
    cairo_paint(canvas->cr);
    ptie_set_colour(canvas->cr, 0);
}

static cairo_surface_t *image_page(double width_pt, double height_pt) {
    return cairo_image_surface_create(CAIRO_FORMAT_RGB24,
                                      (int)lround(width_pt * PTIE_DPI / POINTS_PER_INCH),
                                      (int)lround(height_pt * PTIE_DPI / POINTS_PER_INCH));
}

ptie_status ptie_canvas_open(ptie_canvas *canvas, const char *path, double width_pt,
                             double height_pt, bool overwrite) {
    *canvas = (ptie_canvas){0};
    PTIE_TRY(choose_kind(canvas, path));
    double limit = MOST_PIXELS * POINTS_PER_INCH / PTIE_DPI;
    if (width_pt > limit || height_pt > limit)
        return PTIE_FAIL(PTIE_EINVAL,
                         "%s: figure too large (expected at most %.0f mm, found %.0f x %.0f mm)",
                         path, limit / PTIE_POINTS_PER_MM, width_pt / PTIE_POINTS_PER_MM,
                         height_pt / PTIE_POINTS_PER_MM);
    PTIE_TRY(ptie_output_open(&canvas->file, path, overwrite));
    ptie_status status = ptie_output_stream(&canvas->file, &canvas->stream);
    if (status != PTIE_OK) {
        ptie_canvas_discard(canvas);
        return status;
    }
    canvas->surface =
        canvas->png ? image_page(width_pt, height_pt)
                    : cairo_svg_surface_create_for_stream(write_bytes, canvas, width_pt, height_pt);
    start(canvas);
    return PTIE_OK;
}

void ptie_canvas_measure(ptie_canvas *canvas) {
    *canvas = (ptie_canvas){.surface = image_page(1, 1)};
    start(canvas);
}

static ptie_status drawing_failure(const char *path, cairo_status_t found) {
    if (found == CAIRO_STATUS_NO_MEMORY) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", path);
    return PTIE_FAIL(found == CAIRO_STATUS_WRITE_ERROR ? PTIE_EIO : PTIE_EINVAL,
                     "%s: cannot draw: %s", path, cairo_status_to_string(found));
}

/* Everything cairo still holds goes to the stream. */
static ptie_status finish(ptie_canvas *canvas) {
    cairo_status_t found = cairo_status(canvas->cr);
    if (found == CAIRO_STATUS_SUCCESS && canvas->png)
        found = cairo_surface_write_to_png_stream(canvas->surface, write_bytes, canvas);
    cairo_surface_finish(canvas->surface);
    if (found == CAIRO_STATUS_SUCCESS) found = cairo_surface_status(canvas->surface);
    FILE *stream = canvas->stream;
    canvas->stream = NULL;
    PTIE_TRY(ptie_close_written(stream, canvas->file.path));
    return found == CAIRO_STATUS_SUCCESS ? PTIE_OK : drawing_failure(canvas->file.path, found);
}

ptie_status ptie_canvas_close(ptie_canvas *canvas) {
    ptie_status status = finish(canvas);
    if (status == PTIE_OK) status = ptie_output_commit(&canvas->file);
    ptie_canvas_discard(canvas);
    return status;
}

void ptie_canvas_discard(ptie_canvas *canvas) {
    cairo_destroy(canvas->cr);
    cairo_surface_destroy(canvas->surface); /* an SVG may still write to the stream here */
    if (canvas->stream) fclose(canvas->stream);
    ptie_output_discard(&canvas->file);
    *canvas = (ptie_canvas){0};
}

void ptie_set_colour(cairo_t *cr, uint32_t rgb) {
    cairo_set_source_rgb(cr, (rgb >> 16) / 255.0, (rgb >> 8 & 255) / 255.0, (rgb & 255) / 255.0);
}

void ptie_set_type(cairo_t *cr, double size_pt, bool bold) {
    cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr, size_pt);
}

double ptie_text_width(cairo_t *cr, const char *text) {
    cairo_text_extents_t extents;
    cairo_text_extents(cr, text, &extents);
    return extents.x_advance;
}

void ptie_text_at(cairo_t *cr, const char *text, double x, double y, double anchor) {
    if (!text) return;
    cairo_move_to(cr, x - anchor * ptie_text_width(cr, text), y);
    cairo_show_text(cr, text);
    cairo_new_path(cr);
}

/* Cuts UTF-8 text until it fits, ellipsis included; `cut` has room for both. */
static void cut_to_width(cairo_t *cr, char *cut, const char *text, double width) {
    size_t length = strlen(text);
    do {
        while (length > 0 && ((unsigned char)text[--length] & 0xc0) == 0x80) continue;
        memcpy(cut, text, length);
        strcpy(cut + length, "…");
    } while (length > 0 && ptie_text_width(cr, cut) > width);
}

void ptie_text_within(cairo_t *cr, const char *text, double x, double y, double anchor,
                      double width) {
    char cut[256 + sizeof "…"];
    if (!text) return;
    cairo_save(cr);
    double natural = ptie_text_width(cr, text);
    if (natural > width) {
        cairo_matrix_t type;
        cairo_get_font_matrix(cr, &type);
        cairo_set_font_size(cr, fmax(PTIE_SMALL, type.xx * width / natural));
    }
    if (ptie_text_width(cr, text) > width && strlen(text) < sizeof cut - sizeof "…") {
        cut_to_width(cr, cut, text, width);
        text = cut;
    }
    ptie_text_at(cr, text, x, y, anchor);
    cairo_restore(cr);
}

void ptie_text_upwards(cairo_t *cr, const char *text, double x, double y, double width) {
    cairo_font_extents_t font;
    cairo_font_extents(cr, &font);
    cairo_save(cr);
    cairo_translate(cr, x, y);
    cairo_rotate(cr, -M_PI / 2);
    ptie_text_within(cr, text, 0, (font.ascent - font.descent) / 2, 0.5, width);
    cairo_restore(cr);
}
