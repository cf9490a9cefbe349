/* SPDX-License-Identifier: BSD-3-Clause */
/* A plane on another plane's grid (P6); contracts as in <ptie/preprocess.h>. */
#ifndef PTIE_PREP_RESAMPLE_H
#define PTIE_PREP_RESAMPLE_H

#include <ptie/preprocess.h>

#include "base/status.h"

ptie_status ptie_prep_resampler(ptie_resampler **out, int32_t width, int32_t height,
                                ptie_similarity where);
size_t ptie_prep_resampler_scratch(const ptie_resampler *resampler);
void ptie_prep_resample(const ptie_resampler *resampler, float *out, const float *plane,
                        void *scratch);

#endif
