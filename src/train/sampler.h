/* SPDX-License-Identifier: BSD-3-Clause */
/* Draws samples of a preset: flow, optics, noise, inversion, normalisation.  A const plan. */
#ifndef PTIE_TRAIN_SAMPLER_H
#define PTIE_TRAIN_SAMPLER_H

#include "train/preset.h"

typedef struct ptie_sampler ptie_sampler;

/* Keeps a pointer to the preset. */
ptie_status ptie_sampler_create(ptie_sampler **out, const ptie_preset *preset);
void ptie_sampler_free(ptie_sampler *sampler);            /* NULL is fine */
size_t ptie_sampler_scratch(const ptie_sampler *sampler); /* bytes */

/* clean, noisy (out): height x width in [0, 1], 64-byte aligned or not.  A pure function of
   (preset, seed, index).  Only the flow allocates.  `info` may be NULL. */
ptie_status ptie_sampler_draw(const ptie_sampler *sampler, uint64_t seed, uint64_t index,
                              float *clean, float *noisy, ptie_sample_info *info, void *scratch);

#endif
