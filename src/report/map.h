/* SPDX-License-Identifier: BSD-3-Clause */
/* One phase map as an image. */
#ifndef PTIE_REPORT_MAP_H
#define PTIE_REPORT_MAP_H

#include "report/bar.h"
#include "report/canvas.h"

/* The range the colours of a panel cover: its own, or that of its data; centred for PTIE_DIVERGING.
   Errors: PTIE_ENOMEM. */
ptie_status ptie_panel_span(ptie_limits *span, const ptie_panel *panel);

/* Draws the map into a rectangle at the resolution of the print, also in an SVG: pixels are
   averaged where there are more, and are squares where there are fewer.  With a frame and, for a
   known pixel pitch, a scale bar. */
void ptie_draw_map(cairo_t *cr, const ptie_panel *panel, ptie_limits span, cairo_rectangle_t box);

#endif
