/* SPDX-License-Identifier: BSD-3-Clause */
/* Every morphology as one figure: the parametric flows above, the physical ones below. */
#include "gallery.h"

#include <stdlib.h>

#include "cli.h"

enum { COLUMNS = 6, MOST_ROWS = 16 };

typedef struct gallery {
    ptie_panel *panels;
    const char *row_titles[MOST_ROWS];
    float *maps;
    int32_t rows_per_family;
} gallery;

static ptie_status render_family(gallery *g, const ptie_flow_params *flow, ptie_family family) {
    size_t pixels = (size_t)flow->width_px * (size_t)flow->height_px;
    int32_t count = ptie_morphology_count(), first = (int32_t)family * g->rows_per_family;
    for (int32_t r = 0; r < g->rows_per_family; r++)
        g->row_titles[first + r] = family == PTIE_PHYSICAL ? "physical" : "parametric";
    for (int32_t i = 0; i < count; i++) {
        ptie_flow_params one = *flow;
        one.family = family;
        one.morphology = ptie_morphology_name(i);
        float *map = g->maps + ((size_t)family * (size_t)count + (size_t)i) * pixels;
        ptie_status status = ptie_flow_render(map, &one);
        if (status != PTIE_OK) return status;
        g->panels[first * COLUMNS + i] = (ptie_panel){
            .data = map,
            .width_px = flow->width_px,
            .height_px = flow->height_px,
            .title = ptie_morphology_title(i),
            .unit = family == PTIE_PHYSICAL ? "rad" : NULL,
            .colormap = family == PTIE_PHYSICAL ? PTIE_DIVERGING : PTIE_VIRIDIS,
            .high = family == PTIE_PHYSICAL ? 0 : 1,
            .pixel_m = family == PTIE_PHYSICAL && i == 0 ? flow->pixel_m : 0,
        };
    }
    return PTIE_OK;
}

int draw_gallery(const char *path, const ptie_flow_params *flow, bool force) {
    gallery g = {.rows_per_family = (ptie_morphology_count() + COLUMNS - 1) / COLUMNS};
    size_t pixels = (size_t)flow->width_px * (size_t)flow->height_px;
    size_t maps = 2 * (size_t)ptie_morphology_count();
    int32_t rows = 2 * g.rows_per_family;
    int code = check_figure(path, force);
    if (code != GO_ON) return code;
    g.maps = calloc(maps * pixels, sizeof *g.maps);
    g.panels = calloc((size_t)rows * COLUMNS, sizeof *g.panels);
    if (g.maps && g.panels && rows <= MOST_ROWS) {
        ptie_panels figure = {
            .panels = g.panels, .rows = rows, .columns = COLUMNS, .row_titles = g.row_titles};
        ptie_status status = render_family(&g, flow, PTIE_PARAMETRIC);
        if (status == PTIE_OK) status = render_family(&g, flow, PTIE_PHYSICAL);
        if (status == PTIE_OK) status = ptie_figure_panels(path, &figure, force);
        code = status == PTIE_OK ? DONE : failed(status);
    } else {
        code = failed(PTIE_ENOMEM);
    }
    free(g.maps);
    free(g.panels);
    return code;
}
