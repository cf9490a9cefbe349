/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves on axes that stand side by side and are lettered a), b), c).  Lengths are in points. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "report/canvas.h"
#include "report/colormap.h"
#include "report/report.h"
#include "report/ticks.h"

#define MARGIN 3.0
#define GAP 12.0
#define HEADLINE 17.0 /* title of the figure */
#define TITLE 14.0    /* title of one axes */
#define BELOW 26.0    /* tick labels and label of the x axis */
#define LARGEST 1e100 /* larger values are gaps: ranges of them would overflow */
#define FACTOR 26.0   /* power of ten above the y axis, beside the title */
#define MOST_TICKS 6
#define PAD_X 0.03 /* share of the range that stays free at both ends */
#define PAD_Y 0.06
#define TALLEST 220.0
#define LEGEND_LINE 10.0
#define LEGEND_SAMPLE 16.0
#define LEGEND_GAP 14.0  /* between entries side by side */
#define LEGEND_PLACES 30 /* that a legend inside a plot tries */
#define LINE_POINTS 8    /* of a line between two points that are looked at */

typedef struct axis {
    double low, high;
    bool logarithmic;
    ptie_ticks ticks;
} axis;

/* One axes ready to draw: the plot's rectangle and its two axes. */
typedef struct plot {
    const ptie_axes *axes;
    axis x, y;
    cairo_rectangle_t box;
} plot;

static bool drawable(const axis *a, double value) {
    if (a->logarithmic && value < 1 / LARGEST) return false;
    return fabs(value) <= LARGEST; /* false for NaN */
}

static double share_of(const axis *a, double value) {
    if (a->logarithmic) return log(value / a->low) / log(a->high / a->low);
    return (value - a->low) / (a->high - a->low);
}

static double place_x(const plot *p, double x) {
    return p->box.x + p->box.width * share_of(&p->x, x);
}

static double place_y(const plot *p, double y) {
    return p->box.y + p->box.height * (1 - share_of(&p->y, y));
}

static void include(axis *a, double value) {
    if (!drawable(a, value)) return;
    a->low = fmin(a->low, value);
    a->high = fmax(a->high, value);
}

static bool shown(const plot *p, const ptie_curve *curve, size_t i) {
    return drawable(&p->x, curve->x[i]) && drawable(&p->y, curve->y[i]);
}

/* Finds the ranges; true when all x are whole numbers (epochs, frames). */
static bool scan(plot *p) {
    bool whole = true;
    p->x = p->y = (axis){.low = HUGE_VAL, .high = -HUGE_VAL};
    p->y.logarithmic = p->axes->log_y;
    for (int32_t c = 0; c < p->axes->count; c++) {
        const ptie_curve *curve = &p->axes->curves[c];
        for (size_t i = 0; i < curve->count; i++) {
            if (!shown(p, curve, i)) continue;
            include(&p->x, curve->x[i]);
            include(&p->y, curve->y[i]);
            whole &= curve->x[i] == rint(curve->x[i]);
        }
    }
    return whole;
}

static void pad(axis *a, double share) {
    if (a->logarithmic) {
        double factor = pow(a->high / a->low, share);
        a->low /= factor;
        a->high *= factor;
    } else {
        double margin = share * (a->high - a->low);
        a->low -= margin;
        a->high += margin;
    }
}

static void set_ranges(plot *p) {
    bool whole = scan(p);
    ptie_widen(&p->x.low, &p->x.high);
    ptie_linear_ticks(&p->x.ticks, p->x.low, p->x.high, MOST_TICKS, whole);
    pad(&p->x, PAD_X);
    if (p->y.logarithmic && !(p->y.low < p->y.high)) {
        p->y.low = isfinite(p->y.low) ? p->y.low / 2 : 1;
        p->y.high = 4 * p->y.low;
    }
    ptie_widen(&p->y.low, &p->y.high);
    pad(&p->y, PAD_Y);
    if (p->y.logarithmic)
        ptie_log_ticks(&p->y.ticks, p->y.low, p->y.high, MOST_TICKS);
    else
        ptie_linear_ticks(&p->y.ticks, p->y.low, p->y.high, MOST_TICKS, false);
}

static double widest_label(cairo_t *cr, const ptie_ticks *ticks) {
    double widest = 0;
    char text[PTIE_LABEL_BYTES];
    for (int32_t i = 0; i < ticks->count; i++) {
        ptie_tick_label(text, ticks, i);
        widest = fmax(widest, ptie_text_width(cr, text));
    }
    return widest;
}

/* Room that tick labels and label of the y axis take. */
static double left_of(const plot *p) {
    ptie_canvas page;
    ptie_canvas_measure(&page);
    ptie_set_type(page.cr, PTIE_SMALL, false);
    double width = widest_label(page.cr, &p->y.ticks) + 5 + (p->axes->y_label ? 12 : 0);
    ptie_canvas_discard(&page);
    return width;
}

static void draw_x_axis(cairo_t *cr, const plot *p) {
    char text[PTIE_LABEL_BYTES];
    double base = p->box.y + p->box.height;
    for (int32_t i = 0; i < p->x.ticks.count; i++) {
        double x = place_x(p, p->x.ticks.value[i]);
        cairo_move_to(cr, x, base);
        cairo_rel_line_to(cr, 0, 2.5);
        cairo_stroke(cr);
        ptie_tick_label(text, &p->x.ticks, i);
        ptie_text_at(cr, text, x, base + 10.5, 0.5);
    }
    ptie_tick_factor(text, &p->x.ticks);
    ptie_text_at(cr, text, p->box.x + p->box.width, base + 20, 1);
}

static void draw_y_axis(cairo_t *cr, const plot *p) {
    char text[PTIE_LABEL_BYTES];
    for (int32_t i = 0; i < p->y.ticks.count; i++) {
        double y = place_y(p, p->y.ticks.value[i]);
        cairo_move_to(cr, p->box.x, y);
        cairo_rel_line_to(cr, p->box.width, 0);
        ptie_set_colour(cr, 0xe0e0e0);
        cairo_stroke(cr);
        cairo_move_to(cr, p->box.x - 2.5, y);
        cairo_rel_line_to(cr, 2.5, 0);
        ptie_set_colour(cr, 0);
        cairo_stroke(cr);
        ptie_tick_label(text, &p->y.ticks, i);
        ptie_text_at(cr, text, p->box.x - 4, y + 2.5, 1);
    }
    ptie_tick_factor(text, &p->y.ticks);
    ptie_text_at(cr, text, p->box.x, p->box.y - 2.5, 0);
}

static void draw_frame(cairo_t *cr, const plot *p) {
    ptie_set_colour(cr, 0);
    ptie_set_type(cr, PTIE_SMALL, false);
    cairo_set_line_width(cr, 0.6);
    double widest = widest_label(cr, &p->y.ticks);
    draw_y_axis(cr, p);
    draw_x_axis(cr, p);
    cairo_rectangle(cr, p->box.x, p->box.y, p->box.width, p->box.height);
    cairo_stroke(cr);
    ptie_set_type(cr, PTIE_NORMAL, false);
    ptie_text_within(cr, p->axes->x_label, p->box.x + p->box.width / 2,
                     p->box.y + p->box.height + 21, 0.5, p->box.width);
    if (p->axes->y_label)
        ptie_text_upwards(cr, p->axes->y_label, p->box.x - widest - 11,
                          p->box.y + p->box.height / 2, p->box.height);
}

static void set_pen(cairo_t *cr, const ptie_curve *curve) {
    static const double dash[] = {4, 2.5};
    ptie_set_colour(cr, ptie_curve_colour(curve->colour));
    cairo_set_line_width(cr, 1.2);
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    cairo_set_dash(cr, dash, curve->dashed ? 2 : 0, 0);
}

static void dot(cairo_t *cr, double x, double y) {
    cairo_arc(cr, x, y, 1.7, 0, 2 * M_PI);
    cairo_fill(cr);
}

static void draw_curve(cairo_t *cr, const plot *p, const ptie_curve *curve) {
    set_pen(cr, curve);
    bool drawing = false;
    for (size_t i = 0; i < curve->count; i++) {
        bool on = shown(p, curve, i);
        if (on)
            (drawing ? cairo_line_to : cairo_move_to)(cr, place_x(p, curve->x[i]),
                                                      place_y(p, curve->y[i]));
        drawing = on;
    }
    cairo_stroke(cr);
    for (size_t i = 0; i < curve->count; i++) {
        bool alone = (i == 0 || !shown(p, curve, i - 1)) &&
                     (i + 1 == curve->count || !shown(p, curve, i + 1));
        if (shown(p, curve, i) && (curve->markers || alone))
            dot(cr, place_x(p, curve->x[i]), place_y(p, curve->y[i]));
    }
}

static int32_t labelled(const ptie_axes *axes) {
    int32_t count = 0;
    for (int32_t c = 0; c < axes->count; c++) count += axes->curves[c].label != NULL;
    return count;
}

/* How much of a curve runs through a rectangle: its points, and some on the lines between. */
static size_t hidden(const plot *p, const ptie_curve *curve, cairo_rectangle_t box) {
    size_t count = 0;
    for (size_t i = 0; i < curve->count; i++) {
        if (!shown(p, curve, i)) continue;
        size_t next = i + 1 < curve->count && shown(p, curve, i + 1) ? i + 1 : i;
        double x0 = place_x(p, curve->x[i]), x1 = place_x(p, curve->x[next]);
        double y0 = place_y(p, curve->y[i]), y1 = place_y(p, curve->y[next]);
        for (int k = 0; k < LINE_POINTS; k++) {
            double x = x0 + (x1 - x0) * k / LINE_POINTS - box.x;
            double y = y0 + (y1 - y0) * k / LINE_POINTS - box.y;
            count += x >= -3 && x <= box.width + 3 && y >= -3 && y <= box.height + 3;
        }
    }
    return count;
}

/* The place at the right or left edge, from top to bottom, that hides the least. */
static cairo_rectangle_t legend_box(const plot *p, double width, double height) {
    cairo_rectangle_t best = {0};
    size_t least = SIZE_MAX;
    for (int place = 0; place < LEGEND_PLACES; place++) {
        bool left = place % 2;
        double down = (double)(place / 2) / (LEGEND_PLACES / 2 - 1);
        cairo_rectangle_t box = {left ? p->box.x + 4 : p->box.x + p->box.width - width - 4,
                                 p->box.y + 4 + down * (p->box.height - height - 8), width, height};
        size_t count = 0;
        for (int32_t c = 0; c < p->axes->count; c++) count += hidden(p, &p->axes->curves[c], box);
        if (count < least) best = box, least = count;
    }
    return best;
}

/* Sample of the line and label, from x on, with the line at y. */
static void draw_legend_entry(cairo_t *cr, const ptie_curve *curve, double x, double y) {
    set_pen(cr, curve);
    cairo_move_to(cr, x, y);
    cairo_rel_line_to(cr, LEGEND_SAMPLE, 0);
    cairo_stroke(cr);
    if (curve->markers) dot(cr, x + LEGEND_SAMPLE / 2, y);
    cairo_set_dash(cr, NULL, 0, 0);
    ptie_set_colour(cr, 0);
    ptie_text_at(cr, curve->label, x + LEGEND_SAMPLE + 4, y + 2.5, 0);
}

/* Inside the plot, one entry below the other. */
static void draw_legend(cairo_t *cr, const plot *p) {
    const ptie_axes *axes = p->axes;
    if (labelled(axes) == 0) return;
    double widest = 0;
    ptie_set_type(cr, PTIE_SMALL, false);
    for (int32_t c = 0; c < axes->count; c++)
        if (axes->curves[c].label)
            widest = fmax(widest, ptie_text_width(cr, axes->curves[c].label));
    cairo_rectangle_t box =
        legend_box(p, LEGEND_SAMPLE + widest + 10, LEGEND_LINE * labelled(axes) + 4);
    cairo_rectangle(cr, box.x, box.y, box.width, box.height);
    cairo_set_source_rgba(cr, 1, 1, 1, 0.85);
    cairo_fill(cr);
    double y = box.y + 2 + LEGEND_LINE / 2;
    for (int32_t c = 0; c < axes->count; c++) {
        if (!axes->curves[c].label) continue;
        draw_legend_entry(cr, &axes->curves[c], box.x + 3, y);
        y += LEGEND_LINE;
    }
}

static bool same_entry(const ptie_curve *a, const ptie_curve *b) {
    if (!a->label || !b->label) return a->label == b->label;
    return strcmp(a->label, b->label) == 0 && a->colour == b->colour && a->dashed == b->dashed &&
           a->markers == b->markers;
}

/* Axes with the same legend get it once, above all of them. */
static bool share_legend(const ptie_axes *axes, int32_t count) {
    if (count < 2 || labelled(&axes[0]) == 0) return false;
    for (int32_t i = 1; i < count; i++) {
        if (axes[i].count != axes[0].count) return false;
        for (int32_t c = 0; c < axes[0].count; c++)
            if (!same_entry(&axes[i].curves[c], &axes[0].curves[c])) return false;
    }
    return true;
}

/* The entries side by side, centred in the figure. */
static void draw_shared_legend(cairo_t *cr, const ptie_axes *axes, double width, double y) {
    double total = -LEGEND_GAP;
    ptie_set_type(cr, PTIE_SMALL, false);
    for (int32_t c = 0; c < axes->count; c++)
        if (axes->curves[c].label)
            total += LEGEND_SAMPLE + 4 + ptie_text_width(cr, axes->curves[c].label) + LEGEND_GAP;
    double x = (width - total) / 2;
    for (int32_t c = 0; c < axes->count; c++) {
        if (!axes->curves[c].label) continue;
        draw_legend_entry(cr, &axes->curves[c], x, y);
        x += LEGEND_SAMPLE + 4 + ptie_text_width(cr, axes->curves[c].label) + LEGEND_GAP;
    }
}

static void draw_plot(cairo_t *cr, const plot *p, int32_t index, bool letter, bool legend) {
    char title[256];
    draw_frame(cr, p);
    cairo_save(cr);
    cairo_rectangle(cr, p->box.x, p->box.y, p->box.width, p->box.height);
    cairo_clip(cr);
    for (int32_t c = 0; c < p->axes->count; c++) draw_curve(cr, p, &p->axes->curves[c]);
    cairo_set_dash(cr, NULL, 0, 0);
    if (legend) draw_legend(cr, p);
    cairo_restore(cr);
    const char *name = p->axes->title ? p->axes->title : "";
    if (letter)
        snprintf(title, sizeof title, "%c) %s", 'a' + index % 26, name);
    else
        snprintf(title, sizeof title, "%s", name);
    double factor = p->y.ticks.exponent ? 2 * FACTOR : 0;
    ptie_set_type(cr, PTIE_NORMAL, true);
    ptie_text_within(cr, title, p->box.x + p->box.width / 2, p->box.y - 4, 0.5,
                     p->box.width - factor);
}

/* Plots of one size, side by side; returns the height of the figure. */
static double lay_out(plot *plots, int32_t count, double cell, double top) {
    double left = 0;
    for (int32_t i = 0; i < count; i++) left = fmax(left, left_of(&plots[i]));
    double width = cell - left - 5; /* half of the last tick label may hang over */
    double height = fmin(0.8 * width, TALLEST);
    for (int32_t i = 0; i < count; i++)
        plots[i].box =
            (cairo_rectangle_t){MARGIN + i * (cell + GAP) + left, top + TITLE, width, height};
    return top + TITLE + height + BELOW;
}

static void draw(cairo_t *cr, const plot *plots, int32_t count, const char *title, double width,
                 bool shared) {
    double y = MARGIN;
    ptie_set_type(cr, PTIE_LARGE, true);
    ptie_text_within(cr, title, width / 2, y + PTIE_LARGE, 0.5, width - 2 * MARGIN);
    if (title) y += HEADLINE;
    if (shared) draw_shared_legend(cr, plots[0].axes, width, y + LEGEND_LINE / 2);
    for (int32_t i = 0; i < count; i++) draw_plot(cr, &plots[i], i, count > 1, !shared);
}

ptie_status ptie_draw_curves(const char *path, const ptie_axes *axes, int32_t count,
                             const char *title, double width_mm, bool overwrite) {
    double width = (width_mm > 0 ? width_mm : PTIE_FIGURE_WIDTH_MM) * PTIE_POINTS_PER_MM;
    double cell = (width - 2 * MARGIN - GAP * (count - 1)) / count;
    bool shared = share_legend(axes, count);
    if (cell < 80) return PTIE_FAIL(PTIE_EINVAL, "%s: too narrow for %d axes", path, (int)count);
    plot *plots;
    PTIE_TRY(ptie_alloc_status(&plots, (size_t)count, sizeof *plots, "figure"));
    for (int32_t i = 0; i < count; i++) {
        plots[i].axes = &axes[i];
        set_ranges(&plots[i]);
    }
    double top = MARGIN + (title ? HEADLINE : 0) + (shared ? LEGEND_LINE + 3 : 0);
    double height = lay_out(plots, count, cell, top);
    ptie_canvas canvas;
    ptie_status status = ptie_canvas_open(&canvas, path, width, height, overwrite);
    if (status == PTIE_OK) {
        draw(canvas.cr, plots, count, title, width, shared);
        status = ptie_canvas_close(&canvas);
    }
    ptie_free(plots);
    return status;
}
