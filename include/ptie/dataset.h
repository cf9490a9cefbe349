/* SPDX-License-Identifier: BSD-3-Clause */
/* Presets (named data distributions), samples drawn from them, and data set files.  Paper section 2.4.
 *
 * A sample is one pair: clean phase, and the phase that the optics, the noise and the inverse Laplacian
 * make of it.  Both are min-max normalised to [0, 1] as in the paper; what was subtracted and divided
 * stays with the sample, so that rad = offset + scale * value.  Zero of the clean phase is the undisturbed
 * gas (parametric family: the shapes' own 0); the noisy phase has zero mean, because its mean is not measured.
 */
#ifndef PTIE_DATASET_H
#define PTIE_DATASET_H

#include <ptie/context.h>

/* Raised with every change of the generator that changes samples by more than rounding: the same preset, seed,
   index and generator are the same sample.  Kept in data set files and models. */
#define PTIE_GENERATOR 1

typedef struct ptie_preset ptie_preset;

/* `name`: a built-in preset ("paper", "realistic") or the path of an INI file.  Errors: PTIE_ENAME
   (unknown preset, section or key: the message names the nearest valid one), PTIE_EFORMAT (line and
   value), PTIE_EIO, PTIE_ENOMEM.  A preset is const and may be shared by threads. */
PTIE_API PTIE_NODISCARD ptie_status ptie_preset_load(ptie_preset **out, const char *name);
PTIE_API void ptie_preset_free(ptie_preset *preset); /* NULL is fine */

/* Names of the built-in presets; NULL after the last. */
PTIE_API const char *ptie_preset_name(int32_t which);

/* The preset as the text of an INI file that ptie_preset_load reads back.  Owned by the preset. */
PTIE_API const char *ptie_preset_text(const ptie_preset *preset);

/* Sample size in pixels. */
PTIE_API void ptie_preset_size(const ptie_preset *preset, int32_t *width_px, int32_t *height_px);

typedef struct ptie_sample_info {
    float clean_offset_rad, clean_scale_rad; /* clean phase = offset + scale * clean */
    float noisy_offset_rad, noisy_scale_rad;
    float sigma;                             /* relative intensity noise that was added */
    uint32_t morphologies;                   /* bit i set: ptie_morphology_name(i) takes part */
} ptie_sample_info;

/* Draws sample `index` of `seed`.  clean, noisy (out): height x width in [0, 1]; `info` may be NULL.
   A pure function of (preset, seed, index).  Allocates scratch.  Thread-safe.
   Errors: PTIE_ENOMEM. */
PTIE_API PTIE_NODISCARD ptie_status ptie_preset_sample(const ptie_preset *preset, uint64_t seed,
                                                       uint64_t index, float *clean, float *noisy,
                                                       ptie_sample_info *info);

/* Draws samples 0..count-1 on the context's threads and writes an HDF5 file: /clean and /noisy
   [N, H, W] float32, one dataset per field of ptie_sample_info [N], attributes preset (text), seed
   (at most 2^63 - 1), count, generator (PTIE_GENERATOR), version, split ("train 0:800", ...).  The bytes do not depend on the thread
   count; memory does not depend on count.  The file appears under `path`
   only when complete.  Errors: PTIE_EINVAL, PTIE_EEXIST, PTIE_EIO, PTIE_ENOMEM, PTIE_ECANCELLED. */
PTIE_API PTIE_NODISCARD ptie_status ptie_dataset_write(ptie_ctx *ctx, const char *path,
                                                       const ptie_preset *preset, uint64_t seed,
                                                       uint64_t count, bool overwrite,
                                                       ptie_progress progress);

/* Samples to learn from and to be judged on: a data set file, or a preset drawn on the fly. */
typedef struct ptie_dataset ptie_dataset;

typedef enum ptie_split { PTIE_TRAIN = 0, PTIE_VALIDATION = 1, PTIE_TEST = 2, PTIE_ALL = 3 } ptie_split;

/* Errors: PTIE_EIO, PTIE_EFORMAT, PTIE_ENOMEM. */
PTIE_API PTIE_NODISCARD ptie_status ptie_dataset_open(ptie_dataset **out, const char *path);
/* `count` samples of (preset, seed), drawn when read.  The preset must outlive the data set. */
PTIE_API PTIE_NODISCARD ptie_status ptie_dataset_from_preset(ptie_dataset **out,
                                                             const ptie_preset *preset, uint64_t seed,
                                                             uint64_t count);
PTIE_API void ptie_dataset_free(ptie_dataset *dataset); /* NULL is fine */
PTIE_API void ptie_dataset_size(const ptie_dataset *dataset, int32_t *width_px, int32_t *height_px);
/* Number of samples in a split, by index in this order: validation and test get a tenth each, rounded down but
   at least 1 (0 below 3 samples), training the rest.  For 25,000: 20,000/2,500/2,500. */
PTIE_API uint64_t ptie_dataset_count(const ptie_dataset *dataset, ptie_split split);
/* Reads sample `index` (0..count-1) of a split.  Thread-safe (file access is serialised). */
PTIE_API PTIE_NODISCARD ptie_status ptie_dataset_read(const ptie_dataset *dataset, ptie_split split,
                                                      uint64_t index, float *clean, float *noisy,
                                                      ptie_sample_info *info);

#endif
