/* SPDX-License-Identifier: BSD-3-Clause */
/* Recordings inside the library; contracts as in <ptie/recording.h>, arguments already checked. */
#ifndef PTIE_IO_RECORDING_H
#define PTIE_IO_RECORDING_H

#include <ptie/recording.h>

#include "io/writer.h"

ptie_status ptie_io_open(ptie_recording **out, const char *path);
void ptie_io_close(ptie_recording *recording); /* NULL is fine */
const ptie_recording_info *ptie_io_info(const ptie_recording *recording);
ptie_status ptie_io_read(ptie_recording *recording, int64_t frame, float *data);

ptie_status ptie_io_describe(ptie_recording_info *info, const char *path);

/* How many frames of `recorded` a range takes.  PTIE_EINVAL, naming `path`, when it reaches behind them. */
ptie_status ptie_io_choose(int64_t *count, ptie_frame_range range, int64_t recorded, const char *path);

/* Is `path` a file that holds several data sets, none of which it names ("jet.h5")? */
bool ptie_io_has_data_sets(const char *path);

/* Is `path` of a kind, such as video, that wants the range of all values before the first frame? */
bool ptie_io_needs_range(const char *path);
/* ptie_writer_create with all a writer can be told.  path and name are copied, other strings are not. */
ptie_status ptie_io_create(ptie_writer **out, const ptie_writer_job *job);
/* Numbers that go with the frames, before the first of them: can it take any?  Then those of `path`. */
bool ptie_io_has_columns(const ptie_writer *writer);
ptie_status ptie_io_add_column(ptie_writer *writer, const char *path, const double *values, int64_t count);
ptie_status ptie_io_append(ptie_writer *writer, const float *frame);
ptie_status ptie_io_complete(ptie_writer *writer); /* ptie_writer_close */
void ptie_io_discard(ptie_writer *writer);         /* NULL is fine */

#endif
