/* SPDX-License-Identifier: BSD-3-Clause */
/* The rig (how the set-up is built) and the pipeline: recording -> phase -> denoised phase -> metrics.
 * docs/formats.md has the rig's keys; docs/math.md the equations.
 */
#ifndef PTIE_RUN_H
#define PTIE_RUN_H

#include <ptie/metrics.h>
#include <ptie/model.h>
#include <ptie/recording.h>
#include <ptie/solver.h>

/* Which planes a frame brings. */
typedef enum ptie_planes {
    PTIE_PLANES_PAIR = 0,     /* I+ and I- */
    PTIE_PLANES_TRIPLE = 1,   /* I+, I0 and I-, steps may differ */
    PTIE_PLANES_REFERENCE = 2 /* one defocused plane, and a no-flow reference of the same plane */
} ptie_planes;

typedef struct ptie_rig {
    uint32_t struct_size;    /* set by ptie_rig_init */
    double wavelength_m;     /* default 532e-9 */
    double pixel_m;          /* at the object: sensor pitch / magnification */
    double defocus_plus_m, defocus_minus_m; /* default +10e-3, -10e-3 */
    ptie_planes planes;
    char plus[512], zero[512], minus[512]; /* data sets inside an HDF5 recording ("/entry/data/plus"), or "" */
    char reference[512];     /* no-flow recording, relative to the rig file; its frames are averaged */
    int32_t polarity;        /* sign of the flow's phase: +1, -1 (hot gas), 0 = judge each frame */
    int32_t binning;         /* average n x n pixels before solving, default 1 */
    ptie_boundary boundary;  /* default PTIE_MIRROR */
    double cutoff_m;         /* Tikhonov cut-off period of the solver, 0 = off */
    double frame_rate_hz;    /* 0: as the recording says */
    bool zero_border;        /* pin the mean: median of the frame's border = 0, default true */
} ptie_rig;

PTIE_API void ptie_rig_init(ptie_rig *rig);

/* Reads an INI file.  Errors: PTIE_EIO, PTIE_ENAME (unknown section or key, with the nearest valid one),
   PTIE_EFORMAT (line, value, expected unit), PTIE_EINVAL (missing wavelength, pixel or defocus). */
PTIE_API PTIE_NODISCARD ptie_status ptie_rig_load(ptie_rig *rig, const char *path);

typedef struct ptie_run_params {
    uint32_t struct_size;      /* set by ptie_run_params_init */
    const ptie_rig *rig;
    /* Recordings.  PTIE_PLANES_REFERENCE: `plus` is the flow.  A pair or triple in one HDF5 file: give it
       as `plus` and leave the others NULL (the rig names the data sets). */
    const char *plus, *zero, *minus;
    const char *reference;     /* overrides rig->reference; NULL: as the rig says */
    const ptie_model *model;   /* NULL: reconstruct only */
    const char *truth;         /* recording of the true phase for RMSE and correlation, or NULL */
    const char *output;        /* .h5: phase, denoised, metrics, provenance; required */
    const char *metrics_csv;   /* one row per frame, or NULL */
    const char *provenance;    /* command line to keep in the file, or NULL */
    ptie_rect jet, background; /* regions of the metrics; all 0: proposed from the result */
    int64_t first, count, step;/* frames to take; count 0 = to the end; default 0, 0, 1 */
    bool overwrite;
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

typedef struct ptie_run_summary {
    int64_t frames;
    int32_t width_px, height_px; /* of the phase, after binning */
    double pixel_m;
    ptie_run_row phase, denoised;   /* denoised: all NaN without a model */
    ptie_run_row truth;             /* the true phase by the same measures; all NaN without truth */
    bool has_regions; /* false: none given and none to propose, so MGM, SBR, BNS and CNR are NaN */
    double seconds;
} ptie_run_summary;

/* Runs the pipeline in constant memory (blocks of frames; results do not depend on block or threads) and
   writes `output` (written whole or not at all):
     /entry/data/phase, /entry/data/denoised  [T, H, W] float32, rad
     /entry/metrics/...                       [T]
     /entry/process_1                         program, version, parameters
   A recording without flow has no regions to propose: its maps are kept, and summary->has_regions is false.
   Errors: those of its parts; PTIE_ESIZE (planes, reference or truth of another size or length). */
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
