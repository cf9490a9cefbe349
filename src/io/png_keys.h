/* SPDX-License-Identifier: BSD-3-Clause */
/* Text chunks that carry what 16 bits cannot: value = offset + scale * sample. */
#ifndef PTIE_IO_PNG_KEYS_H
#define PTIE_IO_PNG_KEYS_H

#define PTIE_PNG_OFFSET "ptie:offset"
#define PTIE_PNG_SCALE "ptie:scale"
#define PTIE_PNG_UNIT "ptie:unit"
#define PTIE_PNG_NAME "ptie:name"
#define PTIE_PNG_RATE "ptie:frame_rate_hz"
#define PTIE_PNG_PIXEL "ptie:pixel_m"

#endif
