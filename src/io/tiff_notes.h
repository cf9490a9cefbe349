/* SPDX-License-Identifier: BSD-3-Clause */
/* What the first page's description says of a stack: ImageJ's lines or OME's XML. */
#ifndef PTIE_IO_TIFF_NOTES_H
#define PTIE_IO_TIFF_NOTES_H

#include <ptie/recording.h>

/* Takes pixel, frame rate, unit and the like into `info`, as far as they are there.  per_unit:
   pixels per unit of ImageJ's scale (XResolution; 0 if unknown).  Returns how many images ImageJ
   announces, 0 if none: it writes a stack above 4 GiB behind a single directory. */
int64_t ptie_tiff_notes(ptie_recording_info *info, const char *description, double per_unit);

#endif
