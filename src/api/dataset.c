/* SPDX-License-Identifier: BSD-3-Clause */
/* <ptie/dataset.h>: arguments checked, then inward. */
#include <ptie/dataset.h>

#include "api/context.h"
#include "api/params.h"
#include "base/memory.h"
#include "train/dataset.h"

ptie_status ptie_preset_load(ptie_preset **out, const char *name) {
    static const char where[] = "ptie_preset_load";
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    *out = NULL;
    PTIE_TRY(ptie_check_pointer(name, where, "name"));
    return ptie_preset_read(out, name);
}

ptie_status ptie_preset_sample(const ptie_preset *preset, uint64_t seed, uint64_t index,
                               float *clean, float *noisy, ptie_sample_info *info) {
    static const char where[] = "ptie_preset_sample";
    PTIE_TRY(ptie_check_pointer(preset, where, "preset"));
    PTIE_TRY(ptie_check_pointer(clean, where, "clean"));
    PTIE_TRY(ptie_check_pointer(noisy, where, "noisy"));
    ptie_sampler *sampler;
    void *scratch = NULL;
    PTIE_TRY(ptie_sampler_create(&sampler, preset));
    ptie_status status = ptie_alloc_status(&scratch, ptie_sampler_scratch(sampler), 1, where);
    if (status == PTIE_OK)
        status = ptie_sampler_draw(sampler, seed, index, clean, noisy, info, scratch);
    ptie_free(scratch);
    ptie_sampler_free(sampler);
    return status;
}

/* Both are attributes of the file, which are signed. */
static ptie_status check_draw(uint64_t seed, uint64_t count, const char *where) {
    if (seed > INT64_MAX)
        return PTIE_FAIL(PTIE_EINVAL,
                         "%s: seed is out of range (expected at most 2^63 - 1, found %llu)", where,
                         (unsigned long long)seed);
    if (count < 1 || count > INT32_MAX)
        return PTIE_FAIL(PTIE_EINVAL, "%s: count is out of range (expected 1..%d, found %llu)",
                         where, INT32_MAX, (unsigned long long)count);
    return PTIE_OK;
}

ptie_status ptie_dataset_write(ptie_ctx *ctx, const char *path, const ptie_preset *preset,
                               uint64_t seed, uint64_t count, bool overwrite,
                               ptie_progress progress) {
    static const char where[] = "ptie_dataset_write";
    PTIE_TRY(ptie_check_pointer(ctx, where, "ctx"));
    PTIE_TRY(ptie_check_pointer(path, where, "path"));
    PTIE_TRY(ptie_check_pointer(preset, where, "preset"));
    PTIE_TRY(check_draw(seed, count, where));
    return ptie_dataset_generate(ctx->engine.pool, path, preset, seed, count, overwrite, progress);
}

ptie_status ptie_dataset_open(ptie_dataset **out, const char *path) {
    static const char where[] = "ptie_dataset_open";
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    *out = NULL;
    PTIE_TRY(ptie_check_pointer(path, where, "path"));
    return ptie_dataset_load(out, path);
}

ptie_status ptie_dataset_from_preset(ptie_dataset **out, const ptie_preset *preset, uint64_t seed,
                                     uint64_t count) {
    static const char where[] = "ptie_dataset_from_preset";
    PTIE_TRY(ptie_check_pointer(out, where, "out"));
    *out = NULL;
    PTIE_TRY(ptie_check_pointer(preset, where, "preset"));
    PTIE_TRY(check_draw(seed, count, where));
    return ptie_dataset_draw(out, preset, seed, count);
}

ptie_status ptie_dataset_read(const ptie_dataset *dataset, ptie_split split, uint64_t index,
                              float *clean, float *noisy, ptie_sample_info *info) {
    static const char where[] = "ptie_dataset_read";
    PTIE_TRY(ptie_check_pointer(dataset, where, "dataset"));
    PTIE_TRY(ptie_check_pointer(clean, where, "clean"));
    PTIE_TRY(ptie_check_pointer(noisy, where, "noisy"));
    PTIE_TRY(ptie_check_integer(split, PTIE_TRAIN, PTIE_ALL, where, "split"));
    const uint64_t count = ptie_dataset_count(dataset, split);
    if (index >= count)
        return PTIE_FAIL(PTIE_EINVAL, "%s: index is out of range (expected below %llu, found %llu)",
                         where, (unsigned long long)count, (unsigned long long)index);
    void *scratch;
    PTIE_TRY(ptie_alloc_status(&scratch, ptie_dataset_scratch(dataset), 1, where));
    ptie_status status = ptie_dataset_fetch(dataset, split, index, clean, noisy, info, scratch);
    ptie_free(scratch);
    return status;
}
