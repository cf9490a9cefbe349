/* SPDX-License-Identifier: BSD-3-Clause */
/* Frames and scratch, one of each per thread. */
#ifndef PTIE_BENCH_FRAMES_H
#define PTIE_BENCH_FRAMES_H

#include "bench/bench.h"

typedef struct ptie_frames {
    size_t pixels, scratch_bytes; /* of one frame, of one thread */
    float *a, *b, *c;             /* (threads, H, W), uniform in [0.5, 1] */
    unsigned char *scratch;
} ptie_frames;

/* Fine with ptie_frames_free on failure. */
ptie_status ptie_frames_create(ptie_frames *frames, const ptie_bench *bench, int32_t side);
ptie_status ptie_frames_add_scratch(ptie_frames *frames, const ptie_bench *bench, size_t bytes);
void ptie_frames_free(ptie_frames *frames);

/* A thread's part. */
static inline float *ptie_frame(const ptie_frames *frames, float *block, int32_t worker) {
    return block + (size_t)worker * frames->pixels;
}
static inline void *ptie_frame_scratch(const ptie_frames *frames, int32_t worker) {
    return frames->scratch + (size_t)worker * frames->scratch_bytes;
}

#endif
