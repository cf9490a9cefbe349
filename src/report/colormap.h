/* SPDX-License-Identifier: BSD-3-Clause */
/* Colours of values. */
#ifndef PTIE_REPORT_COLORMAP_H
#define PTIE_REPORT_COLORMAP_H

#include <ptie/figure.h>

/* Colour of a pixel without a value: in no colour map. */
#define PTIE_NAN_COLOUR 0xd33682u

/* 0xRRGGBB of `position` in 0..1; outside is clamped, NaN is PTIE_NAN_COLOUR. */
uint32_t ptie_colour(ptie_colormap map, double position);

/* 0xRRGGBB of a curve: eight colours that colour-blind readers tell apart (Okabe and Ito, 2008). */
uint32_t ptie_curve_colour(int32_t index);

#endif
