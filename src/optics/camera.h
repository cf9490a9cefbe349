/* SPDX-License-Identifier: BSD-3-Clause */
/* The camera inside the library: contracts of <ptie/camera.h>, arguments already checked. */
#ifndef PTIE_OPTICS_CAMERA_H
#define PTIE_OPTICS_CAMERA_H

#include <ptie/camera.h>

#include "base/status.h"
#include "optics/displace.h"

/* What a sensor makes of the planes, pixel by pixel: electrons = plus I+ + minus I-, counts begin at black. */
typedef struct ptie_sensor {
    float *plus, *minus; /* electrons at intensity 1; NULL: does not see this plane */
    float *black;        /* counts */
} ptie_sensor;

enum { PTIE_MOST_SENSORS = 2 };

struct ptie_camera {
    ptie_camera_params params;
    int32_t width_px, height_px, sensors;
    double pixel_m;
    uint64_t seed;
    ptie_displacer *minus; /* NULL: lies where the plus plane lies */
    ptie_sensor sensor[PTIE_MOST_SENSORS];
};

ptie_status ptie_camera_check(const ptie_camera_params *params, const char *where);
ptie_status ptie_camera_plan(ptie_camera **out, const ptie_camera_params *params, int32_t width_px,
                             int32_t height_px, double pixel_m, uint64_t seed);
size_t ptie_camera_scratch(const ptie_camera *camera);
void ptie_camera_illuminate(const ptie_camera *camera, float *i_zero);
/* Puts a calibration target into the light at the object: dots in random places, without phase (C1). */
void ptie_camera_target(const ptie_camera *camera, float *i_zero);
void ptie_camera_capture(const ptie_camera *camera, float *const *counts, const float *plus,
                         const float *minus, ptie_exposure exposure, int64_t frame, void *scratch);

/* Polariser over the pixel (x, y): 0..3, row by row. */
static inline int ptie_camera_channel(const ptie_camera_params *params, int32_t x, int32_t y) {
    return 2 * ((y + params->roi_y_px) & 1) + ((x + params->roi_x_px) & 1);
}

/* Share of light of this polarisation that a channel's polariser passes (C4). */
double ptie_camera_passed(const ptie_camera_params *params, int channel, double polarisation_rad);

/* Electrons to counts with noise, in place (C6, C7).  `sample` names the draw. */
typedef struct ptie_noise_source {
    uint64_t seed, sample;
    float read_noise, counts_per_electron, last_count;
} ptie_noise_source;
void ptie_sensor_digitise(const ptie_noise_source *source, float *image, const float *black, size_t count);

/* A Poisson number of this mean that has the same rank as z has among standard normals (C6). */
float ptie_poisson(float mean, float z);

#endif
