/* SPDX-License-Identifier: BSD-3-Clause */
/* Figures for papers: phase maps with colour and scale bars, and curves; PNG or SVG by the ending of the
 * path.  Legible in print: 300 dpi, sans serif, >= 7 pt at the stated width.
 */
#ifndef PTIE_FIGURE_H
#define PTIE_FIGURE_H

#include <ptie/status.h>

typedef enum ptie_colormap {
    PTIE_GRAY = 0,     /* intensity */
    PTIE_VIRIDIS = 1,  /* phase of one sign */
    PTIE_DIVERGING = 2 /* phase of both signs: blue - white - red, centred on 0 */
} ptie_colormap;

typedef struct ptie_panel {
    const float *data;       /* height x width; NULL leaves the place empty */
    int32_t width_px, height_px;
    const char *title;       /* UTF-8 or NULL */
    const char *unit;        /* of the colour bar, "rad" or NULL */
    ptie_colormap colormap;
    double low, high;        /* value range; equal = 0.5 % and 99.5 % quantile of the data */
    double pixel_m;          /* > 0: draws a scale bar */
} ptie_panel;

typedef struct ptie_panels {
    const ptie_panel *panels; /* rows x columns, row-major */
    int32_t rows, columns;
    const char *const *row_titles; /* rows strings or NULL */
    const char *title;             /* or NULL */
    double width_mm;               /* printed width, default when 0: 180 */
} ptie_panels;

/* Draws panels.  Written whole or not at all.  Errors: PTIE_EINVAL, PTIE_EEXIST, PTIE_EIO, PTIE_ENOMEM,
   PTIE_EUNSUPPORTED (ending).  Thread-safe. */
PTIE_API PTIE_NODISCARD ptie_status ptie_figure_panels(const char *path, const ptie_panels *figure,
                                                       bool overwrite);

typedef struct ptie_curve {
    const double *x, *y; /* count points; NaN leaves a gap */
    size_t count;
    const char *label;   /* legend, or NULL */
    bool dashed, markers;
    int32_t colour;      /* index into a colour-blind-safe cycle */
} ptie_curve;

typedef struct ptie_axes {
    const ptie_curve *curves;
    int32_t count;
    const char *title, *x_label, *y_label;
    bool log_y;
} ptie_axes;

/* Draws axes side by side (a, b, c, ...).  Errors and rules as ptie_figure_panels. */
PTIE_API PTIE_NODISCARD ptie_status ptie_figure_curves(const char *path, const ptie_axes *axes,
                                                       int32_t count, const char *title,
                                                       double width_mm, bool overwrite);

#endif
