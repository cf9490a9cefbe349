/* SPDX-License-Identifier: BSD-3-Clause */
/* Colour bars: what a colour means. */
#ifndef PTIE_REPORT_BAR_H
#define PTIE_REPORT_BAR_H

#include <cairo.h>

#include <ptie/figure.h>

/* Room for bar, ticks and labels, in points. */
#define PTIE_BAR_BELOW 18.0
#define PTIE_BAR_BESIDE 38.0

/* The values at the two ends of a colour map. */
typedef struct ptie_limits {
    double low, high;
} ptie_limits;

/* From (x, y) to the right, labels below.  `unit` may be NULL. */
void ptie_draw_bar_below(cairo_t *cr, ptie_colormap map, ptie_limits span, const char *unit,
                         double x, double y, double length);
/* From (x, y) down, highest value first, labels to the right and the unit above. */
void ptie_draw_bar_beside(cairo_t *cr, ptie_colormap map, ptie_limits span, const char *unit,
                          double x, double y, double length);

#endif
