/* SPDX-License-Identifier: BSD-3-Clause */
/* How far diffraction carries light across an edge, and what lies within that distance.  docs/math.md (M14). */
#include <math.h>
#include <string.h>

#include "tie/inner.h"

int32_t ptie_tie_reach(const ptie_solver_params *p) {
    double furthest = 0;
    for (int32_t i = 0; i < p->plane_count; i++) furthest = fmax(furthest, fabs(p->z_m[i]));
    const int32_t longest = p->width_px > p->height_px ? p->width_px : p->height_px;
    return (int32_t)fmin(ceil(furthest * p->wavelength_m / (2 * p->pixel_m * p->pixel_m)), longest);
}

/* Every `value` of a line spreads by `reach` to both sides.  behind: how far the last one is; what it reaches is
   marked as value + 2 until both sides are done. */
static void spread_line(uint8_t *line, int32_t count, ptrdiff_t step, uint8_t value, int32_t reach) {
    for (int direction = 0; direction < 2; direction++) {
        int32_t behind = reach;
        for (int32_t i = 0; i < count; i++) {
            uint8_t *at = line + (direction == 0 ? i : count - 1 - i) * step;
            if (*at == value)
                behind = 0;
            else if (++behind <= reach)
                *at = (uint8_t)(value + 2);
        }
    }
    for (int32_t i = 0; i < count; i++)
        if (line[i * step] == value + 2) line[i * step] = value;
}

void ptie_tie_spread(uint8_t *mask, int32_t width_px, int32_t height_px, uint8_t value, int32_t reach) {
    for (ptrdiff_t y = 0; y < height_px; y++) spread_line(mask + y * width_px, width_px, 1, value, reach);
    for (ptrdiff_t x = 0; x < width_px; x++) spread_line(mask + x, height_px, width_px, value, reach);
}

void ptie_tie_border(const ptie_solver *solver, uint8_t *mask) {
    const ptie_solver_params *p = &solver->params;
    const ptrdiff_t w = p->width_px, h = p->height_px;
    const int32_t reach = ptie_tie_reach(p);
    if (solver->mask)
        memcpy(mask, solver->mask, ptie_solver_pixels(solver));
    else
        memset(mask, 1, ptie_solver_pixels(solver));
    ptie_tie_spread(mask, p->width_px, p->height_px, 0, reach);
    for (ptrdiff_t y = 0; y < h; y++)
        for (ptrdiff_t x = 0; x < w; x++)
            if (x < reach || y < reach || w - 1 - x < reach || h - 1 - y < reach) mask[y * w + x] = 0;
}
