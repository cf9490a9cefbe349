/* SPDX-License-Identifier: BSD-3-Clause */
/* The pipeline: recording -> phase -> denoised phase -> metrics.  docs/math.md has the equations. */
#ifndef PTIE_RUN_H
#define PTIE_RUN_H

#include <ptie/metrics.h>
#include <ptie/model.h>
#include <ptie/recording.h>
#include <ptie/rig.h>

typedef struct ptie_run_params {
    uint32_t struct_size;      /* set by ptie_run_params_init */
    const ptie_rig *rig;
    const char *recording;     /* all planes of a frame: an HDF5 file whose data sets the rig names, or sensor
                                  images with all planes, or the flow of a rig with one plane */
    const char *plane[PTIE_ROLES]; /* or planes in recordings of their own; NULL: in `recording` */
    const char *reference, *dark, *mask; /* override the rig's; NULL: as the rig says */
    const ptie_model *model;   /* NULL: reconstruct only */
    const char *truth;         /* recording of the true phase for RMSE and correlation, or NULL */
    const char *output;        /* .h5: phase, denoised, metrics, provenance; required */
    const char *metrics_csv;   /* one row per frame, or NULL */
    const char *provenance;    /* command line to keep in the file, or NULL */
    ptie_rect jet, background; /* regions of the metrics; all 0: proposed from the result */
    ptie_frame_range frames;   /* default 0, 0, 1 */
    bool overwrite;
    bool resume;               /* go on from "<output>.part" where it is there; settings must be the same */
    bool fast;                 /* as ptie_denoiser_params, default false */
} ptie_run_params;

PTIE_API void ptie_run_params_init(ptie_run_params *params);

/* Mean and standard deviation over the frames that have a finite value; NaN if none has. */
typedef struct ptie_stat { double mean, std; } ptie_stat;

typedef struct ptie_run_row {    /* one kind of map: the TIE phase, or the denoised phase */
    ptie_stat mgm, sbr, bns, cnr;
    ptie_stat rmse_rad, correlation, signal_kept; /* against truth, both maps with mean 0; NaN without */
    ptie_stat residual; /* of the map sent back to the planes (docs/math.md Q11) */
} ptie_run_row;

enum { PTIE_RUN_MOST_WARNINGS = 16, PTIE_RUN_WARNING_BYTES = 240 };

typedef struct ptie_run_summary {
    int64_t frames;
    int64_t resumed;             /* of them, those that an interrupted run had finished */
    int32_t width_px, height_px; /* of the phase, after binning */
    double pixel_m;
    ptie_run_row phase, denoised;   /* denoised: all NaN without a model */
    ptie_run_row truth;             /* the true phase by the same measures; all NaN without truth */
    ptie_stat noise_rad; /* what the planes' white noise, as measured, makes of the phase (M8) */
    bool has_regions; /* false: none given and none to propose, so MGM, SBR, BNS and CNR are NaN */
    int32_t warnings; /* lines in `warning`: saturation, unequal planes, a drifting background, ... */
    char warning[PTIE_RUN_MOST_WARNINGS][PTIE_RUN_WARNING_BYTES];
    double seconds;
} ptie_run_summary;

/* Runs the pipeline as a stream: frames are read ahead, computed on all threads and written in order, in memory
   that does not grow with the recording; results depend neither on threads nor on interruptions.  docs/formats.md
   says what `output` holds.

   `output` takes its final size at once and is "<output>.part" until it is complete.  Meanwhile it is a valid file
   that others may read, and so it stays whenever the run ends: after a failure, PTIE_ECANCELLED or a kill, the
   finished frames (summary->frames says how many; none: nothing is left) are what `resume` goes on from.
   `metrics_csv` grows row by row in the same way.

   Regions that are not given are proposed from the mean of the first 32 frames.  A recording without flow has none
   to propose: its maps are kept, and summary->has_regions is false.
   Errors: those of its parts; PTIE_ESIZE (planes, reference or truth of another size or length); PTIE_EEXIST (the
   output, or an interrupted run's, and neither overwrite nor resume); PTIE_EINVAL (resume with other settings:
   names the first). */
PTIE_API PTIE_NODISCARD ptie_status ptie_run(ptie_ctx *ctx, const ptie_run_params *params,
                                             ptie_run_summary *summary, ptie_progress progress);

typedef struct ptie_denoise_params {
    uint32_t struct_size;    /* set by ptie_denoise_params_init */
    const ptie_model *model; /* required */
    const char *input;       /* recording of phase, rad; required */
    const char *output;      /* recording to write, of any kind ptie_writer_create knows; required */
    int32_t polarity;        /* as ptie_denoiser_run_rad, default 0 */
    bool overwrite;
    bool fast;               /* as ptie_denoiser_params, default false */
} ptie_denoise_params;

PTIE_API void ptie_denoise_params_init(ptie_denoise_params *params);

/* Denoises every frame of a recording of phase with ptie_denoiser_run_rad, in constant memory, frames in
   parallel; a single frame takes all threads.  The output appears whole or not at all.  Errors: those of ptie_recording_read, ptie_denoiser_create and
   ptie_writer_create; PTIE_ECANCELLED. */
PTIE_API PTIE_NODISCARD ptie_status ptie_denoise(ptie_ctx *ctx, const ptie_denoise_params *params,
                                                 ptie_progress progress);

#endif
