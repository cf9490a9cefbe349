/* SPDX-License-Identifier: BSD-3-Clause */
/* Mosaics of polarisers, by their makers' names or by their angles. */
#ifndef PTIE_OPTICS_MOSAIC_H
#define PTIE_OPTICS_MOSAIC_H

#include "base/ini.h"

/* int32_t[4]: "sony", "crysta", or four different angles of the sensor's top left cell, row by row.  All zero is not
   set. */
extern const ptie_ini_type ptie_mosaic_type;

#endif
