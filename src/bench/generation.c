/* SPDX-License-Identifier: BSD-3-Clause */
/* Samples of the built-in presets, drawn on every thread. */
#include <stdio.h>

#include "base/memory.h"
#include "bench/frames.h"
#include "bench/groups.h"
#include "train/preset.h"
#include "train/sampler.h"

typedef struct generation {
    ptie_sampler *sampler;
    ptie_frames frames; /* a: clean, b: noisy */
    uint64_t *next;     /* per thread, a line of the cache apart */
    uint64_t threads;
} generation;

enum { LINE = PTIE_ALIGNMENT / sizeof(uint64_t) };

static ptie_status draw(void *context, int32_t worker) {
    const generation *g = context;
    const ptie_frames *f = &g->frames;
    uint64_t *next = g->next + (size_t)worker * LINE;
    const uint64_t index = *next * g->threads + (uint64_t)worker;
    ++*next;
    return ptie_sampler_draw(g->sampler, 1, index, ptie_frame(f, f->a, worker),
                             ptie_frame(f, f->b, worker), NULL, ptie_frame_scratch(f, worker));
}

static ptie_status measure_preset(ptie_bench *bench, const ptie_preset *preset) {
    const int32_t threads = ptie_pool_threads(bench->engine->pool);
    generation g = {.threads = (uint64_t)threads};
    ptie_bench_case c = {
        .unit = "pairs/s", .mode = PTIE_BENCH_EACH, .amount = 1, .work = draw, .context = &g};
    ptie_status status;
    snprintf(c.name, sizeof c.name, "preset %.24s, %d x %d", preset->name, preset->width_px,
             preset->height_px);
    PTIE_TRY_DONE(ptie_sampler_create(&g.sampler, preset));
    PTIE_TRY_DONE(ptie_frames_create(&g.frames, bench, preset->width_px));
    PTIE_TRY_DONE(ptie_frames_add_scratch(&g.frames, bench, ptie_sampler_scratch(g.sampler)));
    PTIE_TRY_DONE(ptie_alloc_status(&g.next, (size_t)threads, LINE * sizeof *g.next, "bench"));
    status = ptie_bench_measure(bench, &c);
done:
    ptie_free(g.next);
    ptie_frames_free(&g.frames);
    ptie_sampler_free(g.sampler);
    return status;
}

ptie_status ptie_bench_generation(ptie_bench *bench) {
    for (int32_t i = 0; ptie_preset_name(i); i++) {
        ptie_preset *preset;
        PTIE_TRY(ptie_preset_read(&preset, ptie_preset_name(i)));
        const ptie_status status = measure_preset(bench, preset);
        ptie_preset_free(preset);
        PTIE_TRY(status);
    }
    return PTIE_OK;
}
