/* SPDX-License-Identifier: BSD-3-Clause */
/* Registration estimated: Gauss-Newton on textures, from the coarsest scale to the pixels.
 * docs/math.md (P7). */
#include <math.h>
#include <string.h>

#include "base/image.h"
#include "prep/cholesky.h"
#include "prep/prep.h"
#include "prep/texture.h"

enum {
    COARSEST = 64, /* pixels of the shorter side at the coarsest scale, at least */
    STEPS = 30,    /* of a scale */
    BLOCK = 16,    /* pixels within which residuals are correlated */
    N = 4          /* parameters: shift x, y; stretch, rotation times the half diagonal */
};

static const double ENOUGH = 1e-3;      /* pixels: the last step */
static const double NEAR = 0.1;         /* pixels: a step after which the place is about right */
static const double LOWEST_ALIKE = 0.1; /* correlation of unlike textures, at worst */

/* A least-squares problem about the present place. */
typedef struct problem {
    double gain; /* of fixed on warped */
    double correlation;
    double hessian[N * N], slope[N]; /* J'J, J'r */
    double scatter[N * N];           /* sum over blocks of their slopes' squares */
    double steepness, common; /* squares of the mean slopes of both textures; product of the two */
    double radius;            /* unit of the third and fourth parameter, pixels */
} problem;

static bool counts(const ptie_texture *t, ptrdiff_t i) {
    return t->use[i] && t->inside[i];
}

/* Best gain, and how alike the textures are. */
static void compare(problem *p, const ptie_texture *t) {
    double ff = 0, fw = 0, ww = 0;
    const ptrdiff_t pixels = (ptrdiff_t)t->width * t->height;
    for (ptrdiff_t i = 0; i < pixels; i++) {
        if (!counts(t, i)) continue;
        const double f = (double)t->fixed[i], w = (double)t->warped[i];
        ff += f * f, fw += f * w, ww += w * w;
    }
    p->gain = fw / ww;
    p->correlation = fw / sqrt(ff * ww);
}

/* Along the axis with `step` between neighbours. */
static double slope_at(const float *image, ptrdiff_t i, ptrdiff_t step) {
    return ((double)image[i + step] - (double)image[i - step]) / 2;
}

/* What the planes do not share adds to J'J, where J is made of the mean of both slopes, but not to
   the curvature of what is minimised: this share of J'J. */
static double shared(const problem *p) {
    return fabs(p->common) / p->steepness;
}

static void add_block(problem *p, const ptie_texture *t, int32_t left, int32_t top) {
    const int32_t right = left + BLOCK < t->width ? left + BLOCK : t->width;
    const int32_t bottom = top + BLOCK < t->height ? top + BLOCK : t->height;
    double slope[N] = {0};
    for (int32_t y = top; y < bottom; y++)
        for (int32_t x = left; x < right; x++) {
            const ptrdiff_t i = (ptrdiff_t)y * t->width + x;
            if (!counts(t, i)) continue;
            const double u = (x - (t->width - 1) / 2.0) / p->radius,
                         v = (y - (t->height - 1) / 2.0) / p->radius;
            const double fx = slope_at(t->fixed, i, 1), wx = p->gain * slope_at(t->warped, i, 1);
            const double fy = slope_at(t->fixed, i, t->width),
                         wy = p->gain * slope_at(t->warped, i, t->width);
            const double gx = (fx + wx) / 2, gy = (fy + wy) / 2;
            const double j[N] = {gx, gy, u * gx + v * gy, u * gy - v * gx};
            const double residual = (double)t->fixed[i] - p->gain * (double)t->warped[i];
            p->steepness += gx * gx + gy * gy;
            p->common += fx * wx + fy * wy;
            for (int a = 0; a < N; a++) {
                slope[a] += j[a] * residual;
                for (int b = 0; b <= a; b++) p->hessian[a * N + b] += j[a] * j[b];
            }
        }
    for (int a = 0; a < N; a++) {
        p->slope[a] += slope[a];
        for (int b = 0; b < N; b++) p->scatter[a * N + b] += slope[a] * slope[b];
    }
}

/* Poses the problem at `motion`; its Hessian becomes the factor. */
static ptie_status pose(problem *p, ptie_texture *t, ptie_motion motion, bool choose) {
    PTIE_TRY(ptie_texture_warp(t, motion, choose));
    *p = (problem){.radius = hypot(t->width, t->height) / 2};
    compare(p, t);
    for (int32_t y = 0; y < t->height; y += BLOCK)
        for (int32_t x = 0; x < t->width; x += BLOCK) add_block(p, t, x, y);
    if (isfinite(p->correlation) && ptie_cholesky(p->hessian, N)) return PTIE_OK;
    return PTIE_FAIL(PTIE_ENUMERIC,
                     "registration: planes have no texture to compare (expected structure of the "
                     "light or of the field of view in both)");
}

/* motion after a small motion of the grid: shift + turn (step + (1 + stretch + i rotation) r). */
static ptie_motion compose(ptie_motion m, double dx, double dy, double stretch, double rotation) {
    return (ptie_motion){m.shift_x + m.turn_re * dx - m.turn_im * dy,
                         m.shift_y + m.turn_im * dx + m.turn_re * dy,
                         m.turn_re * (1 + stretch) - m.turn_im * rotation,
                         m.turn_im * (1 + stretch) + m.turn_re * rotation};
}

/* Moves until a step is below ENOUGH pixels; the problem is that of the last place.  Once steps are
   below a pixel, the pixels compared stay the same: a row that comes and goes would keep the motion
   from settling. */
static ptie_status refine(problem *p, ptie_texture *t, ptie_motion *motion) {
    double size = (double)INFINITY;
    for (int i = 0; i < STEPS; i++) {
        PTIE_TRY(pose(p, t, *motion, size > 1));
        double step[N];
        memcpy(step, p->slope, sizeof step);
        ptie_cholesky_solve(p->hessian, N, step);
        if (size < NEAR) /* farther off, a low correlation says that the place is wrong */
            for (int a = 0; a < N; a++) step[a] /= fmax(shared(p), 0.25);
        *motion = compose(*motion, t->scale * step[0], t->scale * step[1], step[2] / p->radius,
                          step[3] / p->radius);
        size = 0;
        for (int a = 0; a < N; a++) size = fmax(size, fabs(step[a]));
        if (size < ENOUGH) return PTIE_OK;
    }
    return PTIE_FAIL(
        PTIE_ENUMERIC,
        "registration: did not settle (expected steps below %g px after %d, found %g px "
        "and a correlation of %.3f)",
        ENOUGH, STEPS, size, p->correlation);
}

/* H^-1 S H^-1: what residuals that are correlated within blocks do to the parameters. */
static void deviations(double out[N], const problem *p) {
    for (int a = 0; a < N; a++) {
        double row[N] = {0}, variance = 0;
        row[a] = 1;
        ptie_cholesky_solve(p->hessian, N, row);
        for (int b = 0; b < N; b++)
            for (int c = 0; c < N; c++) variance += row[b] * p->scatter[b * N + c] * row[c];
        out[a] = sqrt(variance) / shared(p);
    }
}

static void report(ptie_registration *out, const problem *p, ptie_motion motion) {
    double deviation[N];
    deviations(deviation, p);
    const double m = hypot(motion.turn_re, motion.turn_im);
    *out = (ptie_registration){
        .place = {motion.shift_x, motion.shift_y, m, atan2(motion.turn_im, motion.turn_re)},
        .deviation = {m * deviation[0], m * deviation[1], m * deviation[2] / p->radius,
                      deviation[3] / p->radius},
        .correlation = p->correlation,
    };
}

static int32_t coarsest_scale(int32_t width, int32_t height) {
    int32_t scale = 1;
    while ((width < height ? width : height) / (2 * scale) >= COARSEST) scale *= 2;
    return scale;
}

ptie_status ptie_prep_register(ptie_registration *out, const float *fixed, const float *moving,
                               const uint8_t *mask, int32_t width, int32_t height) {
    PTIE_TRY(ptie_image_finite(fixed, width, height, "fixed"));
    PTIE_TRY(ptie_image_finite(moving, width, height, "moving"));
    const int32_t coarsest = coarsest_scale(width, height);
    ptie_motion motion;
    problem p;
    for (int32_t scale = coarsest; scale >= 1; scale /= 2) {
        ptie_texture texture;
        PTIE_TRY(ptie_texture_create(&texture, fixed, moving, mask, width, height, scale));
        ptie_status status = scale == coarsest ? ptie_texture_search(&texture, &motion) : PTIE_OK;
        if (status == PTIE_OK) status = refine(&p, &texture, &motion);
        ptie_texture_free(&texture);
        PTIE_TRY(status);
    }
    if (fabs(p.correlation) < LOWEST_ALIKE)
        return PTIE_FAIL(
            PTIE_ENUMERIC,
            "registration: planes are not alike (expected a correlation of %g or more, found %.3f)",
            LOWEST_ALIKE, fabs(p.correlation));
    report(out, &p, motion);
    return PTIE_OK;
}
