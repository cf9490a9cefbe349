/* SPDX-License-Identifier: BSD-3-Clause */
/* The numbers of a run: metrics of every frame, and their mean and deviation over frames. */
#ifndef PTIE_RUN_MEASURE_H
#define PTIE_RUN_MEASURE_H

#include <ptie/run.h>

#include "base/status.h"

enum { PTIE_MGM, PTIE_SBR, PTIE_BNS, PTIE_CNR, PTIE_RMSE_RAD, PTIE_CORRELATION,
       PTIE_SIGNAL_KEPT, PTIE_RESIDUAL, PTIE_RUN_METRICS };

/* "mgm", "sbr", "bns", "cnr", "rmse_rad", "correlation", "signal_kept", "residual". */
const char *ptie_run_metric_name(int which);

/* One map against its regions and against the truth, as far as `labels` and `truth` are not NULL; the rest is
   NaN.  Both maps' means are taken out before they are compared: a TIE phase has none.
   value: PTIE_RUN_METRICS numbers, of which the residual, which needs the planes, is left alone. */
ptie_status ptie_run_measure(double *value, const float *map, const float *truth, const uint8_t *labels,
                             int32_t width_px, int32_t height_px);

/* Mean and standard deviation over `frames` rows of PTIE_RUN_METRICS values. */
ptie_run_row ptie_run_summarise(const double *values, int64_t frames);

#endif
