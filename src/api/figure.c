/* SPDX-License-Identifier: BSD-3-Clause */
/* Argument checks of ptie/figure.h. */
#include <ptie/figure.h>

#include <math.h>

#include "api/params.h"
#include "report/report.h"

#define MOST_PANELS 4096
#define MOST_AXES 26 /* they are lettered */

static ptie_status check_width(double width_mm, const char *where) {
    if (width_mm == 0 || (width_mm >= 20 && width_mm <= 2000)) return PTIE_OK;
    return PTIE_FAIL(PTIE_EINVAL, "%s: width_mm out of range (expected 0 or 20..2000, found %g)", where,
                     width_mm);
}

static ptie_status check_panel(const ptie_panel *panel, const char *where) {
    if (!panel->data) return PTIE_OK;
    PTIE_TRY(ptie_check_integer(panel->width_px, 1, 1 << 20, where, "width_px"));
    PTIE_TRY(ptie_check_integer(panel->height_px, 1, 1 << 20, where, "height_px"));
    PTIE_TRY(ptie_check_integer(panel->colormap, PTIE_GRAY, PTIE_DIVERGING, where, "colormap"));
    if (!isfinite(panel->pixel_m))
        return PTIE_FAIL(PTIE_EINVAL, "%s: pixel_m is not finite (found %g)", where, panel->pixel_m);
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
    for (int32_t i = 0; i < figure->rows * figure->columns; i++)
        PTIE_TRY(check_panel(&figure->panels[i], where));
    return ptie_draw_panels(path, figure, overwrite);
}

ptie_status ptie_figure_curves(const char *path, const ptie_axes *axes, int32_t count,
                               const char *title, double width_mm, bool overwrite) {
    static const char where[] = "ptie_figure_curves";
    PTIE_TRY(ptie_check_pointer(path, where, "path"));
    PTIE_TRY(ptie_check_pointer(axes, where, "axes"));
    PTIE_TRY(ptie_check_integer(count, 1, MOST_AXES, where, "count"));
    PTIE_TRY(check_width(width_mm, where));
    for (int32_t i = 0; i < count; i++) {
        PTIE_TRY(ptie_check_integer(axes[i].count, 0, 1 << 20, where, "curves"));
        for (int32_t c = 0; c < axes[i].count; c++) {
            const ptie_curve *curve = &axes[i].curves[c];
            if (curve->count == 0) continue;
            PTIE_TRY(ptie_check_pointer(curve->x, where, "x"));
            PTIE_TRY(ptie_check_pointer(curve->y, where, "y"));
        }
    }
    return ptie_draw_curves(path, axes, count, title, width_mm, overwrite);
}
