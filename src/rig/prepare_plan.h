/* SPDX-License-Identifier: BSD-3-Clause */
/* The inside of a preparation plan. */
#ifndef PTIE_RIG_PREPARE_PLAN_H
#define PTIE_RIG_PREPARE_PLAN_H

#include <ptie/preprocess.h>

#include "rig/channels.h"
#include "rig/prepare.h"

struct ptie_prepare {
    ptie_prepare_shape shape;
    ptie_rig rig;
    ptie_step last;
    int32_t images; /* of a frame */
    size_t sensor_pixels;
    int32_t channels;      /* 0: images are planes */
    int32_t width, height; /* of a plane before binning */
    size_t pixels;
    int32_t planes, measured; /* of a frame; of those, the ones that each frame brings */
    ptie_role role[PTIE_ROLES];
    char channel_name[PTIE_CHANNELS][PTIE_CHANNEL_BYTES];

    ptie_splitter *splitter;               /* NULL: images are planes */
    float *dark[PTIE_ROLES];               /* per image, or NULL */
    float *flat[PTIE_ROLES];               /* per plane: what it is multiplied by, or NULL */
    float *reference;                      /* the plane that no frame brings, or NULL */
    ptie_resampler *resampler[PTIE_ROLES]; /* per plane; NULL: it lies on the grid */
    uint8_t *light, *seen;                 /* (height, width), or NULL */
    uint8_t *binned_light, *binned_seen;   /* (shape.height, shape.width), or NULL */
};

/* The planes of images after a step, their means not matched.  planes (out): p->measured of
   them. */
ptie_status ptie_prepare_raw(const ptie_prepare *prepare, const float *const *images,
                             float *const *planes, ptie_step last, void *scratch);

#endif
