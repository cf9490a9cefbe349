/* SPDX-License-Identifier: BSD-3-Clause */
#include "rig/cutoff.h"

#include "base/memory.h"
#include "rig/planes.h"
#include "tie/solver.h"

enum { MOST = 9 }; /* frames asked */

/* Images and planes of one frame. */
typedef struct frame {
    float *image[PTIE_ROLES], *plane[PTIE_ROLES];
    void *scratch;
} frame;

static void carve(frame *f, ptie_slicer *slicer, const ptie_source_shape *recorded,
                  const ptie_prepare *preparation) {
    const ptie_prepare_shape shape = ptie_prepare_get_shape(preparation);
    const size_t raw = (size_t)recorded->width_px * (size_t)recorded->height_px;
    const size_t pixels = (size_t)shape.width_px * (size_t)shape.height_px;
    for (int32_t i = 0; i < recorded->images; i++) f->image[i] = ptie_slice(slicer, raw, sizeof(float));
    for (int32_t i = 0; i < shape.planes; i++) f->plane[i] = ptie_slice(slicer, pixels, sizeof(float));
    f->scratch = ptie_slice(slicer, ptie_prepare_scratch_bytes(preparation), 1);
}

static void insert(double *sorted, int64_t count, double value) {
    for (; count > 0 && sorted[count - 1] > value; count--) sorted[count] = sorted[count - 1];
    sorted[count] = value;
}

static ptie_status ask(double *cutoff_m, const ptie_solver_params *solver, ptie_cutoff_rule rule, frame *f,
                       ptie_source *source, const ptie_prepare *preparation, int64_t number) {
    PTIE_TRY(ptie_source_read(source, number, f->image));
    PTIE_TRY(ptie_prepare_run(preparation, (const float *const *)f->image, f->plane, f->scratch));
    return ptie_tie_choose_cutoff(cutoff_m, solver, (const float *const *)f->plane, rule, 0);
}

ptie_status ptie_run_cutoff(double *cutoff_m, const ptie_rig *rig, ptie_source *source,
                            const ptie_prepare *preparation, int64_t first, int64_t count, int64_t step) {
    *cutoff_m = rig->cutoff_m;
    if (rig->cutoff_m >= 0) return PTIE_OK;
    const ptie_cutoff_rule rule = rig->cutoff_m == PTIE_CUTOFF_AUTO ? PTIE_CUTOFF_NOISE : PTIE_CUTOFF_L_CURVE;
    const ptie_prepare_shape shape = ptie_prepare_get_shape(preparation);
    const ptie_source_shape recorded = ptie_source_get_shape(source);
    ptie_solver_params solver = ptie_rig_solver(rig, shape.width_px, shape.height_px);
    solver.mask = ptie_prepare_mask(preparation);
    const int64_t asked = count < MOST ? count : MOST;
    double chosen[MOST];
    frame f;
    unsigned char *memory;
    ptie_slicer slicer = {0};
    carve(&f, &slicer, &recorded, preparation);
    PTIE_TRY(ptie_alloc_status(&memory, slicer.used, 1, "run: cut-off"));
    carve(&f, &(ptie_slicer){.base = memory}, &recorded, preparation);
    ptie_status status = PTIE_OK;
    for (int64_t i = 0; i < asked && status == PTIE_OK; i++) {
        double value = 0;
        status = ask(&value, &solver, rule, &f, source, preparation, first + i * count / asked * step);
        insert(chosen, i, value);
    }
    ptie_free(memory);
    if (status == PTIE_OK) *cutoff_m = chosen[asked / 2];
    return status;
}
