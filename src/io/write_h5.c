/* SPDX-License-Identifier: BSD-3-Clause */
/* One map over time as NeXus HDF5, a chunk per frame.  Compressed frames are gathered until every thread has one
 * to pack; the file gets finished chunks. */
#include <stdio.h>

#include "base/memory.h"
#include "io/detector.h"
#include "io/nexus.h"
#include "io/pack.h"
#include "io/writer.h"

typedef struct h5_map {
    const ptie_writer_job *job;
    ptie_h5 *h5;
    ptie_nexus_axes axes;
    char path[256];   /* of the data set */
    uint64_t written; /* frames in the file */
    size_t held, block;    /* frames that wait, and how many may */
    unsigned char *frames; /* (block, bytes of a frame) */
    size_t packed_room;    /* largest size of a packed frame */
    size_t *packed_bytes;  /* (block) */
    unsigned char *packed; /* (block, packed_room) */
    ptie_packer **packers; /* one per frame of the block */
} h5_map;

static void h5_free(h5_map *map) {
    for (size_t i = 0; map->packers && i < map->block; i++) ptie_packer_free(map->packers[i]);
    ptie_free(map->packers);
    ptie_free(map->packed);
    ptie_free(map->packed_bytes);
    ptie_free(map->frames);
    ptie_free(map);
}

static void h5_discard(void *state) {
    h5_map *map = state;
    ptie_h5_discard(map->h5);
    h5_free(map);
}

static ptie_h5_type stored_type(ptie_sample stored) {
    if (stored.kind == 'f') return PTIE_H5_F32;
    return stored.bytes == 1 ? PTIE_H5_U8 : PTIE_H5_U16;
}

static ptie_status begin(h5_map *map) {
    const ptie_writer_job *job = map->job;
    const ptie_recording_info *info = &job->info;
    const ptie_nexus_signal signal = {.name = job->name,
                                      .unit = info->unit,
                                      .type = stored_type(job->stored),
                                      .packed = job->compress};
    const double step = info->frame_step ? (double)info->frame_step : 1;
    map->axes = (ptie_nexus_axes){.frames = (uint64_t)info->frames,
                                  .width_px = info->width_px,
                                  .height_px = info->height_px,
                                  .first_frame = info->first_frame,
                                  .frame_step = info->frame_step,
                                  .frame_rate_hz = info->frame_rate_hz * step,
                                  .pixel_m = info->pixel_m};
    snprintf(map->path, sizeof map->path, PTIE_NEXUS_DATA "/%s", job->name);
    PTIE_TRY(ptie_h5_create(&map->h5, job->path, job->overwrite));
    PTIE_TRY(ptie_nexus_begin(map->h5, &map->axes, &signal, 1));
    PTIE_TRY(ptie_detector_write(map->h5, info));
    if (!job->source && !job->command) return PTIE_OK;
    return ptie_nexus_process(map->h5, job->source, job->command);
}

static ptie_status allocate(h5_map *map) {
    const ptie_writer_job *job = map->job;
    const size_t bytes = ptie_job_bytes(job), samples = bytes / job->stored.bytes;
    map->block = job->compress && job->pool ? (size_t)ptie_pool_threads(job->pool) : 1;
    PTIE_TRY(ptie_alloc_status(&map->frames, map->block, bytes, job->path));
    if (!job->compress) return PTIE_OK;
    PTIE_TRY(ptie_alloc_status(&map->packers, map->block, sizeof *map->packers, job->path));
    for (size_t i = 0; i < map->block; i++)
        PTIE_TRY(ptie_packer_create(&map->packers[i], samples, job->stored.bytes));
    map->packed_room = ptie_packer_bound(map->packers[0]);
    PTIE_TRY(ptie_alloc_status(&map->packed, map->block, map->packed_room, job->path));
    return ptie_alloc_status(&map->packed_bytes, map->block, sizeof *map->packed_bytes, job->path);
}

static ptie_status h5_create(void **state, const ptie_writer_job *job) {
    h5_map *map;
    *state = NULL;
    PTIE_TRY(ptie_alloc_status(&map, 1, sizeof *map, job->path));
    map->job = job;
    ptie_status status = allocate(map);
    if (status == PTIE_OK) status = begin(map);
    if (status != PTIE_OK) {
        h5_discard(map);
        return status;
    }
    *state = map;
    return PTIE_OK;
}

static ptie_status pack_task(void *context, size_t i, int32_t worker) {
    (void)worker;
    h5_map *map = context;
    map->packed_bytes[i] = ptie_pack(map->packers[i], map->packed + i * map->packed_room,
                                     map->frames + i * ptie_job_bytes(map->job));
    return PTIE_OK;
}

/* Packs the frames that wait, and writes them in their order. */
static ptie_status write_packed(h5_map *map) {
    if (map->held == 1)
        PTIE_TRY(pack_task(map, 0, 0));
    else if (map->held > 1)
        PTIE_TRY(ptie_pool_run(map->job->pool, map->held, pack_task, map));
    for (size_t i = 0; i < map->held; i++)
        PTIE_TRY(ptie_h5_write_chunk(map->h5, map->path, map->written++,
                                     map->packed + i * map->packed_room, map->packed_bytes[i]));
    map->held = 0;
    return PTIE_OK;
}

static ptie_status h5_add_column(void *state, const char *path, const double *values, int64_t count) {
    h5_map *map = state;
    const uint64_t length = (uint64_t)count;
    PTIE_TRY(ptie_h5_dataset(map->h5, path, PTIE_H5_F64, 1, &length, 0));
    return ptie_h5_write(map->h5, path, PTIE_H5_F64, 0, length, values);
}

static ptie_status h5_append(void *state, const float *frame) {
    h5_map *map = state;
    const size_t bytes = ptie_job_bytes(map->job);
    PTIE_TRY(ptie_job_encode(map->job, map->frames + map->held * bytes, frame));
    if (!map->job->compress)
        return ptie_h5_write_chunk(map->h5, map->path, map->written++, map->frames, bytes);
    return ++map->held == map->block ? write_packed(map) : PTIE_OK;
}

static ptie_status finish(h5_map *map, int64_t frames) {
    PTIE_TRY(write_packed(map));
    if (map->axes.frames > 0) return PTIE_OK;
    map->axes.frames = (uint64_t)frames;
    return ptie_nexus_end(map->h5, &map->axes);
}

static ptie_status h5_complete(void *state, int64_t frames) {
    h5_map *map = state;
    ptie_status status = finish(map, frames);
    if (status != PTIE_OK) {
        h5_discard(map);
        return status;
    }
    status = ptie_h5_close(map->h5);
    h5_free(map);
    return status;
}

const ptie_writer_format ptie_write_h5 = {.endings = {".h5", ".hdf5"},
                                          .create = h5_create,
                                          .append = h5_append,
                                          .add_column = h5_add_column,
                                          .complete = h5_complete,
                                          .discard = h5_discard};
