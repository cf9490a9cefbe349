/* SPDX-License-Identifier: BSD-3-Clause */
/* The channels of a sensor image, by the names people write, and planes as sums of them. */
#ifndef PTIE_RIG_CHANNELS_H
#define PTIE_RIG_CHANNELS_H

#include <ptie/rig.h>

#include "base/ini.h"

/* Channels of the rig's layout: 0, 2 or 4. */
int32_t ptie_channel_count(ptie_layout layout);

enum { PTIE_CHANNEL_BYTES = 12 };
/* "left", "tr"; a mosaic's are angles, "45". */
void ptie_channel_name(char name[PTIE_CHANNEL_BYTES], const ptie_rig *rig, int32_t channel);

/* "90" or "0.98*0 + 0.02*45".  Returns NULL, or what was expected, in `expected` or static. */
const char *ptie_mix_parse(double mix[PTIE_CHANNELS], const ptie_rig *rig, const char *text,
                           char expected[128]);
void ptie_mix_print(ptie_text *out, const ptie_rig *rig, const double mix[PTIE_CHANNELS]);

#endif
