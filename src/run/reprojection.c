/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/reprojection.h"

#include <math.h>

#include "base/memory.h"
#include "metrics/metrics.h"
#include "optics/optics.h"
#include "run/planes.h"
#include "tie/derivative.h"

struct ptie_reprojection {
    ptie_tie_weights weights;
    int32_t width, height;
    double defocus_m;
    ptie_optics *optics;
    size_t pixels, bytes; /* of one worker's scratch */
    unsigned char *scratch;
};

/* A worker's scratch. */
typedef struct work {
    float *measured, *plus, *minus; /* (H, W) */
    void *optics;
} work;

static work carve(const ptie_reprojection *r, ptie_slicer *slicer) {
    work w;
    w.measured = ptie_slice(slicer, r->pixels, sizeof(float));
    w.plus = ptie_slice(slicer, r->pixels, sizeof(float));
    w.minus = ptie_slice(slicer, r->pixels, sizeof(float));
    w.optics = ptie_slice(slicer, ptie_optics_scratch(r->optics), 1);
    return w;
}

static ptie_status build(ptie_reprojection *r, const ptie_solver_params *solver, int32_t workers) {
    PTIE_TRY(ptie_tie_weigh(&r->weights, solver));
    /* Linear, so the distance is free: the one of the recording keeps the numbers near 1. */
    PTIE_TRY(ptie_optics_plan(&r->optics, &(ptie_optics_params){
                                              .struct_size = sizeof(ptie_optics_params),
                                              .width_px = r->width,
                                              .height_px = r->height,
                                              .pixel_m = solver->pixel_m,
                                              .wavelength_m = solver->wavelength_m,
                                              .defocus_m = r->defocus_m,
                                              .boundary = solver->boundary,
                                              .propagation = PTIE_TIE_SPECTRAL,
                                          }));
    ptie_slicer slicer = {0};
    carve(r, &slicer);
    r->bytes = slicer.used;
    return ptie_alloc_status(&r->scratch, (size_t)workers, r->bytes, "run: scratch");
}

ptie_status ptie_reprojection_create(ptie_reprojection **out, const ptie_rig *rig, int32_t width_px,
                                     int32_t height_px, int32_t workers) {
    *out = NULL;
    ptie_reprojection *r;
    PTIE_TRY(ptie_alloc_status(&r, 1, sizeof *r, "run"));
    const ptie_solver_params solver = ptie_rig_solver(rig, width_px, height_px);
    r->width = width_px;
    r->height = height_px;
    r->pixels = (size_t)width_px * (size_t)height_px;
    r->defocus_m = fabs(rig->plane[PTIE_PLUS].defocus_m);
    ptie_status status = build(r, &solver, workers);
    if (status == PTIE_OK)
        *out = r;
    else
        ptie_reprojection_free(r);
    return status;
}

void ptie_reprojection_free(ptie_reprojection *r) {
    if (!r) return;
    ptie_optics_free(r->optics);
    ptie_free(r->scratch);
    ptie_free(r);
}

ptie_status ptie_reprojection_measure(const ptie_reprojection *r, int32_t worker, double *residual,
                                      const float *const *maps, size_t count,
                                      const float *const *planes) {
    const work w = carve(r, &(ptie_slicer){.base = r->scratch + (size_t)worker * r->bytes});
    const double scale = 1 / (2 * r->defocus_m);
    PTIE_TRY(ptie_tie_derivative(w.measured, &r->weights, planes));
    for (size_t n = 0; n < count; n++) {
        PTIE_TRY(ptie_optics_defocus(r->optics, w.plus, w.minus, maps[n], NULL, w.optics));
        for (size_t i = 0; i < r->pixels; i++)
            w.plus[i] = (float)(scale * ((double)w.plus[i] - (double)w.minus[i]));
        PTIE_TRY(ptie_metrics_residual(&residual[n], w.plus, w.measured, r->width, r->height));
    }
    return PTIE_OK;
}
