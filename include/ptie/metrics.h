/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers that say how good a phase map is: against truth, and without.  Paper sections 3.5 and 4.4,
 * docs/math.md (Q1)-(Q11).  Images are height x width, row-major, contiguous.  No allocation unless said.
 */
#ifndef PTIE_METRICS_H
#define PTIE_METRICS_H

#include <ptie/status.h>

typedef struct ptie_comparison {
    double psnr_db;     /* 10 log10(range^2 / MSE); +inf for equal images (Q1) */
    double mae;         /* mean |a - b| (Q2) */
    double rmse;        /* root mean square of a - b */
    double ssim;        /* 11x11 Gaussian, sigma 1.5, valid windows (Q3); NaN below 11 x 11 */
    double correlation; /* Pearson (Q8); NaN if an image is constant */
    double signal_kept; /* share of the truth's signal in the estimate (Q10): 1 all, 0 none; NaN if the truth
                           is constant */
} ptie_comparison;

/* Compares an estimate with the truth.  `range` is MAX of PSNR and L of SSIM: 1 for [0, 1] maps.
   Sizes are 1..32768.  Errors: PTIE_EINVAL, PTIE_ENUMERIC, PTIE_ENOMEM (SSIM windows). */
PTIE_API PTIE_NODISCARD ptie_status ptie_compare(ptie_comparison *out, const float *estimate,
                                                 const float *truth, int32_t width_px,
                                                 int32_t height_px, double range);

/* Re-projection residual (Q11): what a forward model makes of a map against what was measured (the axial
   derivative, or i_plus - i_minus), both with their means taken out, relative to the measured one.  0 for an exact
   inverse, noise included; the noise's share of the measurement for the truth; 1 for an empty map.  NaN when
   nothing was measured.  Errors: PTIE_EINVAL, PTIE_ENUMERIC. */
PTIE_API PTIE_NODISCARD ptie_status ptie_residual(double *out, const float *reprojected,
                                                  const float *measured, int32_t width_px,
                                                  int32_t height_px);

typedef struct ptie_rect {
    int32_t x_px, y_px, width_px, height_px; /* top-left corner and size */
} ptie_rect;

/* Region labels of one map, one byte per pixel. */
enum { PTIE_NOWHERE = 0, PTIE_JET = 1, PTIE_BACKGROUND = 2 };

/* labels (out): PTIE_JET inside `jet`, PTIE_BACKGROUND inside `background` (jet wins), else 0.
   Errors: PTIE_EINVAL (a rectangle leaves the image or is empty). */
PTIE_API PTIE_NODISCARD ptie_status ptie_regions_from_rects(uint8_t *labels, int32_t width_px,
                                                            int32_t height_px, ptie_rect jet,
                                                            ptie_rect background);

/* Proposes regions from a map (best: the time average of the denoised phase) of a flow of either sign:
   jet = pixels whose distance from the border's median exceeds the Otsu threshold, cleaned, the large
   connected parts of it; background = the rest, kept 5 % of the image away from the jet (Q9).
   Allocates scratch.  Errors: PTIE_ENUMERIC (not finite, constant, or without room for one of the
   regions), PTIE_ENOMEM. */
PTIE_API PTIE_NODISCARD ptie_status ptie_regions_propose(uint8_t *labels, const float *map,
                                                         int32_t width_px, int32_t height_px);

typedef struct ptie_flow_metrics {
    double mgm; /* mean gradient magnitude in the jet, per pixel (Eq. 13, Q4) */
    double sbr; /* mean jet / mean background (Q5); unbounded as the background goes to 0 */
    double bns; /* standard deviation in the background (Q6) */
    double cnr; /* |mean jet - mean background| / sqrt(var jet + var background) (Q7): cannot be gamed */
    double mean_jet, mean_background;
} ptie_flow_metrics;

/* Metrics of one map in the map's own unit.  Errors: PTIE_EINVAL (a region has no pixel),
   PTIE_ENUMERIC. */
PTIE_API PTIE_NODISCARD ptie_status ptie_flow_measure(ptie_flow_metrics *out, const float *map,
                                                      const uint8_t *labels, int32_t width_px,
                                                      int32_t height_px);

#endif
