/* SPDX-License-Identifier: BSD-3-Clause */
/* Phase maps in rows and columns.  All columns have the same width; a row is as high as its highest
   map. Where all maps of a row mean the same by a colour, one bar stands beside the row; else each
   map has its own below it.  Lengths are in points. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "report/map.h"
#include "report/report.h"

#define MARGIN 3.0
#define GAP 7.0
#define TITLE 12.0     /* above a map */
#define HEADLINE 17.0  /* above the figure */
#define ROW_TITLE 13.0 /* left of a row */
#define TALLEST 600.0  /* map; leaves room for text on a page */

typedef struct layout {
    const ptie_panels *figure;
    ptie_limits *spans; /* one per panel */
    bool beside;        /* one bar per row */
    double width, left, column;
} layout;

static const ptie_panel *panel_at(const layout *l, int32_t row, int32_t column) {
    return &l->figure->panels[row * l->figure->columns + column];
}

static ptie_limits span_at(const layout *l, int32_t row, int32_t column) {
    return l->spans[row * l->figure->columns + column];
}

/* The first panel of a row that has data, or NULL. */
static const ptie_panel *first_of_row(const layout *l, int32_t row) {
    for (int32_t c = 0; c < l->figure->columns; c++)
        if (panel_at(l, row, c)->data) return panel_at(l, row, c);
    return NULL;
}

static bool same_text(const char *a, const char *b) {
    return a == b || (a && b && strcmp(a, b) == 0);
}

static bool row_shares_bar(const layout *l, int32_t row) {
    const ptie_panel *first = first_of_row(l, row);
    for (int32_t c = 0; first && c < l->figure->columns; c++) {
        const ptie_panel *panel = panel_at(l, row, c);
        ptie_limits a = l->spans[first - l->figure->panels], b = span_at(l, row, c);
        if (panel->data && (panel->colormap != first->colormap || a.low != b.low ||
                            a.high != b.high || !same_text(panel->unit, first->unit)))
            return false;
    }
    return true;
}

static ptie_status plan(layout *l, const ptie_panels *figure) {
    double millimetres = figure->width_mm > 0 ? figure->width_mm : PTIE_FIGURE_WIDTH_MM;
    size_t count = (size_t)figure->rows * (size_t)figure->columns;
    *l = (layout){.figure = figure, .width = millimetres * PTIE_POINTS_PER_MM, .beside = true};
    PTIE_TRY(ptie_alloc_status(&l->spans, count, sizeof *l->spans, "figure"));
    for (size_t i = 0; i < count; i++) PTIE_TRY(ptie_panel_span(&l->spans[i], &figure->panels[i]));
    for (int32_t r = 0; r < figure->rows; r++) l->beside &= row_shares_bar(l, r);
    l->left = MARGIN + (figure->row_titles ? ROW_TITLE : 0);
    double room = l->width - l->left - (l->beside ? PTIE_BAR_BESIDE : MARGIN);
    l->column = (room - GAP * (figure->columns - 1)) / figure->columns;
    return PTIE_OK;
}

/* Where a map goes: as wide as the column, unless that makes it too high. */
static cairo_rectangle_t map_box(const layout *l, const ptie_panel *panel, int32_t column,
                                 double y) {
    double aspect = (double)panel->height_px / panel->width_px;
    double height = fmin(l->column * aspect, fmin(2 * l->column, TALLEST));
    double width = height / aspect;
    double x = l->left + column * (l->column + GAP) + (l->column - width) / 2;
    return (cairo_rectangle_t){x, y, width, height};
}

static double row_titles_height(const layout *l, int32_t row) {
    for (int32_t c = 0; c < l->figure->columns; c++)
        if (panel_at(l, row, c)->title) return TITLE;
    return l->beside && first_of_row(l, row) && first_of_row(l, row)->unit ? TITLE : 0;
}

static double row_maps_height(const layout *l, int32_t row) {
    double height = 0;
    for (int32_t c = 0; c < l->figure->columns; c++)
        if (panel_at(l, row, c)->data)
            height = fmax(height, map_box(l, panel_at(l, row, c), c, 0).height);
    return height;
}

static double row_height(const layout *l, int32_t row) {
    return row_titles_height(l, row) + row_maps_height(l, row) + (l->beside ? 0 : PTIE_BAR_BELOW);
}

static double figure_height(const layout *l) {
    double height = 2 * MARGIN + (l->figure->title ? HEADLINE : 0) + GAP * (l->figure->rows - 1);
    for (int32_t r = 0; r < l->figure->rows; r++) height += row_height(l, r);
    return height;
}

static void draw_panel(cairo_t *cr, const layout *l, int32_t row, int32_t column, double y) {
    const ptie_panel *panel = panel_at(l, row, column);
    if (!panel->data) return;
    ptie_limits span = span_at(l, row, column);
    cairo_rectangle_t box = map_box(l, panel, column, y);
    ptie_set_type(cr, PTIE_NORMAL, false);
    ptie_text_within(cr, panel->title, box.x + box.width / 2, y - 3.5, 0.5, l->column + GAP - 2);
    ptie_draw_map(cr, panel, span, box);
    if (!l->beside)
        ptie_draw_bar_below(cr, panel->colormap, span, panel->unit, box.x, y + box.height + 3,
                            box.width);
}

static void draw_row(cairo_t *cr, const layout *l, int32_t row, double y) {
    double height = row_maps_height(l, row);
    y += row_titles_height(l, row);
    if (l->figure->row_titles && l->figure->row_titles[row]) {
        ptie_set_type(cr, PTIE_NORMAL, false);
        ptie_text_upwards(cr, l->figure->row_titles[row], MARGIN + 5, y + height / 2, height);
    }
    for (int32_t c = 0; c < l->figure->columns; c++) draw_panel(cr, l, row, c, y);
    const ptie_panel *first = first_of_row(l, row);
    if (l->beside && first)
        ptie_draw_bar_beside(cr, first->colormap, l->spans[first - l->figure->panels], first->unit,
                             l->width - PTIE_BAR_BESIDE + 5, y, height);
}

static void draw(cairo_t *cr, const layout *l) {
    double y = MARGIN;
    if (l->figure->title) {
        ptie_set_type(cr, PTIE_LARGE, true);
        ptie_text_within(cr, l->figure->title, l->width / 2, y + PTIE_LARGE, 0.5,
                         l->width - 2 * MARGIN);
        y += HEADLINE;
    }
    for (int32_t r = 0; r < l->figure->rows; r++) {
        draw_row(cr, l, r, y);
        y += row_height(l, r) + GAP;
    }
}

ptie_status ptie_draw_panels(const char *path, const ptie_panels *figure, bool overwrite) {
    layout l;
    ptie_canvas canvas;
    ptie_status status = plan(&l, figure);
    if (status == PTIE_OK && l.column < 20)
        status =
            PTIE_FAIL(PTIE_EINVAL, "%s: too narrow for %d columns", path, (int)figure->columns);
    if (status == PTIE_OK)
        status = ptie_canvas_open(&canvas, path, l.width, figure_height(&l), overwrite);
    if (status == PTIE_OK) {
        draw(canvas.cr, &l);
        status = ptie_canvas_close(&canvas);
    }
    ptie_free(l.spans);
    return status;
}
