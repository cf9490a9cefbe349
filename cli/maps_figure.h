/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef CLI_MAPS_FIGURE_H
#define CLI_MAPS_FIGURE_H

#include <ptie/run.h>

/* One frame of a finished run side by side: intensity, TIE phase, denoised phase, truth, as far as
   there are.  `frame` counts the frames of the run. */
ptie_status draw_maps(const char *path, const ptie_run_params *run, int64_t frame, double pixel_m);

/* Finds out before the run whether it will have that frame.  GO_ON, or the exit code after a
 * message. */
int check_maps_frame(const ptie_run_params *run, int64_t frame);

#endif
