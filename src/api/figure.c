/* SPDX-License-Identifier: BSD-3-Clause */
/* Argument checks of ptie/figure.h and ptie/report.h. */
#include <ptie/figure.h>

#include <math.h>

#include <ptie/report.h>

#include "api/params.h"
#include "report/report.h"
#include "report/run_report.h"

#define MOST_PANELS 4096
#define MOST_AXES 26 /* they are lettered */

static ptie_status check_width(double width_mm, const char *where) {
    if (width_mm == 0 || (width_mm >= 20 && width_mm <= 2000)) return PTIE_OK;
    return PTIE_FAIL(PTIE_EINVAL, "%s: width_mm out of range (expected 0 or 20..2000, found %g)",
                     where, width_mm);
}

/* Bytes that continue a character, or -1 where none begins. */
static int continuation(unsigned char c) {
    if (c < 0x80) return 0;
    if (c >= 0xc2 && c <= 0xdf) return 1;
    if (c >= 0xe0 && c <= 0xef) return 2;
    return c >= 0xf0 && c <= 0xf4 ? 3 : -1;
}

/* Cairo refuses other text, too, but does not give all of its memory back then. */
static ptie_status check_text(const char *text, const char *where, const char *name) {
    const unsigned char *c = (const unsigned char *)(text ? text : "");
    while (*c) {
        int more = continuation(*c++);
        bool good = more >= 0;
        for (; good && more > 0; more--) good = (*c++ & 0xc0) == 0x80;
        if (!good) return PTIE_FAIL(PTIE_EINVAL, "%s: %s is not UTF-8", where, name);
    }
    return PTIE_OK;
}

static ptie_status check_panel(const ptie_panel *panel, const char *where) {
    if (!panel->data) return PTIE_OK;
    PTIE_TRY(check_text(panel->title, where, "title"));
    PTIE_TRY(check_text(panel->unit, where, "unit"));
    PTIE_TRY(ptie_check_integer(panel->width_px, 1, 1 << 20, where, "width_px"));
    PTIE_TRY(ptie_check_integer(panel->height_px, 1, 1 << 20, where, "height_px"));
    PTIE_TRY(ptie_check_integer(panel->colormap, PTIE_GRAY, PTIE_DIVERGING, where, "colormap"));
    if (!isfinite(panel->pixel_m))
        return PTIE_FAIL(PTIE_EINVAL, "%s: pixel_m is not finite (found %g)", where,
                         panel->pixel_m);
    if (isfinite(panel->low) && isfinite(panel->high) && panel->low <= panel->high) return PTIE_OK;
    return PTIE_FAIL(PTIE_EINVAL, "%s: bad value range (expected low <= high, found %g..%g)", where,
                     panel->low, panel->high);
}

ptie_status ptie_figure_panels(const char *path, const ptie_panels *figure, bool overwrite) {
    static const char where[] = "ptie_figure_panels";
    PTIE_TRY(ptie_check_pointer(path, where, "path"));
    PTIE_TRY(ptie_check_pointer(figure, where, "figure"));
    PTIE_TRY(ptie_check_pointer(figure->panels, where, "panels"));
    PTIE_TRY(ptie_check_integer(figure->rows, 1, MOST_PANELS, where, "rows"));
    PTIE_TRY(ptie_check_integer(figure->columns, 1, MOST_PANELS / figure->rows, where, "columns"));
    PTIE_TRY(check_width(figure->width_mm, where));
    PTIE_TRY(check_text(figure->title, where, "title"));
    for (int32_t i = 0; figure->row_titles && i < figure->rows; i++)
        PTIE_TRY(check_text(figure->row_titles[i], where, "row title"));
    for (int32_t i = 0; i < figure->rows * figure->columns; i++)
        PTIE_TRY(check_panel(&figure->panels[i], where));
    return ptie_draw_panels(path, figure, overwrite);
}

static ptie_status check_axes(const ptie_axes *axes, const char *where) {
    PTIE_TRY(check_text(axes->title, where, "title"));
    PTIE_TRY(check_text(axes->x_label, where, "x_label"));
    PTIE_TRY(check_text(axes->y_label, where, "y_label"));
    PTIE_TRY(ptie_check_integer(axes->count, 0, 1 << 20, where, "curves"));
    for (int32_t c = 0; c < axes->count; c++) {
        const ptie_curve *curve = &axes->curves[c];
        PTIE_TRY(check_text(curve->label, where, "label"));
        if (curve->count == 0) continue;
        PTIE_TRY(ptie_check_pointer(curve->x, where, "x"));
        PTIE_TRY(ptie_check_pointer(curve->y, where, "y"));
    }
    return PTIE_OK;
}

ptie_status ptie_figure_curves(const char *path, const ptie_axes *axes, int32_t count,
                               const char *title, double width_mm, bool overwrite) {
    static const char where[] = "ptie_figure_curves";
    PTIE_TRY(ptie_check_pointer(path, where, "path"));
    PTIE_TRY(ptie_check_pointer(axes, where, "axes"));
    PTIE_TRY(ptie_check_integer(count, 1, MOST_AXES, where, "count"));
    PTIE_TRY(check_width(width_mm, where));
    PTIE_TRY(check_text(title, where, "title"));
    for (int32_t i = 0; i < count; i++) PTIE_TRY(check_axes(&axes[i], where));
    return ptie_draw_curves(path, axes, count, title, width_mm, overwrite);
}

ptie_status ptie_report_write(const char *html, const char *result, bool overwrite) {
    PTIE_TRY(ptie_check_pointer(html, "ptie_report_write", "html"));
    PTIE_TRY(ptie_check_pointer(result, "ptie_report_write", "result"));
    return ptie_draw_report(html, result, overwrite);
}
