/* SPDX-License-Identifier: BSD-3-Clause */
/* Figures: phase maps side by side, curves side by side.  Arguments are checked in
 * src/api/figure.c. */
#ifndef PTIE_REPORT_REPORT_H
#define PTIE_REPORT_REPORT_H

#include <ptie/figure.h>

/* Printed width when the caller leaves it open: two columns of a journal. */
#define PTIE_FIGURE_WIDTH_MM 180.0

ptie_status ptie_draw_panels(const char *path, const ptie_panels *figure, bool overwrite);
ptie_status ptie_draw_curves(const char *path, const ptie_axes *axes, int32_t count,
                             const char *title, double width_mm, bool overwrite);

#endif
