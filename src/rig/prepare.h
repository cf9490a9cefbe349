/* SPDX-License-Identifier: BSD-3-Clause */
/* From sensor images to the planes the solver takes, docs/math.md (P1)-(P9).  A plan is made once
   and then only read: many threads run it, each with its scratch. */
#ifndef PTIE_RIG_PREPARE_H
#define PTIE_RIG_PREPARE_H

#include <ptie/prepare.h>

#include "rig/source.h"

typedef struct ptie_prepare ptie_prepare;

typedef struct ptie_prepare_shape {
    int32_t width_px, height_px; /* of a map */
    int32_t planes;              /* maps per frame; before planes are mixed: images or channels */
    double pixel_m;
    const char *name[PTIE_ROLES]; /* "plus"; before planes are mixed "image", "left", "45" */
} ptie_prepare_shape;

/* Plans every step up to `last`.  Reads what the rig names (dark, reference, mask), and some frames
   where it asks for a mask and has no reference. */
ptie_status ptie_prepare_until(ptie_prepare **out, ptie_source *source, const ptie_rig *rig,
                               ptie_step last);
/* All steps: planes in the order of ptie_rig_planes. */
ptie_status ptie_prepare_create(ptie_prepare **out, ptie_source *source, const ptie_rig *rig);
void ptie_prepare_free(ptie_prepare *prepare); /* NULL is fine */
ptie_prepare_shape ptie_prepare_get_shape(const ptie_prepare *prepare);
size_t ptie_prepare_scratch_bytes(const ptie_prepare *prepare);

/* What is light (1) and what is opaque (0) in the planes; NULL: all is light. */
const uint8_t *ptie_prepare_mask(const ptie_prepare *prepare);
/* Where every plane was seen (1), and where one of them was continued as its mirror image because
   it lies elsewhere on the sensor (0); NULL: everywhere seen. */
const uint8_t *ptie_prepare_seen(const ptie_prepare *prepare);

/* images: as ptie_source_read gives them.  planes (out): shape.planes maps of (height, width).
   scratch: 64-byte aligned. PTIE_ENUMERIC for a plane without light when means are matched. */
ptie_status ptie_prepare_run(const ptie_prepare *prepare, const float *const *images,
                             float *const *planes, void *scratch);

/* Averages binning x binning pixels; what does not fill a bin at the right and the bottom is left
 * out. */
void ptie_bin(float *out, const float *image, int32_t width, int32_t height, int32_t binning);

#endif
