/* SPDX-License-Identifier: BSD-3-Clause */
/* From sensor images to planes ready for the solver, one step per function.  docs/math.md
 * (P1)-(P14).
 *
 * In the order of a recording: dark (P1), channels (P2), mixing (P3), flat field (P4), gain (P5),
 * registration (P6); after the solver: background (P10), region without flow (P12).  Images are
 * row-major, contiguous, height x width floats.  Masks are bytes: 1 = light, 0 = opaque.  All
 * functions are pure: same input, same bits, on any thread.  Plans are const while they run; a run
 * allocates nothing.  A function without a status cannot fail; its pointers must not be NULL unless
 * said.
 */
#ifndef PTIE_PREPROCESS_H
#define PTIE_PREPROCESS_H

#include <ptie/context.h>
#include <ptie/metrics.h>

/* ---- Levels ---- */

/* image -= dark (P1). */
PTIE_API void ptie_subtract_dark(float *image, const float *dark, size_t pixels);

/* plane = sum of weight[c] * channel[c] over `count` channels (P3).  Channels of weight 0 may be
   NULL.  `plane` may be one of the channels. */
PTIE_API void ptie_mix_channels(float *plane, const float *const *channel, const double *weight,
                                int32_t count, size_t pixels);

/* Mean over the pixels of `mask` (NULL: all); NaN if there are none. */
PTIE_API double ptie_masked_mean(const float *image, const uint8_t *mask, size_t pixels);

/* gain (out) = mean of the reference / reference (P4), the mean over `mask` (NULL: all).  Where the
   reference is below `floor` (1e-6..1) of that mean, the floor stands for it: the gain is at most 1
   / floor.  Times the gain, a frame has the level it had and no structure of the light.  gain may
   be reference. Errors: PTIE_EINVAL, PTIE_ENUMERIC (not finite, or its mean is not positive). */
PTIE_API PTIE_NODISCARD ptie_status ptie_flat_gain(float *gain, const float *reference,
                                                   const uint8_t *mask, int32_t width_px,
                                                   int32_t height_px, double floor);

/* image *= gain, pixel by pixel. */
PTIE_API void ptie_apply_gain(float *image, const float *gain, size_t pixels);

/* image *= factor: with factor = target mean / ptie_masked_mean, planes of equal means (P5). */
PTIE_API void ptie_scale_image(float *image, double factor, size_t pixels);

/* ---- Channels of one sensor image ---- */

/* How the planes of a moment come to the file.  All but the first are one sensor image with several
 * channels. */
typedef enum ptie_layout {
    PTIE_LAYOUT_SEPARATE = 0,     /* nothing to split: a recording per plane */
    PTIE_LAYOUT_MOSAIC = 1,       /* 2 x 2 polarisers on the pixels; channels row-major */
    PTIE_LAYOUT_SIDE_BY_SIDE = 2, /* channels left, right */
    PTIE_LAYOUT_TOP_BOTTOM = 3,   /* channels top, bottom */
    PTIE_LAYOUT_QUADRANTS = 4     /* channels top left, top right, bottom left, bottom right */
} ptie_layout;

enum { PTIE_CHANNELS = 4 }; /* most channels of a sensor image */

/* A mosaic's channel has a quarter of the pixels, at twice the pitch; a channel's own pixels lie a
   quarter of that pitch off the cells' centres, in a direction of its own.  Every method keeps that
   size. */
typedef enum ptie_demosaic {
    PTIE_DEMOSAIC_NONE =
        0, /* as recorded: half a sensor pixel between channels, left to the registration */
    PTIE_DEMOSAIC_BILINEAR =
        1, /* moved to the cells' centres, 2 x 2 taps: fine detail fades (P2) */
    PTIE_DEMOSAIC_FOURIER =
        2 /* moved to the cells' centres by the shift theorem: exact for periodic images */
} ptie_demosaic;

typedef struct ptie_splitter_params {
    uint32_t struct_size; /* set by ptie_splitter_params_init */
    int32_t width_px,
        height_px; /* of the sensor image, 2..32768 each; an odd last column or row is not used */
    ptie_layout layout;     /* default PTIE_LAYOUT_MOSAIC */
    ptie_demosaic demosaic; /* default PTIE_DEMOSAIC_BILINEAR */
    int32_t roi_x_px,
        roi_y_px; /* where the image begins on the sensor; odd ones swap a mosaic's channels */
} ptie_splitter_params;

typedef struct ptie_splitter ptie_splitter;

PTIE_API void ptie_splitter_params_init(ptie_splitter_params *params);

/* Allocates.  Errors: PTIE_EINVAL, PTIE_ENOMEM. */
PTIE_API PTIE_NODISCARD ptie_status ptie_splitter_create(ptie_splitter **out,
                                                         const ptie_splitter_params *params);
PTIE_API void ptie_splitter_free(ptie_splitter *splitter); /* NULL is fine */
PTIE_API size_t ptie_splitter_scratch_bytes(const ptie_splitter *splitter);
/* Channels of the layout (1, 2 or 4), and the size of each. */
PTIE_API int32_t ptie_splitter_channels(const ptie_splitter *splitter, int32_t *width_px,
                                        int32_t *height_px);

/* channel[c] (out), or NULL for one that is not needed.  Errors: PTIE_EINVAL (scratch not 64-byte
 * aligned). */
PTIE_API PTIE_NODISCARD ptie_status ptie_splitter_run(const ptie_splitter *splitter,
                                                      float *const *channel, const float *image,
                                                      void *scratch);

/* ---- Registration ---- */

/* Where a plane lies on the grid of another (of I+): a point at r from the centre of the frame
   there is found in the plane at shift + magnification * R(rotation) r from the centre of its
   frame.  x to the right, y down; a positive rotation turns x towards y. */
typedef struct ptie_similarity {
    double shift_x_px, shift_y_px, magnification, rotation_rad; /* 0, 0, 1, 0: in place */
} ptie_similarity;

typedef struct ptie_resampler ptie_resampler;

/* Plans to bring a plane at `place` onto the grid, by cubic B-splines (P6).  A period of n pixels
   is reproduced to 0.01 % (n = 16), 0.12 % (n = 8), 2.8 % (n = 4) of its amplitude at worst.
   Sizes 4..32768 px, magnification 0.5..2, |rotation| <= pi.  Allocates.  Errors: PTIE_EINVAL
   (range, or the plane leaves the frame by more than its own size), PTIE_ENOMEM. */
PTIE_API PTIE_NODISCARD ptie_status ptie_resampler_create(ptie_resampler **out, int32_t width_px,
                                                          int32_t height_px, ptie_similarity place);
PTIE_API void ptie_resampler_free(ptie_resampler *resampler); /* NULL is fine */
PTIE_API size_t ptie_resampler_scratch_bytes(const ptie_resampler *resampler);

/* out: the plane on the grid; what lies beyond the plane's frame is its mirror image.  out may be
   the plane. Errors: PTIE_EINVAL (scratch not 64-byte aligned). */
PTIE_API PTIE_NODISCARD ptie_status ptie_resampler_run(const ptie_resampler *resampler, float *out,
                                                       const float *plane, void *scratch);

/* mask (out): 1 where the grid is found within the plane's frame, `margin_px` or more from its
   outermost pixels; 0 where the plane was mirrored. */
PTIE_API void ptie_resampler_inside(const ptie_resampler *resampler, uint8_t *mask,
                                    double margin_px);

typedef struct ptie_registration {
    ptie_similarity place;     /* where the moving plane lies on the grid of the fixed one */
    ptie_similarity deviation; /* standard deviation of each number, from what the planes do not
                                  have in common */
    double correlation; /* of the registered textures, -1..1; negative where one is dark and the
                           other bright */
} ptie_registration;

/* Finds where a plane lies from what both planes show of the same, unmoving light: best the mean
   of frames of a target in the field, freed of the sensor's own structure by a flat field (P4),
   which does not move with the planes (P7).  They may differ in gain, level and, as far as
   structure survives, in defocus.  Looks for rotations up to 9 degrees, magnifications 0.9..1.1,
   shifts up to a quarter of the frame.  On a texture of 4 % with 1 % of noise in each plane, 256 x
   256 px, the shift is good to 0.008 px.  mask: 1 = light of the fixed plane, NULL: all.
   Sizes 64..32768 px. Allocates.  Errors: PTIE_ENUMERIC (not finite, no texture, nothing in
   common), PTIE_EINVAL, PTIE_ENOMEM. */
PTIE_API PTIE_NODISCARD ptie_status ptie_register(ptie_registration *out, const float *fixed,
                                                  const float *moving, const uint8_t *mask,
                                                  int32_t width_px, int32_t height_px);

/* ---- Opaque regions ---- */

/* mask (out): 0 where the reference is below `below` (0..1) of its median, cleaned of specks and
   pinholes of up to 2 clean_px, and grown by margin_px in x and in y; else 1 (P8).  Both lengths
   0..1024 px.  Allocates. Errors: PTIE_EINVAL, PTIE_ENUMERIC (not finite), PTIE_ENOMEM. */
PTIE_API PTIE_NODISCARD ptie_status ptie_opaque_mask(uint8_t *mask, const float *reference,
                                                     int32_t width_px, int32_t height_px,
                                                     double below, int32_t clean_px,
                                                     int32_t margin_px);

/* Replaces pixels of mask 0 by a smooth continuation of those around them (P9); 0 if all are
 * masked. */
PTIE_API size_t ptie_fill_scratch_bytes(int32_t width_px, int32_t height_px);
PTIE_API void ptie_fill_masked(float *image, const uint8_t *mask, int32_t width_px,
                               int32_t height_px, void *scratch);

/* ---- Backgrounds ---- */

enum { PTIE_SURFACE_DEGREE = 4 }; /* the highest */

typedef struct ptie_surface_params {
    uint32_t struct_size;        /* set by ptie_surface_params_init */
    int32_t width_px, height_px; /* 4..32768 each */
    int32_t degree; /* 1: a plane (default); n = 2..4: Zernike polynomials up to radial order n */
    int32_t rounds; /* of outlier rejection, 0 (default)..50; 10 if the flow is not masked (on less
                       than half the frame) */
    double reject;  /* standard deviations beyond which a pixel is rejected, 1..100, default 3 */
} ptie_surface_params;

typedef struct ptie_surface ptie_surface;

PTIE_API void ptie_surface_params_init(ptie_surface_params *params);

/* mask (copied): 1 where there is no flow, NULL: everywhere.  Allocates.  Errors: PTIE_EINVAL
   (range; the mask leaves too little to fit), PTIE_ENOMEM. */
PTIE_API PTIE_NODISCARD ptie_status ptie_surface_create(ptie_surface **out,
                                                        const ptie_surface_params *params,
                                                        const uint8_t *mask);
PTIE_API void ptie_surface_free(ptie_surface *surface); /* NULL is fine */
PTIE_API size_t ptie_surface_scratch_bytes(const ptie_surface *surface);

/* map -= the least-squares surface through its pixels without flow (P10).
   Errors: PTIE_EINVAL (scratch), PTIE_ENUMERIC (not finite; rejection left too little: the map
   stays). */
PTIE_API PTIE_NODISCARD ptie_status ptie_surface_remove(const ptie_surface *surface, float *map,
                                                        void *scratch);

/* median (out): per pixel, of `frames` >= 1 maps that lie `stride` floats apart in the stack (P11).
   A band of rows at a time keeps the memory small: its pixels do not depend on the others.  Values
   must be finite. */
PTIE_API void ptie_temporal_median(float *median, const float *stack, int32_t frames, size_t stride,
                                   size_t pixels);

/* Subtracts the mean over `region` from the map: no flow there, so 0 (P12).
   Errors: PTIE_EINVAL (region leaves the map or is empty). */
PTIE_API PTIE_NODISCARD ptie_status ptie_pin_region(float *map, int32_t width_px, int32_t height_px,
                                                    ptie_rect region);

/* ---- Is the recording fit for it? ---- */

/* chi = pi lambda |z| / period^2 (P13): linear TIE underestimates a period by sin chi / chi, 5 % at
   chi = 0.55. At the Nyquist frequency the period is two pixels. */
PTIE_API double ptie_chi(double wavelength_m, double defocus_m, double period_m);

/* Mosaic self-check (P14): mean |TL + BR - TR - BL| over the cells, relative to the mean of the sum
   of all four. Crossed polarisers share the light, so both sums are all of it: 0.014 for a real
   sensor.  NaN without light. */
PTIE_API double ptie_mosaic_imbalance(const float *image, int32_t width_px, int32_t height_px);

/* (largest - smallest) / mean of the means of `count` planes over the mask (NULL: all). */
PTIE_API double ptie_plane_spread(const float *const *plane, int32_t count, const uint8_t *mask,
                                  size_t pixels);

/* Pixels at `level` or above. */
PTIE_API size_t ptie_count_saturated(const float *image, size_t pixels, double level);

typedef struct ptie_trend {
    double slope;     /* per step */
    double deviation; /* standard deviation of the slope, if the residuals are independent; NaN
                         below 3 values */
    double rms;       /* of the residuals */
} ptie_trend;

/* Straight line through a series, such as the level of a still region per frame: a background
   drifts if the slope is several deviations.  NaN below 2 values. */
PTIE_API ptie_trend ptie_trend_of(const double *values, size_t count);

#endif
