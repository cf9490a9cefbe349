/* SPDX-License-Identifier: BSD-3-Clause */
/* The CIHX header that belongs to an MRAW file: XML in a binary envelope, as Photron's programs
 * write it. */
#ifndef PTIE_IO_CIHX_H
#define PTIE_IO_CIHX_H

#include <stdio.h>

#include <ptie/recording.h>

#include "base/status.h"

/* Writes the header of info->frames frames of `color_bit` (12: packed, 16) bits per sample, of
   which info->bit_depth are in use.  Errors of writing stay with the stream.  PTIE_ENOMEM. */
ptie_status ptie_cihx_write(FILE *out, const ptie_recording_info *info, int color_bit);

#endif
