/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/pool.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <string.h>

#include "base/memory.h"

#define MAX_THREADS 256

typedef struct worker {
    ptie_pool *pool;
    pthread_t thread;
    int32_t number;
    ptie_status status; /* of the last job */
    size_t failed_at;
    char message[PTIE_MESSAGE_BYTES];
} worker;

struct ptie_pool {
    int32_t threads;
    int32_t started; /* threads beside the caller that run */
    pthread_mutex_t lock;
    pthread_cond_t wake, finished;
    uint64_t job; /* number of the current job; workers wait for it to change */
    int32_t busy;
    bool quit;
    ptie_task task;
    void *context;
    size_t count;
    atomic_size_t next; /* index that the next free worker takes */
    worker workers[MAX_THREADS];
};

/* Takes indices one after the other until none is left, or until a task has failed.  They are handed
   out in ascending order, so every index below a failed one has been handed out too. */
static void work(worker *self, size_t count, ptie_task task, void *context) {
    self->status = PTIE_OK;
    for (;;) {
        const size_t i = atomic_fetch_add(&self->pool->next, 1);
        if (i >= count) return;
        self->status = task(context, i, self->number);
        if (self->status == PTIE_OK) continue;
        atomic_store(&self->pool->next, count);
        self->failed_at = i;
        memcpy(self->message, ptie_last_error(), strlen(ptie_last_error()) + 1);
        return;
    }
}

static void *worker_main(void *argument) {
    worker *self = argument;
    ptie_pool *pool = self->pool;
    uint64_t seen = 0;
    pthread_mutex_lock(&pool->lock);
    for (;;) {
        while (pool->job == seen && !pool->quit) pthread_cond_wait(&pool->wake, &pool->lock);
        if (pool->quit) break;
        seen = pool->job;
        ptie_task task = pool->task;
        void *context = pool->context;
        size_t count = pool->count;
        pthread_mutex_unlock(&pool->lock);
        work(self, count, task, context);
        pthread_mutex_lock(&pool->lock);
        if (--pool->busy == 0) pthread_cond_signal(&pool->finished);
    }
    pthread_mutex_unlock(&pool->lock);
    return NULL;
}

static int32_t usable_processors(void) {
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
    int n = CPU_COUNT(&set);
    return n < 1 ? 1 : n > MAX_THREADS ? MAX_THREADS : n;
}

ptie_status ptie_pool_create(ptie_pool **out, int32_t threads) {
    *out = NULL;
    if (threads < 0 || threads > MAX_THREADS)
        return PTIE_FAIL(PTIE_EINVAL, "threads: out of range (expected 0..%d, found %d)", MAX_THREADS,
                         threads);
    ptie_pool *pool;
    PTIE_TRY(ptie_alloc_status(&pool, 1, sizeof *pool, "thread pool"));
    pool->threads = threads ? threads : usable_processors();
    pthread_mutex_init(&pool->lock, NULL);
    pthread_cond_init(&pool->wake, NULL);
    pthread_cond_init(&pool->finished, NULL);
    for (int32_t i = 0; i < pool->threads; i++) {
        pool->workers[i].pool = pool;
        pool->workers[i].number = i;
    }
    for (int32_t i = 1; i < pool->threads; i++) {
        int error = pthread_create(&pool->workers[i].thread, NULL, worker_main, &pool->workers[i]);
        if (error) {
            const ptie_status status = PTIE_FAIL(PTIE_ENOMEM, "thread pool: cannot start thread %d of %d: %s",
                                                 i + 1, pool->threads, strerror(error));
            ptie_pool_free(pool);
            return status;
        }
        pool->started++;
    }
    *out = pool;
    return PTIE_OK;
}

void ptie_pool_free(ptie_pool *pool) {
    if (!pool) return;
    pthread_mutex_lock(&pool->lock);
    pool->quit = true;
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->lock);
    for (int32_t i = 1; i <= pool->started; i++) pthread_join(pool->workers[i].thread, NULL);
    pthread_cond_destroy(&pool->finished);
    pthread_cond_destroy(&pool->wake);
    pthread_mutex_destroy(&pool->lock);
    ptie_free(pool);
}

int32_t ptie_pool_threads(const ptie_pool *pool) {
    return pool->threads;
}

ptie_status ptie_pool_run(ptie_pool *pool, size_t count, ptie_task task, void *context) {
    if (count == 0) return PTIE_OK;
    pthread_mutex_lock(&pool->lock);
    pool->task = task;
    pool->context = context;
    pool->count = count;
    atomic_store(&pool->next, 0);
    pool->busy = pool->started;
    pool->job++;
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->lock);

    work(&pool->workers[0], count, task, context);

    pthread_mutex_lock(&pool->lock);
    while (pool->busy > 0) pthread_cond_wait(&pool->finished, &pool->lock);
    pthread_mutex_unlock(&pool->lock);

    const worker *first = NULL; /* the failure with the lowest index */
    for (int32_t i = 0; i < pool->threads; i++) {
        const worker *w = &pool->workers[i];
        if (w->status != PTIE_OK && (!first || w->failed_at < first->failed_at)) first = w;
    }
    if (!first) return PTIE_OK;
    ptie_set_message(first->message);
    return first->status;
}
