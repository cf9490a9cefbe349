/* SPDX-License-Identifier: BSD-3-Clause */
#include "flow/scene.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

static int32_t smaller(int32_t a, int32_t b) {
    return a < b ? a : b;
}

static double heading_draw(ptie_random *random, ptie_heading heading) {
    double tilt = 8.0 * PI / 180 * ptie_random_normal(random);
    double choice = ptie_random_uniform(random, 0, 1), any = ptie_random_uniform(random, -PI, PI);
    bool back = ptie_chance(random, 0.5);
    if (heading == PTIE_HEADING_ANY || choice < 0.08) return any;
    bool upright = heading == PTIE_HEADING_UP ? choice < 0.8 : choice < 0.2;
    if (upright) return (heading == PTIE_HEADING_UP || back ? -PI / 2 : PI / 2) + tilt;
    return (back ? PI : 0) + tilt;
}

ptie_axes ptie_axes_draw(const ptie_scene *scene, ptie_random *random, ptie_heading heading,
                         double origin_low, double origin_high, double across) {
    ptie_random common;
    if (scene->alignment) {
        ptie_random_init(&common, scene->alignment, PTIE_STREAM_FLOW, 0);
        random = &common;
    }
    double angle = heading_draw(random, heading);
    double place = ptie_random_uniform(random, origin_low, origin_high);
    double aside = ptie_random_uniform(random, -across, across);
    double mirror = ptie_chance(random, 0.5) ? 1 : -1;
    double c = cos(angle), s = sin(angle), w = scene->width, h = scene->height;
    double unit_px = smaller(scene->width, scene->height);
    double along_px = fabs(c) * w + fabs(s) * h, across_px = fabs(s) * w + fabs(c) * h;
    double forward = (place - 0.5) * along_px, sideways = aside * across_px / 2;
    return (ptie_axes){
        .origin_x = (float)((w - 1) / 2 + c * forward - s * sideways),
        .origin_y = (float)((h - 1) / 2 + s * forward + c * sideways),
        .cosine = (float)c,
        .sine = (float)s,
        .mirror = (float)mirror,
        .pixel = (float)(1 / unit_px),
        .start = (float)(-place * along_px / unit_px),
        .end = (float)((1 - place) * along_px / unit_px),
    };
}

/* Flow coordinates of a point of the image, px. */
static void to_flow(const ptie_axes *axes, float column, float row, float *x, float *y) {
    float dx = (column - axes->origin_x) * axes->pixel, dy = (row - axes->origin_y) * axes->pixel;
    *x = axes->cosine * dx + axes->sine * dy;
    *y = axes->mirror * (axes->cosine * dy - axes->sine * dx);
}

void ptie_place_draw(const ptie_scene *scene, ptie_random *random, const ptie_axes *axes,
                     double share, float *x, float *y) {
    double across = ptie_random_uniform(random, 0.5 - share / 2, 0.5 + share / 2);
    double down = ptie_random_uniform(random, 0.5 - share / 2, 0.5 + share / 2);
    to_flow(axes, (float)(across * (scene->width - 1)), (float)(down * (scene->height - 1)), x, y);
}

double ptie_scene_unit_m(const ptie_scene *scene) {
    return smaller(scene->width, scene->height) * scene->pixel_m;
}

double ptie_speed_draw(const ptie_scene *scene, ptie_random *random) {
    return ptie_random_log_uniform(random, 2, 12) / ptie_scene_unit_m(scene);
}

double ptie_scene_rad(const ptie_scene *scene) {
    return 2 * PI / scene->wavelength_m * ptie_scene_unit_m(scene);
}

void ptie_paint(float *map, const ptie_scene *scene, const ptie_axes *axes, ptie_line line,
                const void *flow) {
    float step_x = axes->cosine * axes->pixel, step_y = -axes->mirror * axes->sine * axes->pixel;
    float value[PTIE_LINE], x[PTIE_LINE], y[PTIE_LINE];
    for (int32_t row = 0; row < scene->height; row++) {
        float left_x, left_y, *out = map + (size_t)row * (size_t)scene->width;
        to_flow(axes, 0, (float)row, &left_x, &left_y);
        for (int32_t first = 0; first < scene->width; first += PTIE_LINE) {
            for (int32_t i = 0; i < PTIE_LINE; i++) {
                x[i] = left_x + step_x * (float)(first + i);
                y[i] = left_y + step_y * (float)(first + i);
            }
            line(flow, value, x, y);
            memcpy(out + first, value, (size_t)smaller(PTIE_LINE, scene->width - first) * sizeof *out);
        }
    }
}

void ptie_clear(float *map, const ptie_scene *scene) {
    memset(map, 0, sizeof *map * (size_t)scene->width * (size_t)scene->height);
}

/* A point of the flow in px of the image. */
typedef struct place {
    double x, y;
} place;

static place place_of(const ptie_axes *axes, float x, float y) {
    double along = (double)(x / axes->pixel), across = (double)(axes->mirror * y / axes->pixel);
    double c = (double)axes->cosine, s = (double)axes->sine;
    return (place){(double)axes->origin_x + c * along - s * across,
                   (double)axes->origin_y + s * along + c * across};
}

void ptie_stamp(float *map, const ptie_scene *scene, const ptie_axes *axes, float x, float y,
                float reach, ptie_radial_point radial, const void *context) {
    place centre = place_of(axes, x, y);
    double radius = (double)(reach / axes->pixel);
    int32_t top = (int32_t)fmax(0, ceil(centre.y - radius));
    int32_t bottom = (int32_t)fmin(scene->height - 1, floor(centre.y + radius));
    int32_t left = (int32_t)fmax(0, ceil(centre.x - radius));
    int32_t right = (int32_t)fmin(scene->width - 1, floor(centre.x + radius));
    for (int32_t row = top; row <= bottom; row++) {
        float dy = (float)(row - centre.y) * axes->pixel,
              *line = map + (size_t)row * (size_t)scene->width;
        for (int32_t column = left; column <= right; column++) {
            float dx = (float)(column - centre.x) * axes->pixel, r = sqrtf(dx * dx + dy * dy);
            if (r < reach) line[column] += radial(context, r);
        }
    }
}

/* Quadratic form a dx^2 + 2 b dx dy + c dy^2 of a spot, in px. */
typedef struct spot_form {
    double x, y, a, b, c;
} spot_form;

static spot_form form_of(const ptie_axes *axes, const ptie_spot *spot) {
    double along = (double)(spot->along / axes->pixel);
    double across = (double)(spot->across / axes->pixel);
    double turn = (double)(axes->mirror * spot->angle);
    double flow = atan2((double)axes->sine, (double)axes->cosine) + turn;
    double c = cos(flow), s = sin(flow), p = 1 / (along * along), q = 1 / (across * across);
    place centre = place_of(axes, spot->x, spot->y);
    return (spot_form){
        .x = centre.x,
        .y = centre.y,
        .a = c * c * p + s * s * q,
        .b = c * s * (p - q),
        .c = s * s * p + c * c * q,
    };
}

void ptie_splat(float *map, const ptie_scene *scene, const ptie_axes *axes, const ptie_spot *spot) {
    const double reach = 3.5 * 3.5;
    spot_form f = form_of(axes, spot);
    double tall = sqrt(reach * f.a / (f.a * f.c - f.b * f.b)); /* half height of the ellipse */
    int32_t top = (int32_t)fmax(0, ceil(f.y - tall));
    int32_t bottom = (int32_t)fmin(scene->height - 1, floor(f.y + tall));
    double ratio_step = exp(-f.a); /* of the ratio of neighbours, from pixel to pixel */
    for (int32_t y = top; y <= bottom; y++) {
        double dy = y - f.y, middle = -f.b * dy / f.a;
        double wide = sqrt(fmax(0, middle * middle - (f.c * dy * dy - reach) / f.a));
        int32_t left = (int32_t)fmax(0, ceil(f.x + middle - wide));
        int32_t right = (int32_t)fmin(scene->width - 1, floor(f.x + middle + wide));
        if (left > right) continue;
        double dx = left - f.x;
        /* A Gaussian along a row by two products per pixel: g(x+1) = g(x) r(x), r(x+1) = r(x) q. */
        double value =
            (double)spot->height * exp(-0.5 * (f.a * dx * dx + 2 * f.b * dx * dy + f.c * dy * dy));
        double ratio = exp(-f.a * (dx + 0.5) - f.b * dy);
        float *row = map + (size_t)y * (size_t)scene->width;
        for (int32_t x = left; x <= right; x++) {
            row[x] += (float)value;
            value *= ratio;
            ratio *= ratio_step;
        }
    }
}

ptie_train ptie_train_make(double spacing, double shift, double start, double end) {
    return (ptie_train){.spacing = spacing,
                        .shift = shift,
                        .first = (int64_t)ceil((start - shift) / spacing),
                        .last = (int64_t)floor((end - shift) / spacing)};
}

double ptie_train_car(const ptie_train *train, int64_t number, uint64_t key, ptie_random *random) {
    ptie_random_init(random, key, PTIE_STREAM_TEXTURE, (uint64_t)number);
    return (double)number * train->spacing + train->shift;
}

uint64_t ptie_key_draw(ptie_random *random) {
    uint64_t high = ptie_random_u32(random);
    return high << 32 | ptie_random_u32(random);
}

bool ptie_chance(ptie_random *random, double probability) {
    return ptie_random_uniform(random, 0, 1) < probability;
}

float ptie_draw(ptie_random *random, double low, double high) {
    return (float)ptie_random_uniform(random, low, high);
}

float ptie_draw_log(ptie_random *random, double low, double high) {
    return (float)ptie_random_log_uniform(random, low, high);
}
