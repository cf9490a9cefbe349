/* SPDX-License-Identifier: BSD-3-Clause */
#include "bench/frames.h"

#include "base/memory.h"
#include "base/random.h"

static const char where[] = "bench: frames";

static ptie_status make_block(float **block, size_t count, uint64_t seed) {
    ptie_random random;
    PTIE_TRY(ptie_alloc_status(block, count, sizeof **block, where));
    ptie_random_init(&random, seed, PTIE_STREAM_WEIGHTS, 0);
    for (size_t i = 0; i < count; i++) (*block)[i] = (float)ptie_random_uniform(&random, 0.5, 1);
    return PTIE_OK;
}

ptie_status ptie_frames_create(ptie_frames *frames, const ptie_bench *bench, int32_t side) {
    *frames = (ptie_frames){.pixels = (size_t)side * (size_t)side};
    const size_t count = (size_t)ptie_pool_threads(bench->engine->pool) * frames->pixels;
    PTIE_TRY(make_block(&frames->a, count, 0));
    PTIE_TRY(make_block(&frames->b, count, 1));
    return make_block(&frames->c, count, 2);
}

ptie_status ptie_frames_add_scratch(ptie_frames *frames, const ptie_bench *bench, size_t bytes) {
    frames->scratch_bytes = (bytes + PTIE_ALIGNMENT - 1) / PTIE_ALIGNMENT * PTIE_ALIGNMENT;
    return ptie_alloc_status(&frames->scratch, (size_t)ptie_pool_threads(bench->engine->pool),
                             frames->scratch_bytes, where);
}

void ptie_frames_free(ptie_frames *frames) {
    ptie_free(frames->a);
    ptie_free(frames->b);
    ptie_free(frames->c);
    ptie_free(frames->scratch);
}
