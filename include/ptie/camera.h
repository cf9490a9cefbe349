/* SPDX-License-Identifier: BSD-3-Clause */
/* A camera: from the intensities of the planes I+ and I- to counts.  docs/math.md (C1)-(C8), docs/formats.md.
 *
 * Light meets, in this order: an opaque nozzle and a beam profile at the object, interference fringes on the
 * way (other ones for each plane), a minus plane that lies elsewhere on the sensor, the polarisers of a
 * mosaic, dust and unequal pixels, shot noise, read noise, and a converter with black level and last count.
 * Images are row-major floats, height x width; counts are whole numbers 0 .. 2^bits - 1.
 */
#ifndef PTIE_CAMERA_H
#define PTIE_CAMERA_H

#include <ptie/context.h>

typedef enum ptie_camera_layout {
    PTIE_CAMERA_SEPARATE = 0, /* a sensor for each plane */
    PTIE_CAMERA_MOSAIC = 1    /* one sensor under a 2 x 2 mosaic of polarisers; the planes differ in polarisation */
} ptie_camera_layout;

typedef enum ptie_exposure {
    PTIE_EXPOSE_FLOW = 0,
    PTIE_EXPOSE_REFERENCE = 1, /* the planes without flow */
    PTIE_EXPOSE_DARK = 2,      /* no light */
    PTIE_EXPOSE_TARGET = 3     /* the planes of a calibration target at the object */
} ptie_exposure;

typedef struct ptie_camera_params {
    uint32_t struct_size; /* set by ptie_camera_params_init */
    /* Sensor. */
    int32_t bits;                   /* 8..16, default 12 */
    double full_well;               /* electrons from black to the last count, 1..1e9, default 40e3 */
    double read_noise;              /* electrons rms, 0..1e6, default 20 */
    double black;                   /* counts without light, 0..last count, default 64 */
    double exposure;                /* intensity 1 as a share of the range above black, 0..10, default 0.5 */
    double pixel_gain, pixel_offset;/* unequal pixels: rms of the gain (share), of the black level (counts) */
    int32_t dust;                   /* specks on the sensor, 0..1000, default 0 */
    double dust_depth;              /* light that a speck takes away in its middle, 0..1, default 0.1 */
    /* Mosaic: angles of the polarisers of a cell, row by row, in degrees. */
    ptie_camera_layout layout;
    int32_t angle_deg[4];           /* default 90 45 135 0 */
    int32_t roi_x_px, roi_y_px;     /* place of the frame's first pixel on the sensor: its parity counts */
    double plus_rad, minus_rad;     /* polarisation of the planes, default 0 and pi / 2 */
    double extinction;              /* of the polarisers: passed over blocked light, > 1; default INFINITY */
    double gain[4];                 /* of the pixels of a cell, row by row, default 1 */
    /* The minus plane against the plus plane: power, and where it lies.  A point at x of the plus plane appears
       at centre + shift + magnification R(rotation) (x - centre), R from the x towards the y axis (downwards). */
    double minus_gain;              /* 0..100, default 1 */
    double minus_shift_x_px, minus_shift_y_px; /* sensor pixels, within +-1000 */
    double minus_magnification;     /* 0.5..2, default 1 */
    double minus_rotation_rad;      /* within +-0.5 */
    /* Light. */
    double beam_m;                  /* radius at 1/e^2 of a Gaussian beam centred on the frame; 0 (default): even */
    double fringes;                 /* amplitude of the fringes, share, 0..1, default 0 */
    double flicker;                 /* rms of each plane's power from frame to frame, share, 0..1, default 0 */
    /* An opaque nozzle that enters at the middle of the left edge. */
    double nozzle_length_m, nozzle_width_m; /* 0 (default): none */
} ptie_camera_params;

PTIE_API void ptie_camera_params_init(ptie_camera_params *params);

/* params (out): the defaults and what the INI file says (docs/formats.md).  Errors: PTIE_EIO, PTIE_EFORMAT,
   PTIE_ENAME, PTIE_ENOMEM. */
PTIE_API PTIE_NODISCARD ptie_status ptie_camera_read(ptie_camera_params *params, const char *path);

typedef struct ptie_camera ptie_camera;

/* A camera whose fixed patterns (dust, fringes, pixels) are those of `seed`, for planes of width x height px of
   pixel_m at the object.  Errors: PTIE_EINVAL, PTIE_ENOMEM. */
PTIE_API PTIE_NODISCARD ptie_status ptie_camera_create(ptie_camera **out, const ptie_camera_params *params,
                                                       int32_t width_px, int32_t height_px, double pixel_m,
                                                       uint64_t seed);
PTIE_API void ptie_camera_free(ptie_camera *camera);            /* NULL is fine */
PTIE_API int32_t ptie_camera_sensors(const ptie_camera *camera);/* 1 for a mosaic, 2 for separate sensors */
PTIE_API size_t ptie_camera_scratch_bytes(const ptie_camera *camera);

/* i_zero (out): intensity at the object in focus, the beam profile and 0 behind the nozzle. */
PTIE_API PTIE_NODISCARD ptie_status ptie_camera_light(const ptie_camera *camera, float *i_zero);

/* counts (out): one image per sensor.  plus, minus: intensities on the sensor's grid, 1 = undisturbed beam; not used
   for PTIE_EXPOSE_DARK.  A pure function of (camera, planes, exposure, frame): the same bits in any order, on any
   thread.  Counts must not be one of the planes.  scratch: ptie_camera_scratch_bytes, 64-byte aligned.
   Errors: PTIE_EINVAL. */
PTIE_API PTIE_NODISCARD ptie_status ptie_camera_expose(const ptie_camera *camera, float *const *counts,
                                                       const float *plus, const float *minus,
                                                       ptie_exposure exposure, int64_t frame, void *scratch);

#endif
