/* SPDX-License-Identifier: BSD-3-Clause */
/* What a denoiser is inside. */
#ifndef PTIE_NN_DENOISER_H
#define PTIE_NN_DENOISER_H

#include "nn/model.h"

struct ptie_denoiser {
    const ptie_kernels *kernels;
    ptie_graph graph;
    ptie_output output;
    int32_t width, height; /* of a frame; maps are larger where these are not multiples */
    int32_t joined_by[PTIE_MAX_LAYERS]; /* the layer that joins this one as its skip, or -1 */
    ptie_layout inputs, outputs;
    float *packed[PTIE_MAX_LAYERS], *bias[PTIE_MAX_LAYERS];
    float *head; /* weights, then the bias */
    void *block;
};

typedef struct ptie_denoise_scratch {
    float *inputs, *outputs;
    float *image; /* one frame, for the way from and to rad */
    size_t bytes;
} ptie_denoise_scratch;

/* The caller's scratch as slices; NULL only counts. */
ptie_denoise_scratch ptie_denoise_slice(const ptie_denoiser *denoiser, void *scratch);

#endif
