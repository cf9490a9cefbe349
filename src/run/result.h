/* SPDX-License-Identifier: BSD-3-Clause */
/* The result file of a run (docs/formats.md).
 *
 * Its structure is complete before the first frame: every data set has its final size and its place in the file.
 * From then on only rows are written in place (io/place.h), so the file is a valid one at any moment, whatever
 * ends the program; the number of finished frames is written last.  What an interrupted run leaves is the
 * ".part" that ptie_result_open takes up again.
 */
#ifndef PTIE_RUN_RESULT_H
#define PTIE_RUN_RESULT_H

#include "io/nexus.h"
#include "run/measure.h"

typedef struct ptie_result ptie_result;

/* Data sets beside the maps and the numbers of the frames. */
typedef enum ptie_result_field {
    PTIE_RESULT_REGIONS,       /* (H, W) u8 */
    PTIE_RESULT_TRUSTED,       /* (H, W) u8 */
    PTIE_RESULT_PHASE_MEAN,    /* (H, W) f32: over time */
    PTIE_RESULT_PHASE_RMS,     /* (H, W) f32: about that mean */
    PTIE_RESULT_DENOISED_MEAN, /* with a model only */
    PTIE_RESULT_DENOISED_RMS,
    PTIE_RESULT_WARNINGS,      /* PTIE_RUN_MOST_WARNINGS lines */
    PTIE_RESULT_FINISHED,      /* one u64 */
    PTIE_RESULT_FIELDS
} ptie_result_field;

/* Makes the file, or, with params->resume, takes up what an interrupted run with the same settings left.
   settings: lines that say everything the numbers depend on.  Errors: PTIE_EEXIST (the output, or an
   interrupted run's that was not asked for), PTIE_EINVAL (other settings), those of files. */
ptie_status ptie_result_open(ptie_result **out, const ptie_run_params *params, const ptie_nexus_axes *axes,
                             const char *settings);

/* Frames finished; after opening: by the interrupted run. */
int64_t ptie_result_finished(const ptie_result *result);
/* The first `frames` are finished from now on. */
ptie_status ptie_result_finish(ptie_result *result, int64_t frames);

/* Maps of a frame; denoised is left alone without a model. */
ptie_status ptie_result_write_maps(const ptie_result *result, int64_t frame, const float *phase,
                                   const float *denoised);
ptie_status ptie_result_read_maps(const ptie_result *result, int64_t frame, float *phase, float *denoised);
/* Numbers of a frame, PTIE_ROW of them; those it does not have are NaN when read. */
ptie_status ptie_result_write_row(const ptie_result *result, int64_t frame, const double *row);
ptie_status ptie_result_read_row(const ptie_result *result, int64_t frame, double *row);
/* A whole data set. */
ptie_status ptie_result_write(const ptie_result *result, ptie_result_field field, const void *data);
ptie_status ptie_result_read(const ptie_result *result, ptie_result_field field, void *data);

/* Renames the file: it is the result.  Frees in any case. */
ptie_status ptie_result_complete(ptie_result *result);
/* Frees; keeps what is finished for another run, and leaves nothing if nothing is.  NULL is fine. */
void ptie_result_abandon(ptie_result *result);

#endif
