/* SPDX-License-Identifier: BSD-3-Clause */
#include "report/bar.h"

#include <math.h>
#include <stdio.h>

#include "report/canvas.h"
#include "report/colormap.h"
#include "report/ticks.h"

#define THICKNESS 5.0
#define TICK 2.0
#define STOPS 64 /* colours along the gradient; finer than the control points of the maps */

/* Label texts and their left ends on a horizontal bar. */
typedef struct label_row {
    char text[PTIE_MAX_TICKS][2 * PTIE_LABEL_BYTES + 16];
    double left[PTIE_MAX_TICKS];
} label_row;

/* A bar whose colour runs from (x0, y0) to (x1, y1), in the given rectangle. */
static void gradient(cairo_t *cr, ptie_colormap map, double x0, double y0, double x1, double y1,
                     cairo_rectangle_t box) {
    cairo_pattern_t *pattern = cairo_pattern_create_linear(x0, y0, x1, y1);
    for (int i = 0; i <= STOPS; i++) {
        double share = (double)i / STOPS;
        uint32_t rgb = ptie_colour(map, share);
        cairo_pattern_add_color_stop_rgb(pattern, share, (rgb >> 16) / 255.0,
                                         (rgb >> 8 & 255) / 255.0, (rgb & 255) / 255.0);
    }
    cairo_rectangle(cr, box.x, box.y, box.width, box.height);
    cairo_set_source(cr, pattern);
    cairo_fill_preserve(cr);
    cairo_pattern_destroy(pattern);
    ptie_set_colour(cr, 0);
    cairo_set_line_width(cr, 0.5);
    cairo_stroke(cr);
}

static double share_of(ptie_limits span, double value) {
    return (value - span.low) / (span.high - span.low);
}

/* The last label carries the power of ten and the unit; labels stay within the bar.  False when two
   come closer than a space. */
static bool place(label_row *out, cairo_t *cr, const ptie_ticks *ticks, ptie_limits span,
                  const char *unit, double length) {
    double taken = -HUGE_VAL;
    for (int32_t i = 0; i < ticks->count; i++) {
        char number[PTIE_LABEL_BYTES], factor[PTIE_LABEL_BYTES] = "";
        bool last = i == ticks->count - 1;
        ptie_tick_label(number, ticks, i);
        if (last) ptie_tick_factor(factor, ticks);
        snprintf(out->text[i], sizeof out->text[i], "%s%s%s%.15s", number, factor,
                 last && unit ? " " : "", last && unit ? unit : "");
        double width = ptie_text_width(cr, out->text[i]);
        double left = length * share_of(span, ticks->value[i]) - ptie_text_width(cr, number) / 2;
        out->left[i] = fmax(0, fmin(left, length - width));
        if (out->left[i] < taken + 3) return false;
        taken = out->left[i] + width;
    }
    return true;
}

/* As many ticks as their labels have room for, but two at least. */
static void choose_ticks(ptie_ticks *ticks, label_row *labels, cairo_t *cr, ptie_limits span,
                         const char *unit, double length) {
    for (int32_t most = 7; most >= 3; most--) {
        ptie_linear_ticks(ticks, span.low, span.high, most, false);
        if (ticks->count >= 2 && place(labels, cr, ticks, span, unit, length)) return;
    }
    ptie_linear_ticks(ticks, span.low, span.high, 5, false);
    ticks->value[1] = ticks->value[ticks->count - 1];
    ticks->count = 2;
    (void)place(labels, cr, ticks, span, unit, length);
}

void ptie_draw_bar_below(cairo_t *cr, ptie_colormap map, ptie_limits span, const char *unit,
                         double x, double y, double length) {
    ptie_ticks ticks;
    label_row labels;
    ptie_set_type(cr, PTIE_SMALL, false);
    choose_ticks(&ticks, &labels, cr, span, unit, length);
    gradient(cr, map, x, y, x + length, y, (cairo_rectangle_t){x, y, length, THICKNESS});
    for (int32_t i = 0; i < ticks.count; i++) {
        double at = x + length * share_of(span, ticks.value[i]);
        cairo_move_to(cr, at, y + THICKNESS);
        cairo_rel_line_to(cr, 0, TICK);
        cairo_stroke(cr);
        ptie_text_at(cr, labels.text[i], x + labels.left[i], y + THICKNESS + TICK + 7, 0);
    }
}

void ptie_draw_bar_beside(cairo_t *cr, ptie_colormap map, ptie_limits span, const char *unit,
                          double x, double y, double length) {
    ptie_ticks ticks;
    char text[PTIE_LABEL_BYTES];
    int32_t most = (int32_t)fmax(2, fmin(8, length / 16));
    ptie_set_type(cr, PTIE_SMALL, false);
    ptie_linear_ticks(&ticks, span.low, span.high, most, false);
    gradient(cr, map, x, y + length, x, y, (cairo_rectangle_t){x, y, THICKNESS, length});
    for (int32_t i = 0; i < ticks.count; i++) {
        double at = y + length * (1 - share_of(span, ticks.value[i]));
        cairo_move_to(cr, x + THICKNESS, at);
        cairo_rel_line_to(cr, TICK, 0);
        cairo_stroke(cr);
        ptie_tick_label(text, &ticks, i);
        ptie_text_at(cr, text, x + THICKNESS + TICK + 1.5, at + 2.5, 0);
    }
    ptie_tick_factor(text, &ticks);
    ptie_text_at(cr, text, x, y - 3.5, 0);
    ptie_text_at(cr, unit, x + (text[0] ? ptie_text_width(cr, text) + 2 : 0), y - 3.5, 0);
}
