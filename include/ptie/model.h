/* SPDX-License-Identifier: BSD-3-Clause */
/* The denoising network: a family of U-Nets, of which the paper's (29,777 parameters) is one member,
 * and the plan that runs one on phase maps of any size.  Paper section 3.1, docs/math.md (N1)-(N8).
 *
 * A model file is safetensors with PyTorch's tensor names and layouts (docs/formats.md): it loads into
 * PyTorch with one line.  Its metadata says how to normalise.
 */
#ifndef PTIE_MODEL_H
#define PTIE_MODEL_H

#include <ptie/context.h>

#define PTIE_MAX_LEVELS 6

typedef enum ptie_output { PTIE_SIGMOID = 0, PTIE_LINEAR = 1 } ptie_output;

typedef struct ptie_model_params {
    uint32_t struct_size;           /* set by ptie_model_params_init */
    int32_t levels;                 /* resolutions, bottleneck included: 2..6, default 3 */
    int32_t width[PTIE_MAX_LEVELS]; /* channels per level, 1..512, default 8, 16, 32 */
    int32_t in_channels;            /* 1..16, default 1 */
    ptie_output output;             /* default PTIE_SIGMOID */
    double dropout;                 /* at the bottleneck while training, 0..0.9, default 0.1 */
    double bn_epsilon;              /* > 0, default 1e-3 (Keras) */
    double bn_momentum;             /* running = m * running + (1-m) * batch, default 0.99 (Keras) */
    uint64_t seed;                  /* of the initial weights (Glorot uniform, as Keras) */
} ptie_model_params;

typedef struct ptie_model ptie_model;

PTIE_API void ptie_model_params_init(ptie_model_params *params);

/* A model with fresh weights.  Errors: PTIE_EINVAL, PTIE_ENOMEM. */
PTIE_API PTIE_NODISCARD ptie_status ptie_model_create(ptie_model **out,
                                                      const ptie_model_params *params);
/* Errors: PTIE_EIO, PTIE_EFORMAT (not safetensors, or damaged), PTIE_ESIZE (tensors that do not fit the
   architecture named in the metadata), PTIE_ENOMEM. */
PTIE_API PTIE_NODISCARD ptie_status ptie_model_load(ptie_model **out, const char *path);
/* Written to a temporary name, then renamed.  Errors: PTIE_EEXIST, PTIE_EIO. */
PTIE_API PTIE_NODISCARD ptie_status ptie_model_save(const ptie_model *model, const char *path,
                                                    bool overwrite);
PTIE_API void ptie_model_free(ptie_model *model); /* NULL is fine */

PTIE_API const ptie_model_params *ptie_model_get_params(const ptie_model *model);
PTIE_API size_t ptie_model_trainable(const ptie_model *model); /* number of trainable parameters */
/* Architecture, "unet-8-16-32".  Owned by the model. */
PTIE_API const char *ptie_model_name(const ptie_model *model);
/* Free-form text that travels in the file ("ptie.trained_on", ...); NULL if the key is not there. */
PTIE_API const char *ptie_model_note(const ptie_model *model, const char *key);
PTIE_API PTIE_NODISCARD ptie_status ptie_model_set_note(ptie_model *model, const char *key,
                                                        const char *value);

typedef struct ptie_denoiser ptie_denoiser;

typedef struct ptie_denoiser_params {
    uint32_t struct_size; /* set by ptie_denoiser_params_init */
    bool fast; /* with AVX512-FP16 in half precision, docs/math.md (N10): less exact, 1.7 times as fast; in
                  [0, 1] the shipped model's estimate differs by 2e-3 rms and by less than 0.1, its PSNR by
                  0.002 dB on average.  Elsewhere it changes nothing. */
    bool all_threads; /* a run takes all threads of the context for its one frame: least time to a result.
                         The context must outlive the denoiser and do nothing else meanwhile. */
} ptie_denoiser_params;

PTIE_API void ptie_denoiser_params_init(ptie_denoiser_params *params); /* neither */

/* Prepares a model for frames of one size: folds BatchNorm, plans memory.  Any size from 1 x 1; frames
   are padded by reflection to a multiple of 2^(levels-1) and cropped.  Scratch grows with a frame's width,
   hardly with its height.  params NULL: the defaults.  Keeps no reference to the model.
   Errors: PTIE_EINVAL, PTIE_ESIZE (model wants other inputs), PTIE_ENOMEM. */
PTIE_API PTIE_NODISCARD ptie_status ptie_denoiser_create(ptie_denoiser **out, ptie_ctx *ctx,
                                                         const ptie_model *model, int32_t width_px,
                                                         int32_t height_px,
                                                         const ptie_denoiser_params *params);
PTIE_API void ptie_denoiser_free(ptie_denoiser *denoiser); /* NULL is fine */
PTIE_API size_t ptie_denoiser_scratch_bytes(const ptie_denoiser *denoiser);

/* The network as the paper uses it: noisy in [0, 1] in, clean estimate in [0, 1] out.  Single-threaded
   (run frames in parallel), unless the denoiser has all threads; the result is the same, bit for bit.
   `clean` may be `noisy`.  No allocation; const plan, one scratch per concurrent run.
   Errors: PTIE_ENUMERIC (input not finite). */
PTIE_API PTIE_NODISCARD ptie_status ptie_denoiser_run(const ptie_denoiser *denoiser, float *clean,
                                                      const float *noisy, void *scratch);

/* The same in rad: normalises the frame min-max, runs the network, and returns to rad with the gain and
   offset that fit the network's map to the measured phase (docs/math.md N8).  `polarity` +1: the flow
   has positive phase; -1: negative (hot gas), the map is turned over before and after; 0: chosen per
   frame by the sign of its skewness.  The mean is the one of the flow-free background = 0. */
PTIE_API PTIE_NODISCARD ptie_status ptie_denoiser_run_rad(const ptie_denoiser *denoiser,
                                                          float *clean_rad, const float *noisy_rad,
                                                          int32_t polarity, void *scratch);

#endif
