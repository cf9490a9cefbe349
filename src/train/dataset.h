/* SPDX-License-Identifier: BSD-3-Clause */
/* Data sets: files and presets drawn on the fly; contracts as in <ptie/dataset.h>. */
#ifndef PTIE_TRAIN_DATASET_H
#define PTIE_TRAIN_DATASET_H

#include <pthread.h>

#include "base/pool.h"
#include "io/h5.h"
#include "train/sampler.h"

/* An open data set file; one thread at a time reads. */
typedef struct ptie_sample_file {
    ptie_h5 *h5;
    pthread_mutex_t lock;
} ptie_sample_file;

struct ptie_dataset {
    int32_t width_px, height_px;
    uint64_t count, seed;
    int64_t generator; /* PTIE_GENERATOR, or that of the file; 0: the file does not say */
    char *preset_text;
    ptie_sampler *sampler;  /* samples are drawn, */
    ptie_sample_file *file; /* or read; the other is NULL */
};

ptie_status ptie_dataset_load(ptie_dataset **out, const char *path);
ptie_status ptie_dataset_draw(ptie_dataset **out, const ptie_preset *preset, uint64_t seed,
                              uint64_t count);

/* ptie_dataset_read for many samples: the caller brings ptie_dataset_scratch bytes per thread. */
size_t ptie_dataset_scratch(const ptie_dataset *dataset);
ptie_status ptie_dataset_fetch(const ptie_dataset *dataset, ptie_split split, uint64_t index,
                               float *clean, float *noisy, ptie_sample_info *info, void *scratch);

/* First sample and number of samples of a split among `count`. */
typedef struct ptie_span {
    uint64_t first, count;
} ptie_span;
ptie_span ptie_split_span(uint64_t count, ptie_split split);

/* The fields of ptie_sample_info as columns of a file; each is 4 bytes wide. */
typedef struct ptie_info_column {
    const char *path;
    ptie_h5_type type;
    size_t offset;
} ptie_info_column;
enum { PTIE_INFO_COLUMNS = 6 };
extern const ptie_info_column ptie_info_columns[PTIE_INFO_COLUMNS];

/* ptie_dataset_write. */
ptie_status ptie_dataset_generate(ptie_pool *pool, const char *path, const ptie_preset *preset,
                                  uint64_t seed, uint64_t count, bool overwrite,
                                  ptie_progress progress);

#endif
