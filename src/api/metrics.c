/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/metrics.h>: arguments checked, then inward. */
#include <ptie/metrics.h>

#include "api/params.h"
#include "metrics/metrics.h"

static ptie_status check_image(const void *image, const char *name, int32_t width, int32_t height,
                               const char *where) {
    PTIE_TRY(ptie_check_pointer(image, where, name));
    PTIE_TRY(ptie_check_integer(width, 1, 32768, where, "width_px"));
    return ptie_check_integer(height, 1, 32768, where, "height_px");
}

ptie_status ptie_compare(ptie_comparison *out, const float *estimate, const float *truth,
                         int32_t width_px, int32_t height_px, double range) {
    static const char where[] = "ptie_compare";
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    PTIE_TRY(check_image(estimate, "estimate", width_px, height_px, where));
    PTIE_TRY(check_image(truth, "truth", width_px, height_px, where));
    PTIE_TRY(ptie_check_positive(range, where, "range"));
    return ptie_metrics_compare(out, estimate, truth, width_px, height_px, range);
}

ptie_status ptie_residual(double *out, const float *reprojected, const float *measured,
                          int32_t width_px, int32_t height_px) {
    static const char where[] = "ptie_residual";
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    PTIE_TRY(check_image(reprojected, "reprojected", width_px, height_px, where));
    PTIE_TRY(check_image(measured, "measured", width_px, height_px, where));
    return ptie_metrics_residual(out, reprojected, measured, width_px, height_px);
}

ptie_status ptie_regions_from_rects(uint8_t *labels, int32_t width_px, int32_t height_px,
                                    ptie_rect jet, ptie_rect background) {
    PTIE_TRY(check_image(labels, "labels", width_px, height_px, "ptie_regions_from_rects"));
    return ptie_metrics_label_rects(labels, width_px, height_px, jet, background);
}

ptie_status ptie_regions_propose(uint8_t *labels, const float *map, int32_t width_px,
                                 int32_t height_px) {
    static const char where[] = "ptie_regions_propose";
    PTIE_TRY(ptie_check_pointer(labels, where, "labels"));
    PTIE_TRY(check_image(map, "map", width_px, height_px, where));
    return ptie_metrics_propose(labels, map, width_px, height_px);
}

ptie_status ptie_flow_measure(ptie_flow_metrics *out, const float *map, const uint8_t *labels,
                              int32_t width_px, int32_t height_px) {
    static const char where[] = "ptie_flow_measure";
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    PTIE_TRY(ptie_check_pointer(labels, where, "labels"));
    PTIE_TRY(check_image(map, "map", width_px, height_px, where));
    return ptie_metrics_flow(out, map, labels, width_px, height_px);
}
