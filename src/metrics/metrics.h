/* SPDX-License-Identifier: BSD-3-Clause */
/* The metrics inside the library; contracts as in <ptie/metrics.h>, arguments already checked. */
#ifndef PTIE_METRICS_METRICS_H
#define PTIE_METRICS_METRICS_H

#include <ptie/metrics.h>

#include "base/status.h"

ptie_status ptie_metrics_compare(ptie_comparison *out, const float *estimate, const float *truth,
                                 int32_t width, int32_t height, double range);
/* Mean SSIM over valid windows (Q3); NaN below 11 x 11. */
ptie_status ptie_metrics_ssim(double *out, const float *a, const float *b, int32_t width,
                              int32_t height, double range);

ptie_status ptie_metrics_residual(double *out, const float *reprojected, const float *measured,
                                  int32_t width, int32_t height);

ptie_status ptie_metrics_label_rects(uint8_t *labels, int32_t width, int32_t height, ptie_rect jet,
                                     ptie_rect background);
ptie_status ptie_metrics_propose(uint8_t *labels, const float *map, int32_t width, int32_t height);

ptie_status ptie_metrics_flow(ptie_flow_metrics *out, const float *map, const uint8_t *labels,
                              int32_t width, int32_t height);

#endif
