/* SPDX-License-Identifier: BSD-3-Clause */
/* Writes data set files: samples are drawn in blocks on the pool, and each block is written in
 * order. */
#include <stdio.h>
#include <string.h>

#include <ptie/version.h>

#include "base/memory.h"
#include "train/dataset.h"

/* Samples per block at 256 x 256; larger maps make smaller blocks, so that memory stays constant.
 */
#define BLOCK_SAMPLES 64
#define BLOCK_BYTES ((size_t)32 << 20)

typedef struct generation {
    const ptie_sampler *sampler;
    uint64_t seed, first; /* first sample of the block */
    size_t block, pixels, scratch_bytes;
    float *clean, *noisy;   /* (block, H, W) */
    ptie_sample_info *info; /* (block) */
    uint32_t *column;       /* (block) */
    unsigned char *scratch; /* one part per worker */
} generation;

static size_t block_samples(const ptie_pool *pool, size_t pixels) {
    const size_t fits = BLOCK_BYTES / (2 * pixels * sizeof(float));
    const size_t threads = (size_t)ptie_pool_threads(pool);
    return fits > BLOCK_SAMPLES ? BLOCK_SAMPLES : fits > threads ? fits : threads;
}

static void free_generation(generation *g) {
    ptie_free(g->clean);
    ptie_free(g->noisy);
    ptie_free(g->info);
    ptie_free(g->column);
    ptie_free(g->scratch);
}

static ptie_status alloc_generation(generation *g, const ptie_pool *pool) {
    PTIE_TRY(ptie_alloc_status(&g->clean, g->block, g->pixels * sizeof(float), "block of samples"));
    PTIE_TRY(ptie_alloc_status(&g->noisy, g->block, g->pixels * sizeof(float), "block of samples"));
    PTIE_TRY(ptie_alloc_status(&g->info, g->block, sizeof *g->info, "block of samples"));
    PTIE_TRY(ptie_alloc_status(&g->column, g->block, sizeof *g->column, "block of samples"));
    return ptie_alloc_status(&g->scratch, (size_t)ptie_pool_threads(pool), g->scratch_bytes,
                             "scratch of the sampler");
}

static ptie_status draw_one(void *context, size_t i, int32_t worker) {
    const generation *g = context;
    return ptie_sampler_draw(g->sampler, g->seed, g->first + i, g->clean + i * g->pixels,
                             g->noisy + i * g->pixels, &g->info[i],
                             g->scratch + (size_t)worker * g->scratch_bytes);
}

static ptie_status write_block(ptie_h5 *h5, const generation *g, uint64_t count) {
    PTIE_TRY(ptie_h5_write(h5, "/clean", PTIE_H5_F32, g->first, count, g->clean));
    PTIE_TRY(ptie_h5_write(h5, "/noisy", PTIE_H5_F32, g->first, count, g->noisy));
    for (int c = 0; c < PTIE_INFO_COLUMNS; c++) {
        const ptie_info_column *column = &ptie_info_columns[c];
        for (uint64_t i = 0; i < count; i++)
            memcpy(&g->column[i], (const char *)&g->info[i] + column->offset, sizeof *g->column);
        PTIE_TRY(ptie_h5_write(h5, column->path, column->type, g->first, count, g->column));
    }
    return PTIE_OK;
}

/* Slices of each split as Python reads them. */
static ptie_status write_split(ptie_h5 *h5, uint64_t count) {
    static const char *const names[] = {"train", "validation", "test"};
    char texts[3][64];
    const char *values[3] = {texts[0], texts[1], texts[2]};
    for (int i = 0; i < 3; i++) {
        const ptie_span span = ptie_split_span(count, (ptie_split)i);
        snprintf(texts[i], sizeof texts[i], "%s %llu:%llu", names[i],
                 (unsigned long long)span.first, (unsigned long long)(span.first + span.count));
    }
    return ptie_h5_set_texts(h5, "/", "split", values, 3);
}

static ptie_status describe(ptie_h5 *h5, const ptie_preset *preset, uint64_t seed, uint64_t count) {
    const uint64_t dims[3] = {count, (uint64_t)preset->height_px, (uint64_t)preset->width_px};
    PTIE_TRY(ptie_h5_dataset(h5, "/clean", PTIE_H5_F32, 3, dims, 0));
    PTIE_TRY(ptie_h5_dataset(h5, "/noisy", PTIE_H5_F32, 3, dims, 0));
    for (int c = 0; c < PTIE_INFO_COLUMNS; c++)
        PTIE_TRY(
            ptie_h5_dataset(h5, ptie_info_columns[c].path, ptie_info_columns[c].type, 1, dims, 0));
    PTIE_TRY(ptie_h5_set_text(h5, "/", "preset", preset->text));
    PTIE_TRY(ptie_h5_set_text(h5, "/", "version", ptie_version()));
    PTIE_TRY(ptie_h5_set_integer(h5, "/", "seed", (int64_t)seed));
    PTIE_TRY(ptie_h5_set_integer(h5, "/", "count", (int64_t)count));
    return write_split(h5, count);
}

static ptie_status write_blocks(ptie_h5 *h5, ptie_pool *pool, generation *g, uint64_t count,
                                ptie_progress progress) {
    for (g->first = 0; g->first < count;) {
        const uint64_t left = count - g->first, block = left < g->block ? left : g->block;
        PTIE_TRY(ptie_pool_run(pool, (size_t)block, draw_one, g));
        PTIE_TRY(write_block(h5, g, block));
        g->first += block;
        PTIE_TRY(ptie_progress_report(progress, g->first, count, NULL));
    }
    return PTIE_OK;
}

ptie_status ptie_dataset_generate(ptie_pool *pool, const char *path, const ptie_preset *preset,
                                  uint64_t seed, uint64_t count, bool overwrite,
                                  ptie_progress progress) {
    ptie_h5 *h5 = NULL;
    ptie_sampler *sampler = NULL;
    generation g = {.seed = seed, .pixels = (size_t)preset->width_px * (size_t)preset->height_px};
    g.block = block_samples(pool, g.pixels);

    ptie_status status;
    PTIE_TRY_DONE(ptie_h5_create(&h5, path, overwrite));
    PTIE_TRY_DONE(describe(h5, preset, seed, count));
    PTIE_TRY_DONE(ptie_sampler_create(&sampler, preset));
    g.sampler = sampler;
    g.scratch_bytes = ptie_sampler_scratch(sampler);
    PTIE_TRY_DONE(alloc_generation(&g, pool));
    PTIE_TRY_DONE(write_blocks(h5, pool, &g, count, progress));
    status = ptie_h5_close(h5);
    h5 = NULL;
done:
    ptie_h5_discard(h5);
    free_generation(&g);
    ptie_sampler_free(sampler);
    return status;
}
