/* SPDX-License-Identifier: BSD-3-Clause */
/* Preprocessing inside the library; contracts as in <ptie/preprocess.h>, arguments already checked.
 * What cannot fail is called by its public name. */
#ifndef PTIE_PREP_PREP_H
#define PTIE_PREP_PREP_H

#include <ptie/preprocess.h>

#include "base/status.h"

ptie_status ptie_prep_flat_gain(float *gain, const float *reference, const uint8_t *mask,
                                int32_t width, int32_t height, double floor);

ptie_status ptie_prep_splitter(ptie_splitter **out, const ptie_splitter_params *params);
size_t ptie_prep_splitter_scratch(const ptie_splitter *splitter);
void ptie_prep_split(const ptie_splitter *splitter, float *const *channel, const float *image,
                     void *scratch);

ptie_status ptie_prep_register(ptie_registration *out, const float *fixed, const float *moving,
                               const uint8_t *mask, int32_t width, int32_t height);

ptie_status ptie_prep_opaque_mask(uint8_t *mask, const float *reference, int32_t width,
                                  int32_t height, double below, int32_t clean, int32_t margin);

void ptie_prep_pin(float *map, int32_t width, int32_t height, ptie_rect region);

#endif
