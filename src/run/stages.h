/* SPDX-License-Identifier: BSD-3-Clause */
/* Frames through three stages at once: one thread reads ahead, the pool's threads compute, one thread
 * writes in order.  Between them lie a fixed number of slots, so memory is bounded however long the
 * recording is and whichever stage is slowest.
 */
#ifndef PTIE_RUN_STAGES_H
#define PTIE_RUN_STAGES_H

#include "base/pool.h"

/* Each takes a frame and the slot its data is in.  reading and writing see frames in ascending order,
   one at a time; solving sees them on any worker, in any order. */
typedef struct ptie_stages {
    ptie_status (*read)(void *context, int64_t frame, size_t slot);
    ptie_status (*solve)(void *context, int64_t frame, size_t slot, int32_t worker);
    ptie_status (*write)(void *context, int64_t frame, size_t slot);
    void *context;
    int64_t first, end; /* the frames first .. end-1 */
    size_t slots;
    ptie_progress progress; /* of frames written, on the calling thread */
    int64_t total;          /* what progress reports as the end */
} ptie_stages;

/* Slots that keep every thread busy: one frame under work per worker, and some read and solved. */
size_t ptie_stages_slots(const ptie_pool *pool, int64_t frames);

/* Returns when all frames are written, or, after a failure, when all before the first one that failed are, and
   none behind it; cancelling stops earlier.  A single frame is done on the calling thread alone, so that
   solve may use the pool itself. */
ptie_status ptie_stages_run(const ptie_stages *stages, ptie_pool *pool);

#endif
