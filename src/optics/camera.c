/* SPDX-License-Identifier: BSD-3-Clause */
/* Cameras: what is fixed for a recording (polarisers, fringes, dust, unequal pixels, the place of the minus plane),
   and the exposure of one frame.  docs/math.md (C1)-(C5). */
#include "optics/camera.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "base/clones.h"
#include "base/memory.h"
#include "base/random.h"

#define PI 3.14159265358979323846

#define TARGET_DOTS 80

/* Draws of the fixed patterns, one per purpose. */
enum { DRAW_FRINGES = 0, DRAW_DUST = 2, DRAW_GAIN = 4, DRAW_OFFSET = 6, DRAW_TARGET = 8 }; /* + plane or sensor */

void ptie_camera_params_init(ptie_camera_params *params) {
    *params = (ptie_camera_params){
        .struct_size = sizeof *params,
        .bits = 12,
        .full_well = 40e3,
        .read_noise = 20,
        .black = 64,
        .exposure = 0.5,
        .dust_depth = 0.1,
        .angle_deg = {90, 45, 135, 0},
        .minus_rad = PI / 2,
        .extinction = (double)INFINITY,
        .gain = {1, 1, 1, 1},
        .minus_gain = 1,
        .minus_magnification = 1,
    };
}

/* Malus' law with what a blocking polariser lets through (C4). */
double ptie_camera_passed(const ptie_camera_params *p, int channel, double polarisation_rad) {
    const double cosine = cos(p->angle_deg[channel] * PI / 180 - polarisation_rad);
    return cosine * cosine + (1 - cosine * cosine) / p->extinction;
}

/* Electrons of one plane on one sensor at intensity 1, by channel; all channels alike where there is no mosaic. */
static void channel_responses(const ptie_camera_params *p, double plane_rad, double plane_gain,
                              float response[4]) {
    for (int c = 0; c < 4; c++) {
        const double pass = p->layout == PTIE_CAMERA_MOSAIC ? p->gain[c] * ptie_camera_passed(p, c, plane_rad) : 1;
        response[c] = (float)(p->full_well * p->exposure * plane_gain * pass);
    }
}

static void fill_responses(const ptie_camera *camera, float *map, double plane_rad, double plane_gain) {
    float response[4];
    channel_responses(&camera->params, plane_rad, plane_gain, response);
    for (int32_t y = 0; y < camera->height_px; y++)
        for (int32_t x = 0; x < camera->width_px; x++)
            *map++ = response[ptie_camera_channel(&camera->params, x, y)];
}

/* Two plates on the way of a plane each make straight fringes of 12 to 60 pixels (C2). */
static void add_fringes(const ptie_camera *camera, float *map, uint64_t plane) {
    ptie_random random;
    ptie_random_init(&random, camera->seed, PTIE_STREAM_PATTERN, DRAW_FRINGES + plane);
    for (int plate = 0; plate < 2; plate++) {
        const double wave = 2 * PI / ptie_random_log_uniform(&random, 12, 60),
                     heading = ptie_random_uniform(&random, 0, 2 * PI),
                     start = ptie_random_uniform(&random, 0, 2 * PI);
        float *pixel = map;
        for (int32_t y = 0; y < camera->height_px; y++)
            for (int32_t x = 0; x < camera->width_px; x++)
                *pixel++ *= (float)(1 + camera->params.fringes / 2 *
                                            cos(wave * (x * cos(heading) + y * sin(heading)) + start));
    }
}

typedef struct speckle {
    int32_t count;
    double low, high, depth; /* range of the radii, px; light taken away in the middle */
} speckle;

static void add_specks(const ptie_camera *camera, float *map, const speckle *specks, uint64_t draw) {
    const int32_t w = camera->width_px, h = camera->height_px;
    ptie_random random;
    ptie_random_init(&random, camera->seed, PTIE_STREAM_PATTERN, draw);
    for (int32_t speck = 0; speck < specks->count; speck++) {
        const double x0 = ptie_random_uniform(&random, 0, w), y0 = ptie_random_uniform(&random, 0, h),
                     radius = ptie_random_uniform(&random, specks->low, specks->high), reach = 4 * radius;
        for (int32_t y = (int32_t)fmax(0, y0 - reach); y < fmin(h, y0 + reach); y++)
            for (int32_t x = (int32_t)fmax(0, x0 - reach); x < fmin(w, x0 + reach); x++) {
                const double r2 = ((x - x0) * (x - x0) + (y - y0) * (y - y0)) / (radius * radius);
                map[(size_t)y * (size_t)w + (size_t)x] *= (float)(1 - specks->depth * exp(-r2));
            }
    }
}

/* Gaussian specks of 1.5 to 6 pixels (C5). */
static void add_dust(const ptie_camera *camera, float *map, uint64_t sensor) {
    add_specks(camera, map, &(speckle){camera->params.dust, 1.5, 6, camera->params.dust_depth}, DRAW_DUST + sensor);
}

/* map = map * (1 + rms z) or map + rms z, z normal by pixel. */
static void add_unequal_pixels(const ptie_camera *camera, float *map, double rms, uint64_t draw, bool multiply) {
    enum { BLOCK = 256 }; /* a multiple of 4: the same numbers as one long draw */
    const size_t pixels = (size_t)camera->width_px * (size_t)camera->height_px;
    float normal[BLOCK];
    ptie_random random;
    ptie_random_init(&random, camera->seed, PTIE_STREAM_PATTERN, draw);
    for (size_t first = 0; first < pixels; first += BLOCK) {
        const size_t count = pixels - first < BLOCK ? pixels - first : BLOCK;
        ptie_random_normals(&random, normal, count);
        for (size_t i = 0; i < count; i++)
            map[first + i] = multiply ? map[first + i] * fmaxf(0, 1 + (float)rms * normal[i])
                                      : map[first + i] + (float)rms * normal[i];
    }
}

/* Everything between one plane's intensity and the electrons of one sensor. */
static ptie_status make_response(const ptie_camera *camera, float **out, uint64_t sensor, uint64_t plane) {
    const ptie_camera_params *p = &camera->params;
    const size_t pixels = (size_t)camera->width_px * (size_t)camera->height_px;
    PTIE_TRY(ptie_alloc_status(out, pixels, sizeof **out, "camera"));
    fill_responses(camera, *out, plane == 0 ? p->plus_rad : p->minus_rad, plane == 0 ? 1 : p->minus_gain);
    if (p->fringes > 0) add_fringes(camera, *out, plane);
    add_dust(camera, *out, sensor);
    if (p->pixel_gain > 0) add_unequal_pixels(camera, *out, p->pixel_gain, DRAW_GAIN + sensor, true);
    return PTIE_OK;
}

static ptie_status make_black(const ptie_camera *camera, float **out, uint64_t sensor) {
    const ptie_camera_params *p = &camera->params;
    const size_t pixels = (size_t)camera->width_px * (size_t)camera->height_px;
    PTIE_TRY(ptie_alloc_status(out, pixels, sizeof **out, "camera"));
    for (size_t i = 0; i < pixels; i++) (*out)[i] = (float)p->black;
    if (p->pixel_offset > 0) add_unequal_pixels(camera, *out, p->pixel_offset, DRAW_OFFSET + sensor, false);
    return PTIE_OK;
}

/* Separate sensors see a plane each, a mosaic both. */
static ptie_status make_sensor(ptie_camera *camera, uint64_t sensor) {
    const bool both = camera->params.layout == PTIE_CAMERA_MOSAIC;
    ptie_sensor *s = &camera->sensor[sensor];
    if (both || sensor == 0) PTIE_TRY(make_response(camera, &s->plus, sensor, 0));
    if (both || sensor == 1) PTIE_TRY(make_response(camera, &s->minus, sensor, 1));
    return make_black(camera, &s->black, sensor);
}

static ptie_status prepare(ptie_camera *camera) {
    const ptie_camera_params *p = &camera->params;
    const ptie_similarity minus = {p->minus_shift_x_px, p->minus_shift_y_px, p->minus_magnification,
                                  p->minus_rotation_rad};
    if (minus.shift_x_px != 0 || minus.shift_y_px != 0 || minus.magnification != 1 || minus.rotation_rad != 0)
        PTIE_TRY(ptie_displacer_create(&camera->minus, camera->width_px, camera->height_px, &minus));
    for (int32_t s = 0; s < camera->sensors; s++) PTIE_TRY(make_sensor(camera, (uint64_t)s));
    return PTIE_OK;
}

ptie_status ptie_camera_plan(ptie_camera **out, const ptie_camera_params *params, int32_t width_px,
                             int32_t height_px, double pixel_m, uint64_t seed) {
    ptie_camera *camera;
    *out = NULL;
    PTIE_TRY(ptie_alloc_status(&camera, 1, sizeof *camera, "camera"));
    camera->params = *params;
    camera->width_px = width_px, camera->height_px = height_px;
    camera->pixel_m = pixel_m;
    camera->seed = seed;
    camera->sensors = params->layout == PTIE_CAMERA_MOSAIC ? 1 : 2;
    ptie_status status = prepare(camera);
    if (status != PTIE_OK) {
        ptie_camera_free(camera);
        return status;
    }
    *out = camera;
    return PTIE_OK;
}

void ptie_camera_free(ptie_camera *camera) {
    if (!camera) return;
    ptie_displacer_free(camera->minus);
    for (int32_t s = 0; s < PTIE_MOST_SENSORS; s++) {
        ptie_free(camera->sensor[s].plus);
        ptie_free(camera->sensor[s].minus);
        ptie_free(camera->sensor[s].black);
    }
    ptie_free(camera);
}

void ptie_camera_illuminate(const ptie_camera *camera, float *i_zero) {
    const ptie_camera_params *p = &camera->params;
    const double cx = (camera->width_px - 1) / 2.0, cy = (camera->height_px - 1) / 2.0;
    for (int32_t y = 0; y < camera->height_px; y++)
        for (int32_t x = 0; x < camera->width_px; x++) {
            const double dx = (x - cx) * camera->pixel_m, dy = (y - cy) * camera->pixel_m;
            const double beam = p->beam_m > 0 ? exp(-2 * (dx * dx + dy * dy) / (p->beam_m * p->beam_m)) : 1;
            const bool nozzle = (x + 0.5) * camera->pixel_m < p->nozzle_length_m && 2 * fabs(dy) < p->nozzle_width_m;
            *i_zero++ = nozzle ? 0 : (float)beam;
        }
}

void ptie_camera_target(const ptie_camera *camera, float *i_zero) {
    const speckle dots = {TARGET_DOTS, 6, 14, 0.7};
    add_specks(camera, i_zero, &dots, DRAW_TARGET);
}

size_t ptie_camera_scratch(const ptie_camera *camera) {
    const size_t pixels = (size_t)camera->width_px * (size_t)camera->height_px;
    ptie_slicer slicer = {0};
    ptie_slice(&slicer, camera->minus ? pixels : 0, sizeof(float));
    return slicer.used;
}

PTIE_CLONES static void add_plane(float *electrons, const float *response, const float *plane, float power,
                                  size_t count) {
    for (size_t i = 0; i < count; i++) electrons[i] += power * response[i] * plane[i];
}

/* The light's power in a plane at this frame (C2). */
static float power_of(const ptie_camera *camera, uint64_t sample, int plane) {
    ptie_random random;
    float normal[2];
    if (camera->params.flicker <= 0) return 1;
    ptie_random_init(&random, camera->seed, PTIE_STREAM_FLICKER, sample);
    ptie_random_normals(&random, normal, 2);
    return fmaxf(0, 1 + (float)camera->params.flicker * normal[plane]);
}

/* Electrons of a sensor before noise. */
static void collect(const ptie_camera *camera, const ptie_sensor *sensor, float *electrons, const float *plus,
                    const float *minus, uint64_t sample) {
    const size_t pixels = (size_t)camera->width_px * (size_t)camera->height_px;
    memset(electrons, 0, pixels * sizeof *electrons);
    if (plus && sensor->plus) add_plane(electrons, sensor->plus, plus, power_of(camera, sample, 0), pixels);
    if (minus && sensor->minus) add_plane(electrons, sensor->minus, minus, power_of(camera, sample, 1), pixels);
}

void ptie_camera_capture(const ptie_camera *camera, float *const *counts, const float *plus, const float *minus,
                         ptie_exposure exposure, int64_t frame, void *scratch) {
    const ptie_camera_params *p = &camera->params;
    const size_t pixels = (size_t)camera->width_px * (size_t)camera->height_px;
    const double last = ldexp(1, p->bits) - 1;
    const uint64_t sample = (uint64_t)exposure << 56 | (uint64_t)frame;
    assert(frame >= 0 && frame < INT64_C(1) << 48);
    if (exposure == PTIE_EXPOSE_DARK) plus = minus = NULL;
    if (minus && camera->minus) {
        ptie_displacer_run(camera->minus, scratch, minus);
        minus = scratch;
    }
    for (int32_t s = 0; s < camera->sensors; s++) {
        const ptie_noise_source source = {camera->seed, sample | (uint64_t)s << 48, (float)p->read_noise,
                                          (float)((last - p->black) / p->full_well), (float)last};
        collect(camera, &camera->sensor[s], counts[s], plus, minus, sample);
        ptie_sensor_digitise(&source, counts[s], camera->sensor[s].black, pixels);
    }
}
