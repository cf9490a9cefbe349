/* SPDX-License-Identifier: BSD-3-Clause */
/* What a camera says of itself, kept in HDF5: attributes of /entry/instrument/detector (NXdetector), named as the fields of
 * ptie_recording_info.  A converted recording keeps them, and with them the phase of a mosaic.
 */
#ifndef PTIE_IO_DETECTOR_H
#define PTIE_IO_DETECTOR_H

#include <ptie/recording.h>

#include "io/h5.h"

/* Writes what is known; no group when nothing is. */
ptie_status ptie_detector_write(ptie_h5 *h5, const ptie_recording_info *info);
/* Takes over what is there and in range. */
void ptie_detector_read(ptie_h5 *h5, ptie_recording_info *info);

#endif
