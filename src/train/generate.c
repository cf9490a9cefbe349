/* SPDX-License-Identifier: BSD-3-Clause */
/* Writes data set files: samples are drawn in blocks on the pool while the block before is written. */
#include <stdio.h>
#include <string.h>

#include <ptie/version.h>

#include "base/memory.h"
#include "train/dataset.h"

/* Samples per block at 256 x 256; larger maps make smaller blocks, so that memory stays constant.
 */
#define BLOCK_SAMPLES 32
#define BLOCK_BYTES ((size_t)16 << 20)

typedef struct block {
    uint64_t first, count;  /* of the samples in it */
    float *clean, *noisy;   /* (samples, H, W) */
    ptie_sample_info *info; /* (samples) */
} block;

typedef struct generation {
    const ptie_sampler *sampler;
    ptie_pool *pool;
    ptie_h5 *h5;
    uint64_t seed;
    size_t block_samples, pixels, scratch_bytes;
    block blocks[2];
    block *drawing, *writing; /* either of `blocks` */
    uint32_t *column;         /* (samples) */
    unsigned char *scratch;   /* one part per worker */
} generation;

static size_t block_samples(const ptie_pool *pool, size_t pixels) {
    const size_t fits = BLOCK_BYTES / (2 * pixels * sizeof(float));
    const size_t threads = (size_t)ptie_pool_threads(pool);
    return fits > BLOCK_SAMPLES ? BLOCK_SAMPLES : fits > threads ? fits : threads;
}

static void free_generation(generation *g) {
    for (int i = 0; i < 2; i++) {
        ptie_free(g->blocks[i].clean);
        ptie_free(g->blocks[i].noisy);
        ptie_free(g->blocks[i].info);
    }
    ptie_free(g->column);
    ptie_free(g->scratch);
}

static ptie_status alloc_generation(generation *g) {
    const size_t samples = g->block_samples, map = g->pixels * sizeof(float);
    for (int i = 0; i < 2; i++) {
        block *b = &g->blocks[i];
        PTIE_TRY(ptie_alloc_status(&b->clean, samples, map, "block of samples"));
        PTIE_TRY(ptie_alloc_status(&b->noisy, samples, map, "block of samples"));
        PTIE_TRY(ptie_alloc_status(&b->info, samples, sizeof *b->info, "block of samples"));
    }
    g->drawing = &g->blocks[0];
    g->writing = &g->blocks[1];
    PTIE_TRY(ptie_alloc_status(&g->column, samples, sizeof *g->column, "block of samples"));
    return ptie_alloc_status(&g->scratch, (size_t)ptie_pool_threads(g->pool), g->scratch_bytes,
                             "scratch of the sampler");
}

static ptie_status draw_one(void *context, size_t i, int32_t worker) {
    const generation *g = context;
    const block *b = g->drawing;
    return ptie_sampler_draw(g->sampler, g->seed, b->first + i, b->clean + i * g->pixels,
                             b->noisy + i * g->pixels, &b->info[i],
                             g->scratch + (size_t)worker * g->scratch_bytes);
}

static ptie_status write_block(const generation *g, const block *b) {
    PTIE_TRY(ptie_h5_write(g->h5, "/clean", PTIE_H5_F32, b->first, b->count, b->clean));
    PTIE_TRY(ptie_h5_write(g->h5, "/noisy", PTIE_H5_F32, b->first, b->count, b->noisy));
    for (int c = 0; c < PTIE_INFO_COLUMNS; c++) {
        const ptie_info_column *column = &ptie_info_columns[c];
        for (uint64_t i = 0; i < b->count; i++)
            memcpy(&g->column[i], (const char *)&b->info[i] + column->offset, sizeof *g->column);
        PTIE_TRY(ptie_h5_write(g->h5, column->path, column->type, b->first, b->count, g->column));
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
    PTIE_TRY(ptie_h5_set_integer(h5, "/", "generator", PTIE_GENERATOR));
    PTIE_TRY(ptie_h5_set_text(h5, "/", "version", ptie_version()));
    PTIE_TRY(ptie_h5_set_integer(h5, "/", "seed", (int64_t)seed));
    PTIE_TRY(ptie_h5_set_integer(h5, "/", "count", (int64_t)count));
    return write_split(h5, count);
}

/* Of two threads one hands the drawing to the pool and the other writes. */
static ptie_status draw_or_write(void *context, size_t which, int32_t thread) {
    generation *g = context;
    (void)thread;
    if (which == 0) return ptie_pool_run(g->pool, (size_t)g->drawing->count, draw_one, g);
    return g->writing->count > 0 ? write_block(g, g->writing) : PTIE_OK;
}

static ptie_status write_blocks(generation *g, ptie_pool *pair, uint64_t count,
                                ptie_progress progress) {
    for (uint64_t drawn = 0, written = 0; written < count;) {
        const uint64_t left = count - drawn;
        g->drawing->first = drawn;
        g->drawing->count = left < g->block_samples ? left : g->block_samples;
        PTIE_TRY(ptie_pool_run(pair, 2, draw_or_write, g));
        drawn += g->drawing->count;
        written += g->writing->count;
        if (written > 0) PTIE_TRY(ptie_progress_report(progress, written, count, NULL));
        block *full = g->drawing;
        g->drawing = g->writing;
        g->writing = full;
    }
    return PTIE_OK;
}

ptie_status ptie_dataset_generate(ptie_pool *pool, const char *path, const ptie_preset *preset,
                                  uint64_t seed, uint64_t count, bool overwrite,
                                  ptie_progress progress) {
    ptie_sampler *sampler = NULL;
    ptie_pool *pair = NULL;
    generation g = {.pool = pool,
                    .seed = seed,
                    .pixels = (size_t)preset->width_px * (size_t)preset->height_px};
    g.block_samples = block_samples(pool, g.pixels);

    ptie_status status;
    PTIE_TRY_DONE(ptie_h5_create(&g.h5, path, overwrite));
    PTIE_TRY_DONE(describe(g.h5, preset, seed, count));
    PTIE_TRY_DONE(ptie_sampler_create(&sampler, preset));
    g.sampler = sampler;
    g.scratch_bytes = ptie_sampler_scratch(sampler);
    PTIE_TRY_DONE(alloc_generation(&g));
    PTIE_TRY_DONE(ptie_pool_create(&pair, 2));
    PTIE_TRY_DONE(write_blocks(&g, pair, count, progress));
    status = ptie_h5_close(g.h5);
    g.h5 = NULL;
done:
    ptie_pool_free(pair);
    ptie_h5_discard(g.h5);
    free_generation(&g);
    ptie_sampler_free(sampler);
    return status;
}
