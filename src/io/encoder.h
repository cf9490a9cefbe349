/* SPDX-License-Identifier: BSD-3-Clause */
/* The program ffmpeg as an encoder: it reads Y4M from us and writes MP4.  Started without a shell; what it complains
 * about becomes our message.
 */
#ifndef PTIE_IO_ENCODER_H
#define PTIE_IO_ENCODER_H

#include "base/status.h"

typedef struct ptie_encoder ptie_encoder;

/* Starts ffmpeg, which writes to `part`; `path` is for messages and outlives the encoder.  PTIE_EUNSUPPORTED when there is
   no such program, PTIE_EIO, PTIE_ENOMEM. */
ptie_status ptie_encoder_start(ptie_encoder **out, const char *path, const char *part);
/* PTIE_EIO with ffmpeg's own words when it has given up. */
ptie_status ptie_encoder_write(ptie_encoder *encoder, const void *bytes, size_t count);
/* Waits until the file is complete; frees in any case. */
ptie_status ptie_encoder_finish(ptie_encoder *encoder);
/* Ends ffmpeg at once; frees.  NULL is fine. */
void ptie_encoder_stop(ptie_encoder *encoder);

#endif
