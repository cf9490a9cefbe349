/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/stages.h"

#include <pthread.h>
#include <stdatomic.h>
#include <string.h>

#include "base/memory.h"

/* What a slot waits for: its stages in turn, for frame n, then for frame n + slots, ... */
enum { TO_READ, TO_SOLVE, TO_WRITE, STAGES };

typedef struct slot {
    pthread_cond_t changed;
    int64_t turn; /* STAGES * (how many frames it has carried) + what it waits for */
} slot;

typedef struct flow {
    const ptie_stages *stages;
    pthread_mutex_t lock;
    slot *slots;
    int64_t end;        /* frames below are worked on: the stream's, or the first that failed */
    ptie_status status; /* its failure */
    char message[PTIE_MESSAGE_BYTES];
    atomic_llong written;
} flow;

static slot *slot_of(const flow *f, int64_t frame) {
    return &f->slots[(size_t)(frame - f->stages->first) % f->stages->slots];
}

/* Waits until it is `stage`'s turn with the frame; false when the stream ends before it. */
static bool await(flow *f, int64_t frame, int stage) {
    slot *s = slot_of(f, frame);
    const int64_t turn = STAGES * ((frame - f->stages->first) / (int64_t)f->stages->slots) + stage;
    pthread_mutex_lock(&f->lock);
    while (frame < f->end && s->turn != turn) pthread_cond_wait(&s->changed, &f->lock);
    const bool go_on = frame < f->end;
    pthread_mutex_unlock(&f->lock);
    return go_on;
}

/* Hands the frame to the next stage. */
static void hand_on(flow *f, int64_t frame) {
    slot *s = slot_of(f, frame);
    pthread_mutex_lock(&f->lock);
    s->turn++;
    pthread_cond_broadcast(&s->changed);
    pthread_mutex_unlock(&f->lock);
}

/* The stream now ends before this frame.  Of several failures that of the lowest frame counts, so which one is
   reported does not depend on threads. */
static void end_before(flow *f, int64_t frame, ptie_status status) {
    pthread_mutex_lock(&f->lock);
    if (frame < f->end) {
        f->end = frame;
        f->status = status;
        memcpy(f->message, ptie_last_error(), strlen(ptie_last_error()) + 1);
    }
    for (size_t i = 0; i < f->stages->slots; i++) pthread_cond_broadcast(&f->slots[i].changed);
    pthread_mutex_unlock(&f->lock);
}

typedef ptie_status (*ordered_stage)(void *context, int64_t frame, size_t slot);

/* Takes all frames through a stage, one after the other. */
static void take_all(flow *f, int stage, ordered_stage task) {
    const ptie_stages *s = f->stages;
    for (int64_t i = s->first; i < s->end && await(f, i, stage); i++) {
        const ptie_status status = task(s->context, i, (size_t)(slot_of(f, i) - f->slots));
        if (status != PTIE_OK) {
            end_before(f, i, status);
            return;
        }
        if (stage == TO_WRITE) atomic_store(&f->written, i + 1);
        hand_on(f, i);
    }
}

static void *read_all(void *context) {
    flow *f = context;
    take_all(f, TO_READ, f->stages->read);
    return NULL;
}

static void *write_all(void *context) {
    flow *f = context;
    take_all(f, TO_WRITE, f->stages->write);
    return NULL;
}

/* A callback that asks to stop ends the stream before the first frame that is not written. */
static void report(flow *f) {
    const ptie_stages *s = f->stages;
    const int64_t written = atomic_load(&f->written);
    const ptie_status status = ptie_progress_report(s->progress, (uint64_t)written, (uint64_t)s->total, NULL);
    if (status != PTIE_OK) end_before(f, written, status);
}

/* The pool's task.  Indices are handed out in order, so every frame before this one is on its way. */
static ptie_status solve_one(void *context, size_t index, int32_t worker) {
    flow *f = context;
    const ptie_stages *s = f->stages;
    const int64_t frame = s->first + (int64_t)index;
    if (!await(f, frame, TO_SOLVE)) return PTIE_ECANCELLED; /* the reason is in f->status */
    const ptie_status status = s->solve(s->context, frame, (size_t)(slot_of(f, frame) - f->slots), worker);
    if (status != PTIE_OK)
        end_before(f, frame, status);
    else
        hand_on(f, frame);
    if (worker == 0) report(f); /* worker 0 is the calling thread */
    return status;
}

static ptie_status start(pthread_t *thread, flow *f, void *(*body)(void *)) {
    const int error = pthread_create(thread, NULL, body, f);
    return error ? PTIE_FAIL(PTIE_ENOMEM, "stages: cannot start a thread: %s", strerror(error)) : PTIE_OK;
}

static void run_stages(flow *f, ptie_pool *pool) {
    pthread_t reader, writer;
    const bool reading = start(&reader, f, read_all) == PTIE_OK;
    const bool writing = reading && start(&writer, f, write_all) == PTIE_OK;
    ptie_status ignored = PTIE_OK; /* f->status has it */
    if (writing)
        ignored = ptie_pool_run(pool, (size_t)(f->stages->end - f->stages->first), solve_one, f);
    else
        end_before(f, f->stages->first, PTIE_ENOMEM);
    (void)ignored;
    if (reading) pthread_join(reader, NULL);
    if (writing) pthread_join(writer, NULL);
}

static ptie_status run_one(const ptie_stages *s) {
    PTIE_TRY(s->read(s->context, s->first, 0));
    PTIE_TRY(s->solve(s->context, s->first, 0, 0));
    return s->write(s->context, s->first, 0);
}

static ptie_status run_all(const ptie_stages *s, ptie_pool *pool) {
    flow f = {.stages = s, .end = s->end};
    atomic_init(&f.written, s->first);
    PTIE_TRY(ptie_alloc_status(&f.slots, s->slots, sizeof *f.slots, "stages"));
    pthread_mutex_init(&f.lock, NULL);
    for (size_t i = 0; i < s->slots; i++) pthread_cond_init(&f.slots[i].changed, NULL);
    run_stages(&f, pool);
    for (size_t i = 0; i < s->slots; i++) pthread_cond_destroy(&f.slots[i].changed);
    pthread_mutex_destroy(&f.lock);
    ptie_free(f.slots);
    if (f.status != PTIE_OK) ptie_set_message(f.message);
    return f.status;
}

size_t ptie_stages_slots(const ptie_pool *pool, int64_t frames) {
    const int64_t slots = 2 * ptie_pool_threads(pool) + 4;
    return (size_t)(slots < frames ? slots : frames);
}

ptie_status ptie_stages_run(const ptie_stages *stages, ptie_pool *pool) {
    const int64_t frames = stages->end - stages->first;
    if (frames == 0) return PTIE_OK;
    PTIE_TRY(frames == 1 ? run_one(stages) : run_all(stages, pool));
    return ptie_progress_report(stages->progress, (uint64_t)stages->end, (uint64_t)stages->total, NULL);
}
