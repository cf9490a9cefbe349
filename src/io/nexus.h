/* SPDX-License-Identifier: BSD-3-Clause */
/* Maps over time as NeXus lays them out in HDF5 (NXdata): silx, h5web and NeXpy plot them without a
 * click.
 *
 *   /            @default = "entry"
 *   /entry       @NX_class = "NXentry" @default = "data"
 *   /entry/data  @NX_class = "NXdata" @signal = the first map @auxiliary_signals = the others
 *                @axes = ["time", "y", "x"]
 *     NAME       [T, H, W], @units @long_name @interpretation = "image"
 *     time y x   [T] [H] [W] float64, @units; time has @first_frame and @frame_step, too
 */
#ifndef PTIE_IO_NEXUS_H
#define PTIE_IO_NEXUS_H

#include "io/h5.h"

#define PTIE_NEXUS_DATA "/entry/data"
/* Attributes of the time axis: which frames of the recording they come from. */
#define PTIE_NEXUS_FIRST_FRAME "first_frame"
#define PTIE_NEXUS_FRAME_STEP "frame_step"

typedef struct ptie_nexus_axes {
    uint64_t frames; /* 0: not known yet, grows */
    int32_t width_px, height_px;
    int64_t first_frame, frame_step; /* of the recording they come from; step 0 means 1 */
    double frame_rate_hz;            /* > 0: time in s, else the frame's number */
    double pixel_m;                  /* > 0: y and x in m, else in px */
    bool in_place;                   /* each signal in one piece (io/place.h); frames > 0 */
} ptie_nexus_axes;

typedef struct ptie_nexus_signal {
    const char *name, *long_name; /* "phase", "Phase of the gas flow" (NULL: the name) */
    const char *unit;             /* "rad"; "" for none */
    ptie_h5_type type;            /* as stored; PTIE_H5_F32 unless said */
    bool packed;                  /* compressed: ptie_h5_dataset_packed */
} ptie_nexus_signal;

/* Makes the groups, the axes and `count` >= 1 empty signals, one frame to a chunk unless they are in place.  Frames are then
   written with ptie_h5_write(h5, PTIE_NEXUS_DATA "/NAME", PTIE_H5_F32, t, n, ...). */
ptie_status ptie_nexus_begin(ptie_h5 *h5, const ptie_nexus_axes *axes,
                             const ptie_nexus_signal *signals, size_t count);
/* Completes the time axis when axes->frames, now known, was 0 at the beginning. */
ptie_status ptie_nexus_end(ptie_h5 *h5, const ptie_nexus_axes *axes);

/* Writes down how the file came about: /entry/process_1 (NXprocess) with program, version, and what is not NULL of
   the recording it was made from and the command line.  More may be added to the group. */
#define PTIE_NEXUS_PROCESS "/entry/process_1"
ptie_status ptie_nexus_process(ptie_h5 *h5, const char *recording, const char *command);

#endif
