/* SPDX-License-Identifier: BSD-3-Clause */
#include "report/map.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/text.h"
#include "report/colormap.h"
#include "report/ticks.h"

/* Quantiles come from at most about this many values of a map. */
#define MOST_VALUES (1 << 16)
#define OUTLIERS 0.005 /* share of the values left out of the range at each end */

static int ascending(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* The odd stride visits all columns of a map whose width is a power of two. */
static ptie_status quantiles(ptie_limits *span, const ptie_panel *panel) {
    size_t count = (size_t)panel->width_px * (size_t)panel->height_px, kept = 0;
    size_t stride = count > MOST_VALUES ? count / MOST_VALUES | 1 : 1;
    float *values;
    PTIE_TRY(ptie_alloc_status(&values, count / stride + 1, sizeof *values, "figure"));
    for (size_t i = 0; i < count; i += stride)
        if (isfinite(panel->data[i])) values[kept++] = panel->data[i];
    *span = (ptie_limits){0};
    if (kept > 0) {
        qsort(values, kept, sizeof *values, ascending);
        double last = (double)(kept - 1);
        span->low = (double)values[lround(OUTLIERS * last)];
        span->high = (double)values[lround((1 - OUTLIERS) * last)];
    }
    ptie_free(values);
    return PTIE_OK;
}

ptie_status ptie_panel_span(ptie_limits *span, const ptie_panel *panel) {
    *span = (ptie_limits){panel->low, panel->high};
    if (panel->data && !(span->low < span->high)) PTIE_TRY(quantiles(span, panel));
    ptie_widen(&span->low, &span->high);
    if (panel->colormap == PTIE_DIVERGING) {
        double limit = fmax(fabs(span->low), fabs(span->high));
        *span = (ptie_limits){-limit, limit};
    }
    return PTIE_OK;
}

/* Mean over columns x0..x1 and rows y0..y1, border pixels by their share; NaN if one is NaN. */
static double area_mean(const ptie_panel *panel, double x0, double x1, double y0, double y1) {
    double sum = 0;
    for (int32_t y = (int32_t)y0; y < y1; y++) {
        const float *row = panel->data + (size_t)y * (size_t)panel->width_px;
        double height = fmin(y1, y + 1) - fmax(y0, y), line = 0;
        for (int32_t x = (int32_t)x0; x < x1; x++)
            line += (fmin(x1, x + 1) - fmax(x0, x)) * (double)row[x];
        sum += height * line;
    }
    return sum / ((x1 - x0) * (y1 - y0));
}

/* The stretch of the map, in its pixels, that printed pixel i covers: several pixels, or the one
   below its centre. */
static void covered(double *from, double *to, int32_t i, int32_t pixels, int32_t printed) {
    double step = (double)pixels / printed;
    *from = step >= 1 ? i * step : floor((i + 0.5) * step);
    *to = step >= 1 ? fmin((i + 1) * step, pixels) : *from + 1;
}

/* The colours of the map on width x height pixels. */
static cairo_surface_t *coloured(const ptie_panel *panel, ptie_limits span, int32_t width,
                                 int32_t height) {
    cairo_surface_t *image = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
    unsigned char *data = cairo_image_surface_get_data(image);
    if (!data) return image; /* its status tells why, and reaches the page with it */
    size_t stride = (size_t)cairo_image_surface_get_stride(image);
    double x0, x1, y0, y1;
    for (int32_t y = 0; y < height; y++) {
        uint32_t *row = (uint32_t *)(void *)(data + (size_t)y * stride);
        covered(&y0, &y1, y, panel->height_px, height);
        for (int32_t x = 0; x < width; x++) {
            covered(&x0, &x1, x, panel->width_px, width);
            double value = area_mean(panel, x0, x1, y0, y1);
            row[x] = ptie_colour(panel->colormap, (value - span.low) / (span.high - span.low));
        }
    }
    cairo_surface_mark_dirty(image);
    return image;
}

static int32_t printed_pixels(double points) {
    return (int32_t)ceil(points * PTIE_DPI / 72);
}

static void draw_image(cairo_t *cr, cairo_surface_t *image, cairo_rectangle_t box) {
    cairo_save(cr);
    cairo_translate(cr, box.x, box.y);
    cairo_scale(cr, box.width / cairo_image_surface_get_width(image),
                box.height / cairo_image_surface_get_height(image));
    cairo_set_source_surface(cr, image, 0, 0);
    cairo_pattern_set_filter(cairo_get_source(cr), CAIRO_FILTER_NEAREST);
    cairo_paint(cr);
    cairo_restore(cr);
}

static void length_text(char text[PTIE_LABEL_BYTES], double length_m) {
    static const struct {
        double m;
        const char *name;
    } units[] = {{1, "m"}, {1e-3, "mm"}, {1e-6, "µm"}, {0, "nm"}};
    int i = 0;
    while (length_m < units[i].m * (1 - 1e-9)) i++;
    ptie_print(text, PTIE_LABEL_BYTES, "%g %s", length_m / (units[i].m > 0 ? units[i].m : 1e-9),
             units[i].name);
}

/* Black or white, whichever the lower left corner of the map is not. */
static double ink_for(const ptie_panel *panel, ptie_limits span) {
    double value = area_mean(panel, 0, ceil(panel->width_px / 3.0), floor(panel->height_px * 0.8),
                             panel->height_px);
    uint32_t rgb = ptie_colour(panel->colormap, (value - span.low) / (span.high - span.low));
    double luminance = 0.30 * (rgb >> 16) + 0.59 * (rgb >> 8 & 255) + 0.11 * (rgb & 255);
    return luminance > 140 ? 0 : 1;
}

/* With a faint rim of the opposite colour, for maps that change in the corner. */
static void fill_with_rim(cairo_t *cr, double ink) {
    cairo_set_source_rgba(cr, 1 - ink, 1 - ink, 1 - ink, 0.5);
    cairo_set_line_width(cr, 1.2);
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    cairo_stroke_preserve(cr);
    cairo_set_source_rgb(cr, ink, ink, ink);
    cairo_fill(cr);
}

/* A round length of at most a third of the width, in the lower left corner. */
static void draw_scale_bar(cairo_t *cr, const ptie_panel *panel, ptie_limits span,
                           cairo_rectangle_t box) {
    double length_m = ptie_round_down(panel->pixel_m * panel->width_px / 3);
    double length = box.width * length_m / (panel->pixel_m * panel->width_px);
    double x = box.x + 4, y = box.y + box.height - 5.5, ink = ink_for(panel, span);
    char text[PTIE_LABEL_BYTES];
    length_text(text, length_m);
    cairo_rectangle(cr, x, y, length, 1.6);
    fill_with_rim(cr, ink);
    ptie_set_type(cr, PTIE_SMALL, false);
    cairo_move_to(cr, x + fmax(0, (length - ptie_text_width(cr, text)) / 2), y - 2.5);
    cairo_text_path(cr, text);
    fill_with_rim(cr, ink);
}

void ptie_draw_map(cairo_t *cr, const ptie_panel *panel, ptie_limits span, cairo_rectangle_t box) {
    cairo_surface_t *image =
        coloured(panel, span, printed_pixels(box.width), printed_pixels(box.height));
    draw_image(cr, image, box);
    cairo_surface_destroy(image);
    if (panel->pixel_m > 0) draw_scale_bar(cr, panel, span, box);
    cairo_rectangle(cr, box.x, box.y, box.width, box.height);
    ptie_set_colour(cr, 0);
    cairo_set_line_width(cr, 0.5);
    cairo_stroke(cr);
}
