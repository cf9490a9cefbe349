/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/columns.h"

#include <string.h>

#include "base/memory.h"
#include "io/h5.h"

#define METRICS "/entry/metrics/"

/* "result.h5" of "result.h5:/data/set". */
static ptie_status file_of(char **file, const char *input, const char *dataset) {
    *file = ptie_strdup(input);
    if (!*file) return PTIE_FAIL(PTIE_ENOMEM, "%s: out of memory", input);
    const size_t length = strlen(input), inside = strlen(dataset);
    if (length > inside + 1 && input[length - inside - 1] == ':' &&
        strcmp(input + length - inside, dataset) == 0)
        (*file)[length - inside - 1] = 0;
    return PTIE_OK;
}

/* values: room for all frames of the input. */
static ptie_status copy_column(ptie_writer *output, ptie_h5 *h5, const char *path, double *values,
                               const ptie_recording_info *info, ptie_frame_range frames, int64_t count) {
    int32_t rank;
    uint64_t dims[4];
    char sample[16];
    PTIE_TRY(ptie_h5_shape(h5, path, &rank, dims));
    if (rank != 1 || dims[0] != (uint64_t)info->frames || ptie_h5_sample(h5, path, sample) != PTIE_OK)
        return PTIE_OK; /* not of the frames */
    PTIE_TRY(ptie_h5_read(h5, path, PTIE_H5_F64, 0, dims[0], values));
    for (int64_t i = 0; i < count; i++) values[i] = values[frames.first + i * frames.step];
    return ptie_io_add_column(output, path, values, count);
}

static ptie_status copy_listed(ptie_writer *output, ptie_h5 *h5, char *lines,
                               const ptie_recording_info *info, ptie_frame_range frames, int64_t count) {
    double *values;
    char *rest = NULL;
    ptie_status status = ptie_alloc_status(&values, (size_t)info->frames, sizeof *values, "metrics");
    for (char *path = strtok_r(lines, "\n", &rest); path && status == PTIE_OK; path = strtok_r(NULL, "\n", &rest))
        if (strncmp(path, METRICS, strlen(METRICS)) == 0)
            status = copy_column(output, h5, path, values, info, frames, count);
    ptie_free(values);
    return status;
}

ptie_status ptie_copy_columns(ptie_writer *output, const char *input, const ptie_recording_info *info,
                              ptie_frame_range frames, int64_t count) {
    ptie_text lines = {0};
    ptie_h5 *h5 = NULL;
    char *file;
    if (strcmp(info->format, "HDF5") != 0 || !ptie_io_has_columns(output)) return PTIE_OK;
    PTIE_TRY(file_of(&file, input, info->dataset));
    ptie_status status = ptie_h5_open(&h5, file);
    if (status == PTIE_OK) status = ptie_h5_list(h5, &lines);
    if (status == PTIE_OK && lines.data) status = copy_listed(output, h5, lines.data, info, frames, count);
    ptie_text_free(&lines);
    ptie_h5_discard(h5);
    ptie_free(file);
    return status;
}
