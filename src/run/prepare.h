/* SPDX-License-Identifier: BSD-3-Clause */
/* From sensor images to the planes the solver takes.  A plan is made once and then only read: many threads run it,
   each with its scratch. */
#ifndef PTIE_RUN_PREPARE_H
#define PTIE_RUN_PREPARE_H

#include "run/source.h"

typedef struct ptie_prepare ptie_prepare;

typedef struct ptie_prepare_shape {
    int32_t width_px, height_px, planes; /* of what ptie_prepare_run gives */
    double pixel_m;
    double z_m[PTIE_ROLES]; /* of the planes: the solver's order */
} ptie_prepare_shape;

/* Reads what the rig names: dark, reference, mask. */
ptie_status ptie_prepare_create(ptie_prepare **out, const ptie_source *source, const ptie_rig *rig);
void ptie_prepare_free(ptie_prepare *prepare); /* NULL is fine */
ptie_prepare_shape ptie_prepare_get_shape(const ptie_prepare *prepare);
size_t ptie_prepare_scratch_bytes(const ptie_prepare *prepare);

/* images: as ptie_source_read gives them.  planes (out): shape.planes maps of (height, width). */
ptie_status ptie_prepare_run(const ptie_prepare *prepare, const float *const *images, float *const *planes,
                             void *scratch);

/* Averages binning x binning pixels; what does not fill a bin at the right and the bottom is left out. */
void ptie_bin(float *out, const float *image, int32_t width, int32_t height, int32_t binning);

#endif
