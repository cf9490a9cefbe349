/* SPDX-License-Identifier: BSD-3-Clause */
/* A synthetic recording of a moving flow, with its truth.  Paper sections 2.1 and 2.2. */
#ifndef PTIE_SIMULATE_H
#define PTIE_SIMULATE_H

#include <ptie/camera.h>
#include <ptie/flow.h>
#include <ptie/optics.h>

typedef struct ptie_simulate_params {
    uint32_t struct_size;  /* set by ptie_simulate_params_init */
    ptie_flow_params flow; /* what moves, frame size, pixel, wavelength; time_s is that of frame 0 */
    int64_t frames;        /* >= 1, default 20 */
    double frame_rate_hz;  /* > 0, default 25e3 */
    /* Parametric flows: phase of the value 1, 0 = 1 rad.  Physical flows: largest magnitude of the phase in
       frame 0, 0 = what the model says. */
    double amplitude_rad;
    double defocus_m; /* planes at +defocus and -defocus, > 0, default 10e-3 */
    ptie_boundary boundary;
    ptie_propagation propagation;
    double noise;           /* standard deviation relative to the mean intensity, >= 0, default 0.05; no camera */
    const char *output;     /* required; HDF5, with a mosaic camera any format that is written */
    const char *rig;        /* rig file that fits the recording, or NULL */
    const char *provenance; /* command line to keep in the file, or NULL */
    bool overwrite;
    const ptie_camera_params *camera;      /* NULL: none */
    int32_t reference_frames, dark_frames, target_frames; /* with a camera; 0: no such recording; default 32 */
} ptie_simulate_params;

PTIE_API void ptie_simulate_params_init(ptie_simulate_params *params);

/* Renders the flow at every frame's time, sends it through the optics, adds camera noise, and writes
     /entry/data/plus, /entry/data/minus  [T, H, W] float32, intensity relative to its mean
     /entry/truth/phase                   [T, H, W] float32, rad
   and the rig, each whole or not at all.

   With a camera the output holds its counts: one image per frame from a mosaic, else the data sets plus and minus.
   Beside NAME.xyz, in the same format, NAME_reference.xyz (no flow), NAME_dark.xyz (no light) and
   NAME_target.xyz (dots at the object, for `ptie rig calibrate`); NAME_truth.h5
   with the phase, averaged over the mosaic's cells; and beside the rig, which says what a lab knows, RIG_true.ini with
   what a perfect calibration would find.  The frame size is that of the sensor.

   The bytes do not depend on the number of threads.
   Errors: PTIE_EINVAL, PTIE_ENAME (morphology), PTIE_EEXIST, PTIE_EIO, PTIE_ENOMEM, PTIE_ECANCELLED. */
PTIE_API PTIE_NODISCARD ptie_status ptie_simulate(ptie_ctx *ctx, const ptie_simulate_params *params,
                                                  ptie_progress progress);

#endif
