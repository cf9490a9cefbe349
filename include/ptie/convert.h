/* SPDX-License-Identifier: BSD-3-Clause */
/* A recording of one kind becomes a recording of another: frames and a rectangle of it, as another file.
 */
#ifndef PTIE_CONVERT_H
#define PTIE_CONVERT_H

#include <ptie/context.h>
#include <ptie/figure.h>
#include <ptie/metrics.h>
#include <ptie/recording.h>

typedef struct ptie_convert_params {
    uint32_t struct_size;       /* set by ptie_convert_params_init */
    const char *input;          /* any recording ptie_recording_open reads; required */
    const char *output;         /* any kind ptie_writer_create writes; required */
    const char *name;           /* what the map is called in the output; NULL: as in the input, else "data" */
    ptie_frame_range frames;    /* frames to take; default 0, 0, 1 */
    ptie_rect roi;              /* pixels to take; all 0 = the whole frame */
    double low, high;           /* images and video: values of black and white.  Equal (default): images keep integers and
                                   use each frame's own extent for other values; video uses that of all frames */
    ptie_colormap colours;      /* of video, default PTIE_GRAY; PTIE_DIVERGING puts 0 in the middle */
    double played_hz;           /* of video: frames per second when shown, 0.001 .. 1000, default 25 */
    bool compress;              /* HDF5: shuffled and deflated; default false */
    bool overwrite;
    const char *provenance;     /* command line to keep in the file, or NULL */
} ptie_convert_params;

PTIE_API void ptie_convert_params_init(ptie_convert_params *params);

/* Copies in constant memory.  Values do not change, and are stored as in the input: unsigned integers of up to 16
   bits as 8- or 16-bit integers, everything else as float32.  Unit, pixel size, frame rate and frame numbers are kept
   where the output can hold them, and so are the metrics of a result of ptie_run in HDF5 and MAT; a step divides the
   frame rate.  The output appears whole or not at all, and does not
   depend on the number of threads.  Without a range, video reads the recording twice.
   Errors: PTIE_EINVAL (frames, rectangle, output over input) and those of ptie_recording_open, ptie_recording_read,
   ptie_writer_create and ptie_writer_append; PTIE_ECANCELLED. */
PTIE_API PTIE_NODISCARD ptie_status ptie_convert(ptie_ctx *ctx, const ptie_convert_params *params,
                                                 ptie_progress progress);

#endif
