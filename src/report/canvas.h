/* SPDX-License-Identifier: BSD-3-Clause */
/* A page to draw on with cairo, in points (1/72 inch), that becomes a PNG at 300 dpi or an SVG. */
#ifndef PTIE_REPORT_CANVAS_H
#define PTIE_REPORT_CANVAS_H

#include <cairo.h>
#include <stdio.h>

#include "base/file.h"

#define PTIE_DPI 300.0
#define PTIE_POINTS_PER_MM (72 / 25.4)

/* Type sizes in points. */
#define PTIE_SMALL 7.0 /* tick labels; nothing is smaller */
#define PTIE_NORMAL 8.0
#define PTIE_LARGE 9.5 /* the title of the figure */

typedef struct ptie_canvas {
    cairo_t *cr;
    cairo_surface_t *surface;
    ptie_output_file file;
    FILE *stream;
    bool png;
    size_t written; /* bytes of the file so far */
} ptie_canvas;

/* A white page.  The ending of `path` decides.  Errors: PTIE_EUNSUPPORTED (ending), PTIE_EINVAL
   (page too large), those of ptie_output_open. */
ptie_status ptie_canvas_open(ptie_canvas *canvas, const char *path, double width_pt,
                             double height_pt, bool overwrite);
/* Writes the file whole, or leaves none; frees the page in any case. */
ptie_status ptie_canvas_close(ptie_canvas *canvas);
/* Frees the page and leaves no file. */
void ptie_canvas_discard(ptie_canvas *canvas);

/* A page without a file, to measure text on before the size of a figure is known. */
void ptie_canvas_measure(ptie_canvas *canvas);

void ptie_set_colour(cairo_t *cr, uint32_t rgb);
void ptie_set_type(cairo_t *cr, double size_pt, bool bold);
double ptie_text_width(cairo_t *cr, const char *text);
/* Base line at y; `anchor` 0, 0.5, 1: x is the left end, the middle, the right end.  NULL draws
 * nothing. */
void ptie_text_at(cairo_t *cr, const char *text, double x, double y, double anchor);
/* The same within `width`: set smaller down to PTIE_SMALL, then cut with an ellipsis. */
void ptie_text_within(cairo_t *cr, const char *text, double x, double y, double anchor,
                      double width);
/* Read from bottom to top, centred on (x, y). */
void ptie_text_upwards(cairo_t *cr, const char *text, double x, double y, double width);

#endif
