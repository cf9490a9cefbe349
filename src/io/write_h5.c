/* SPDX-License-Identifier: BSD-3-Clause */
/* One map over time as NeXus HDF5. */
#include <stdio.h>

#include "base/memory.h"
#include "io/nexus.h"
#include "io/writer.h"

typedef struct h5_map {
    ptie_h5 *h5;
    ptie_nexus_axes axes;
    uint64_t written;
    char path[256]; /* of the data set */
} h5_map;

static void h5_discard(void *state) {
    h5_map *map = state;
    ptie_h5_discard(map->h5);
    ptie_free(map);
}

static ptie_status begin(h5_map *map, const ptie_writer_job *job) {
    const ptie_recording_info *info = &job->info;
    const ptie_nexus_signal signal = {.name = job->name, .unit = info->unit};
    map->axes = (ptie_nexus_axes){.frames = (uint64_t)info->frames,
                                  .width_px = info->width_px,
                                  .height_px = info->height_px,
                                  .first_frame = info->first_frame,
                                  .frame_step = info->frame_step,
                                  .frame_rate_hz = info->frame_rate_hz,
                                  .pixel_m = info->pixel_m};
    snprintf(map->path, sizeof map->path, PTIE_NEXUS_DATA "/%s", job->name);
    PTIE_TRY(ptie_h5_create(&map->h5, job->path, job->overwrite));
    return ptie_nexus_begin(map->h5, &map->axes, &signal, 1);
}

static ptie_status h5_create(void **state, const ptie_writer_job *job) {
    h5_map *map;
    *state = NULL;
    PTIE_TRY(ptie_alloc_status(&map, 1, sizeof *map, job->path));
    ptie_status status = begin(map, job);
    if (status != PTIE_OK) {
        h5_discard(map);
        return status;
    }
    *state = map;
    return PTIE_OK;
}

static ptie_status h5_append(void *state, const float *frame) {
    h5_map *map = state;
    return ptie_h5_write(map->h5, map->path, PTIE_H5_F32, map->written++, 1, frame);
}

static ptie_status h5_complete(void *state, int64_t frames) {
    h5_map *map = state;
    ptie_status status = PTIE_OK;
    if (map->axes.frames == 0) {
        map->axes.frames = (uint64_t)frames;
        status = ptie_nexus_end(map->h5, &map->axes);
    }
    if (status != PTIE_OK) {
        h5_discard(map);
        return status;
    }
    status = ptie_h5_close(map->h5);
    ptie_free(map);
    return status;
}

const ptie_writer_format ptie_write_h5 = {.endings = {".h5", ".hdf5"},
                                          .create = h5_create,
                                          .append = h5_append,
                                          .complete = h5_complete,
                                          .discard = h5_discard};
