/* SPDX-License-Identifier: BSD-3-Clause */
/* The result file of a run (docs/formats.md): phase, denoised phase, metrics, provenance. */
#ifndef PTIE_RUN_OUTPUT_H
#define PTIE_RUN_OUTPUT_H

#include "base/file.h"
#include "io/nexus.h"
#include "run/measure.h"

#define PTIE_RUN_PHASE PTIE_NEXUS_DATA "/phase"
#define PTIE_RUN_DENOISED PTIE_NEXUS_DATA "/denoised"

/* Creates the file with its groups, axes and empty maps, and writes down how it was made. */
ptie_status ptie_output_create(ptie_h5 **out, const ptie_run_params *params, const ptie_nexus_axes *axes);
/* Metrics of all frames under /entry/metrics/<map>; values: (frames, PTIE_RUN_METRICS). */
ptie_status ptie_output_metrics(ptie_h5 *h5, const char *map, const double *values, int64_t frames);
/* Region labels under /entry/metrics/regions. */
ptie_status ptie_output_regions(ptie_h5 *h5, const uint8_t *labels, int32_t width_px, int32_t height_px);
/* One row per frame, with the frame's number in the recording.  denoised may be NULL. */
ptie_status ptie_output_csv(ptie_output_file *csv, const ptie_run_params *params, const double *phase,
                            const double *denoised, int64_t frames);

#endif
