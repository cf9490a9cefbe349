/* SPDX-License-Identifier: BSD-3-Clause */
/* The metrics of a result go with its maps into another file. */
#ifndef PTIE_RUN_COLUMNS_H
#define PTIE_RUN_COLUMNS_H

#include "io/recording.h"

/* Copies every data set [T] under /entry/metrics of the HDF5 file `input` ("result.h5" or "result.h5:/data/set"), one value
   for each of the frames that are taken; info is the input's.  Nothing where there are none, or the output has no place
   for them. */
ptie_status ptie_copy_columns(ptie_writer *output, const char *input, const ptie_recording_info *info,
                              ptie_frame_range frames, int64_t count);

#endif
