/* SPDX-License-Identifier: BSD-3-Clause */
/* Along a row of the grid the source moves by nearly one pixel per pixel: a row falls into a few
 * runs within which the coefficients are neighbours and only the fractions change.  The plan keeps
 * the runs. */
#include "prep/resample.h"

#include <math.h>

#include "base/memory.h"
#include "prep/spline.h"

typedef struct run {
    int32_t x, count;
    float fraction_x, fraction_y; /* of the first point */
    ptrdiff_t offset;             /* of its 4 x 4 coefficients */
} run;

struct ptie_resampler {
    int32_t width, height, margin;
    double centre_x, centre_y;   /* where the grid's centre is found */
    double scale_cos, scale_sin; /* magnification times cos and sin of the rotation */
    float step_x, step_y;        /* of the fractions, per pixel */
    run *runs;
    size_t *first; /* run of each row, and the number of all */
};

typedef struct point {
    double x, y;
} point;

/* Where pixel (x, y) of the grid is found. */
static point source_of(const ptie_resampler *r, int32_t x, int32_t y) {
    const double u = x - (r->width - 1) / 2.0, v = y - (r->height - 1) / 2.0;
    return (point){r->centre_x + r->scale_cos * u - r->scale_sin * v,
                   r->centre_y + r->scale_sin * u + r->scale_cos * v};
}

/* How far the source leaves the frame, at the corners where it is farthest; and room for the taps.
 */
static double excursion(const ptie_resampler *r) {
    double most = 0;
    for (int corner = 0; corner < 4; corner++) {
        const point p = source_of(r, corner % 2 ? r->width - 1 : 0, corner / 2 ? r->height - 1 : 0);
        most =
            fmax(most, fmax(fmax(-p.x, p.x - (r->width - 1)), fmax(-p.y, p.y - (r->height - 1))));
    }
    return ceil(most) + 2;
}

static run run_at(const ptie_resampler *r, int32_t x, int32_t y) {
    const point p = source_of(r, x, y);
    const double column = floor(p.x), row = floor(p.y);
    const ptrdiff_t pitch = r->width + 2 * r->margin;
    return (run){.x = x,
                 .fraction_x = (float)(p.x - column),
                 .fraction_y = (float)(p.y - row),
                 .offset =
                     ((ptrdiff_t)row - 1 + r->margin) * pitch + (ptrdiff_t)column - 1 + r->margin};
}

/* Runs of row y, written to `runs` unless NULL; their number. */
static size_t trace_row(const ptie_resampler *r, run *runs, int32_t y) {
    size_t count = 0;
    for (int32_t x = 0; x < r->width;) {
        run current = run_at(r, x, y);
        int32_t end = x + 1;
        while (end < r->width && run_at(r, end, y).offset == current.offset + (end - x)) end++;
        current.count = end - x;
        if (runs) runs[count] = current;
        count++;
        x = end;
    }
    return count;
}

static ptie_status trace(ptie_resampler *r) {
    PTIE_TRY(ptie_alloc_status(&r->first, (size_t)r->height + 1, sizeof *r->first, "resampler"));
    for (int32_t y = 0; y < r->height; y++) r->first[y + 1] = r->first[y] + trace_row(r, NULL, y);
    PTIE_TRY(ptie_alloc_status(&r->runs, r->first[r->height], sizeof *r->runs, "resampler"));
    for (int32_t y = 0; y < r->height; y++) trace_row(r, r->runs + r->first[y], y);
    return PTIE_OK;
}

ptie_status ptie_prep_resampler(ptie_resampler **out, int32_t width, int32_t height,
                                ptie_similarity where) {
    *out = NULL;
    const ptie_resampler plan = {.width = width,
                                 .height = height,
                                 .centre_x = (width - 1) / 2.0 + where.shift_x_px,
                                 .centre_y = (height - 1) / 2.0 + where.shift_y_px,
                                 .scale_cos = where.magnification * cos(where.rotation_rad),
                                 .scale_sin = where.magnification * sin(where.rotation_rad)};
    const double margin = excursion(&plan);
    if (!(margin <= (width < height ? width : height)))
        return PTIE_FAIL(PTIE_EINVAL,
                         "registration: plane leaves the frame (expected an overlap of %d x %d px, "
                         "found shift %g, "
                         "%g px, magnification %g, rotation %g rad)",
                         width, height, where.shift_x_px, where.shift_y_px, where.magnification,
                         where.rotation_rad);
    ptie_resampler *r;
    PTIE_TRY(ptie_alloc_status(&r, 1, sizeof *r, "resampler"));
    *r = plan;
    r->margin = (int32_t)margin;
    r->step_x = (float)(r->scale_cos - 1);
    r->step_y = (float)r->scale_sin;
    const ptie_status status = trace(r);
    if (status == PTIE_OK)
        *out = r;
    else
        ptie_resampler_free(r);
    return status;
}

void ptie_resampler_free(ptie_resampler *r) {
    if (!r) return;
    ptie_free(r->runs);
    ptie_free(r->first);
    ptie_free(r);
}

typedef struct scratch {
    float *coefficient, *lanes;
} scratch;

static scratch carve(ptie_slicer *slicer, const ptie_resampler *r) {
    const size_t columns = (size_t)(r->width + 2 * r->margin),
                 rows = (size_t)(r->height + 2 * r->margin);
    float *coefficient = ptie_slice(slicer, columns * rows, sizeof(float));
    return (scratch){coefficient, ptie_slice(slicer, ptie_spline_scratch(r->width), sizeof(float))};
}

size_t ptie_prep_resampler_scratch(const ptie_resampler *r) {
    ptie_slicer slicer = {0};
    carve(&slicer, r);
    return slicer.used;
}

void ptie_prep_resample(const ptie_resampler *r, float *out, const float *plane,
                        void *scratch_block) {
    ptie_slicer slicer = {.base = scratch_block};
    const scratch s = carve(&slicer, r);
    const ptrdiff_t pitch = r->width + 2 * r->margin;
    ptie_spline_transform(s.coefficient, plane, r->width, r->height, r->margin, s.lanes);
    for (int32_t y = 0; y < r->height; y++)
        for (size_t i = r->first[y]; i < r->first[y + 1]; i++) {
            const run *n = &r->runs[i];
            ptie_spline_run(out + (ptrdiff_t)y * r->width + n->x, s.coefficient + n->offset, pitch,
                            n->count, n->fraction_x, n->fraction_y, r->step_x, r->step_y);
        }
}

void ptie_resampler_inside(const ptie_resampler *r, uint8_t *mask, double margin_px) {
    const double left = margin_px, right = r->width - 1 - margin_px,
                 bottom = r->height - 1 - margin_px;
    for (int32_t y = 0; y < r->height; y++)
        for (int32_t x = 0; x < r->width; x++) {
            const point p = source_of(r, x, y);
            *mask++ = p.x >= left && p.x <= right && p.y >= left && p.y <= bottom;
        }
}
