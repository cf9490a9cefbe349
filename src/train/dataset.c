/* SPDX-License-Identifier: BSD-3-Clause */
#include "train/dataset.h"

#include <assert.h>
#include <string.h>

#include "base/memory.h"

#define MAX_SIDE 32768

const ptie_info_column ptie_info_columns[PTIE_INFO_COLUMNS] = {
    {"/clean_offset_rad", PTIE_H5_F32, offsetof(ptie_sample_info, clean_offset_rad)},
    {"/clean_scale_rad", PTIE_H5_F32, offsetof(ptie_sample_info, clean_scale_rad)},
    {"/noisy_offset_rad", PTIE_H5_F32, offsetof(ptie_sample_info, noisy_offset_rad)},
    {"/noisy_scale_rad", PTIE_H5_F32, offsetof(ptie_sample_info, noisy_scale_rad)},
    {"/sigma", PTIE_H5_F32, offsetof(ptie_sample_info, sigma)},
    {"/morphologies", PTIE_H5_U32, offsetof(ptie_sample_info, morphologies)},
};

ptie_span ptie_split_span(uint64_t count, ptie_split split) {
    const uint64_t tenth = count < 3 ? 0 : count < 10 ? 1 : count / 10;
    const uint64_t train = count - 2 * tenth;
    switch (split) {
    case PTIE_TRAIN: return (ptie_span){0, train};
    case PTIE_VALIDATION: return (ptie_span){train, tenth};
    case PTIE_TEST: return (ptie_span){train + tenth, tenth};
    case PTIE_ALL: break;
    }
    return (ptie_span){0, count};
}

static ptie_status open_file(ptie_sample_file **out, const char *path) {
    ptie_h5 *h5;
    PTIE_TRY(ptie_h5_open(&h5, path));
    ptie_status status = ptie_alloc_status(out, 1, sizeof **out, "data set");
    if (status != PTIE_OK) {
        ptie_h5_discard(h5);
        return status;
    }
    (*out)->h5 = h5;
    pthread_mutex_init(&(*out)->lock, NULL);
    return PTIE_OK;
}

static void close_file(ptie_sample_file *file) {
    if (!file) return;
    ptie_h5_discard(file->h5);
    pthread_mutex_destroy(&file->lock);
    ptie_free(file);
}

void ptie_dataset_free(ptie_dataset *dataset) {
    if (!dataset) return;
    ptie_sampler_free(dataset->sampler);
    close_file(dataset->file);
    ptie_free(dataset->preset_text);
    ptie_free(dataset);
}

static ptie_status draw_from(ptie_dataset *dataset, const ptie_preset *preset, uint64_t seed,
                             uint64_t count) {
    dataset->width_px = preset->width_px;
    dataset->height_px = preset->height_px;
    dataset->seed = seed;
    dataset->count = count;
    dataset->generator = PTIE_GENERATOR;
    dataset->preset_text = ptie_strdup(preset->text);
    if (!dataset->preset_text) return PTIE_FAIL(PTIE_ENOMEM, "data set: out of memory");
    return ptie_sampler_create(&dataset->sampler, preset);
}

ptie_status ptie_dataset_draw(ptie_dataset **out, const ptie_preset *preset, uint64_t seed,
                              uint64_t count) {
    *out = NULL;
    ptie_dataset *dataset;
    PTIE_TRY(ptie_alloc_status(&dataset, 1, sizeof *dataset, "data set"));
    ptie_status status = draw_from(dataset, preset, seed, count);
    if (status == PTIE_OK)
        *out = dataset;
    else
        ptie_dataset_free(dataset);
    return status;
}

/* Checks /clean and takes the data set's shape from it. */
static ptie_status read_shape(ptie_dataset *dataset, const char *path) {
    int32_t rank;
    uint64_t dims[4];
    PTIE_TRY(ptie_h5_shape(dataset->file->h5, "/clean", &rank, dims));
    if (rank != 3)
        return PTIE_FAIL(PTIE_EFORMAT, "%s: /clean: expected 3 dimensions [N, H, W], found %d",
                         path, rank);
    if (dims[0] < 1 || dims[1] < 1 || dims[1] > MAX_SIDE || dims[2] < 1 || dims[2] > MAX_SIDE)
        return PTIE_FAIL(PTIE_EFORMAT,
                         "%s: /clean: expected maps of 1..%d pixels, found [%llu, %llu, %llu]",
                         path, MAX_SIDE, (unsigned long long)dims[0], (unsigned long long)dims[1],
                         (unsigned long long)dims[2]);
    dataset->count = dims[0];
    dataset->height_px = (int32_t)dims[1];
    dataset->width_px = (int32_t)dims[2];
    return PTIE_OK;
}

static ptie_status expect_shape(const ptie_dataset *dataset, const char *path, const char *name,
                                int32_t expected_rank) {
    const uint64_t expected[3] = {dataset->count, (uint64_t)dataset->height_px,
                                  (uint64_t)dataset->width_px};
    int32_t rank;
    uint64_t dims[4];
    PTIE_TRY(ptie_h5_shape(dataset->file->h5, name, &rank, dims));
    bool same = rank == expected_rank;
    for (int32_t i = 0; same && i < rank; i++) same = dims[i] == expected[i];
    if (same) return PTIE_OK;
    return PTIE_FAIL(PTIE_EFORMAT,
                     "%s: %s: shape does not fit /clean (expected %d dimensions, %llu samples)",
                     path, name, expected_rank, (unsigned long long)dataset->count);
}

static ptie_status read_attributes(ptie_dataset *dataset, const char *path) {
    int64_t seed, count;
    PTIE_TRY(ptie_h5_get_text(dataset->file->h5, "/", "preset", &dataset->preset_text));
    PTIE_TRY(ptie_h5_get_integer(dataset->file->h5, "/", "seed", &seed));
    PTIE_TRY(ptie_h5_get_integer(dataset->file->h5, "/", "count", &count));
    if (count < 0 || (uint64_t)count != dataset->count)
        return PTIE_FAIL(PTIE_EFORMAT,
                         "%s: attribute count does not fit /clean (expected %llu, found %lld)",
                         path, (unsigned long long)dataset->count, (long long)count);
    dataset->seed = (uint64_t)seed;
    if (ptie_h5_get_integer(dataset->file->h5, "/", "generator", &dataset->generator) != PTIE_OK)
        dataset->generator = 0;
    return PTIE_OK;
}

static ptie_status load_from(ptie_dataset *dataset, const char *path) {
    PTIE_TRY(open_file(&dataset->file, path));
    PTIE_TRY(read_shape(dataset, path));
    PTIE_TRY(expect_shape(dataset, path, "/noisy", 3));
    for (int i = 0; i < PTIE_INFO_COLUMNS; i++)
        PTIE_TRY(expect_shape(dataset, path, ptie_info_columns[i].path, 1));
    return read_attributes(dataset, path);
}

ptie_status ptie_dataset_load(ptie_dataset **out, const char *path) {
    *out = NULL;
    ptie_dataset *dataset;
    PTIE_TRY(ptie_alloc_status(&dataset, 1, sizeof *dataset, "data set"));
    ptie_status status = load_from(dataset, path);
    if (status == PTIE_OK)
        *out = dataset;
    else
        ptie_dataset_free(dataset);
    return status;
}

void ptie_dataset_size(const ptie_dataset *dataset, int32_t *width_px, int32_t *height_px) {
    *width_px = dataset->width_px;
    *height_px = dataset->height_px;
}

uint64_t ptie_dataset_count(const ptie_dataset *dataset, ptie_split split) {
    return ptie_split_span(dataset->count, split).count;
}

size_t ptie_dataset_scratch(const ptie_dataset *dataset) {
    return dataset->sampler ? ptie_sampler_scratch(dataset->sampler) : 0;
}

static ptie_status read_row(ptie_h5 *h5, uint64_t row, float *clean, float *noisy,
                            ptie_sample_info *info) {
    PTIE_TRY(ptie_h5_read(h5, "/clean", PTIE_H5_F32, row, 1, clean));
    PTIE_TRY(ptie_h5_read(h5, "/noisy", PTIE_H5_F32, row, 1, noisy));
    for (int i = 0; info && i < PTIE_INFO_COLUMNS; i++) {
        const ptie_info_column *column = &ptie_info_columns[i];
        PTIE_TRY(
            ptie_h5_read(h5, column->path, column->type, row, 1, (char *)info + column->offset));
    }
    return PTIE_OK;
}

ptie_status ptie_dataset_fetch(const ptie_dataset *dataset, ptie_split split, uint64_t index,
                               float *clean, float *noisy, ptie_sample_info *info, void *scratch) {
    const ptie_span span = ptie_split_span(dataset->count, split);
    const uint64_t sample = span.first + index;
    assert(index < span.count);
    if (dataset->sampler)
        return ptie_sampler_draw(dataset->sampler, dataset->seed, sample, clean, noisy, info,
                                 scratch);
    pthread_mutex_lock(&dataset->file->lock);
    ptie_status status = read_row(dataset->file->h5, sample, clean, noisy, info);
    pthread_mutex_unlock(&dataset->file->lock);
    return status;
}
