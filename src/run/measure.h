/* SPDX-License-Identifier: BSD-3-Clause */
/* The numbers of a run: one row per frame. */
#ifndef PTIE_RUN_MEASURE_H
#define PTIE_RUN_MEASURE_H

#include <ptie/run.h>

#include "base/status.h"

/* Maps that are measured, and what is measured of each. */
enum { PTIE_OF_PHASE, PTIE_OF_DENOISED, PTIE_OF_TRUTH, PTIE_RUN_MAPS };
enum { PTIE_MGM, PTIE_SBR, PTIE_BNS, PTIE_CNR, PTIE_RMSE_RAD, PTIE_CORRELATION,
       PTIE_SIGNAL_KEPT, PTIE_RESIDUAL, PTIE_RUN_METRICS };
/* What is measured of the frame itself: noise that the planes' noise causes in the phase, share of pixels at
   the end of the sensor's range, largest difference of a plane's mean from that of all, their mean beside the
   first frame's, and the phase's mean in the background. */
enum { PTIE_NOISE_RAD, PTIE_SATURATED, PTIE_IMBALANCE, PTIE_BRIGHTNESS, PTIE_BACKGROUND_RAD, PTIE_FRAME_NUMBERS };

/* All of them in a row: maps first, then the frame. */
enum { PTIE_ROW_OF_FRAME = PTIE_RUN_MAPS * PTIE_RUN_METRICS, PTIE_ROW = PTIE_ROW_OF_FRAME + PTIE_FRAME_NUMBERS };

/* Number `which` of a row: "phase", "denoised", "truth" or "frame", and "mgm", "sbr", ..., "noise_rad", ... */
typedef struct ptie_row_name {
    const char *group, *name;
} ptie_row_name;
ptie_row_name ptie_run_row_name(int which);

/* Does a run measure this number?  That of maps it does not have, and of a truth it was not given, are not. */
bool ptie_run_row_has(int which, bool denoised, bool truth);

/* One map against its regions and against the truth, as far as `labels` and `truth` are not NULL; the rest is
   NaN.  Both maps' means are taken out before they are compared: a TIE phase has none.
   value: PTIE_RUN_METRICS numbers, of which the residual, which needs the planes, is left alone.
   background_rad (out, or NULL): the map's mean there. */
ptie_status ptie_run_measure(double *value, double *background_rad, const float *map, const float *truth,
                             const uint8_t *labels, int32_t width_px, int32_t height_px);

/* Relative white noise of two planes (both with that much), from the second differences of their difference
   (Immerkaer 1996), which neither smooth flow nor what both planes see passes. */
typedef struct ptie_lit_plane {
    const float *plane;
    double mean;
} ptie_lit_plane;
double ptie_run_plane_noise(ptie_lit_plane a, ptie_lit_plane b, int32_t width_px, int32_t height_px);

/* Mean of a plane; share of `count` samples that are at least `limit`. */
double ptie_run_mean(const float *plane, size_t count);
double ptie_run_share_above(const float *image, size_t count, double limit);

/* Mean and deviation over the frames that have the number, taken in as they come (Welford). */
typedef struct ptie_running {
    int64_t count;
    double mean, squares, largest;
} ptie_running;

void ptie_running_add(ptie_running *running, double value); /* NaN and infinity are left out */
ptie_stat ptie_running_stat(const ptie_running *running);

#endif
