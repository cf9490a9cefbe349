/* SPDX-License-Identifier: BSD-3-Clause */
/* What a denoiser is inside.
 *
 * A frame streams through the network in bands of rows, depth first: asked for rows of its output,
 * a layer asks those before it for the rows it reads and no more.  What lies between two layers is
 * a window of rows that moves down the frame; all windows together stay in a cache, and their size
 * is proportional to the frame's width.  Bands are cut at multiples of PTIE_WINOGRAD_ROWS, so that
 * every row is the sum of the same numbers in the same order wherever a band begins: the result
 * depends neither on bands nor on how many threads share the frame.
 */
#ifndef PTIE_NN_DENOISER_H
#define PTIE_NN_DENOISER_H

#include "kernel/half.h"
#include "nn/model.h"

/* A layer reads window `k`.  Where that is of no use to it, it writes to window
   PTIE_MAX_LAYERS + k instead: the next one upsamples, or the head reads. */
enum { PTIE_MAX_WINDOWS = 2 * PTIE_MAX_LAYERS };

struct ptie_denoiser {
    const ptie_kernels *kernels;
    const ptie_half_kernels *half; /* NULL: maps are of floats, else of halves (N10) */
    ptie_pool *pool;               /* whose threads share a frame, or NULL */
    ptie_graph graph;
    ptie_output output;
    int32_t width, height;              /* of a frame */
    int32_t full_width, full_height;    /* multiples of 2^(levels-1), as the maps are */
    int32_t parts, part_rows;           /* a frame is cut into */
    int32_t outlet[PTIE_MAX_LAYERS];    /* the window a layer writes to, in its last channels */
    int32_t band[PTIE_MAX_LAYERS];      /* most rows of a layer at a time */
    ptie_map windows[PTIE_MAX_WINDOWS]; /* without data */
    bool filtered[PTIE_MAX_LAYERS];     /* by minimal filtering (N9) */
    size_t filter_floats;               /* scratch of the filtering */
    float *packed[PTIE_MAX_LAYERS], *bias[PTIE_MAX_LAYERS];
    float *head; /* weights, then the bias */
    void *block;
};

typedef struct ptie_denoise_scratch {
    float *image; /* one frame, for the way from and to rad */
    double *rows; /* four rows, for the way back to rad */
    unsigned char *parts;
    size_t part_bytes, bytes;
} ptie_denoise_scratch;

/* The caller's scratch as slices; NULL only counts. */
ptie_denoise_scratch ptie_denoise_slice(const ptie_denoiser *denoiser, void *scratch);
/* The network on a frame known to be finite; the image of the scratch may be the input. */
ptie_status ptie_denoise_finite(const ptie_denoiser *denoiser, float *clean, const float *noisy,
                                void *scratch);

/* ptie_map_make of what this denoiser computes with. */
ptie_map ptie_denoiser_map(const ptie_denoiser *denoiser, int32_t channels, int32_t height,
                           int32_t width);
/* Gives the windows their heights: a walk that computes nothing sees how many rows each must hold.
 */
void ptie_stream_plan(ptie_denoiser *denoiser);
size_t ptie_stream_scratch(const ptie_denoiser *denoiser); /* bytes for one part */
/* The rows of one part of the result. */
void ptie_stream_run(const ptie_denoiser *denoiser, float *clean, const float *noisy, int32_t part,
                     void *scratch);

#endif
