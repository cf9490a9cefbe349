/* SPDX-License-Identifier: BSD-3-Clause */
/* The inverse Laplacian, with both boundaries. */
#include <stdio.h>

#include "bench/frames.h"
#include "bench/groups.h"
#include "tie/solver.h"

typedef struct solving {
    ptie_solver *solver;
    ptie_frames frames; /* a: I+, b: I-, c: phase */
} solving;

static ptie_status solve(void *context, int32_t worker) {
    const solving *s = context;
    const ptie_frames *f = &s->frames;
    const float *const planes[] = {ptie_frame(f, f->a, worker), ptie_frame(f, f->b, worker)};
    return ptie_tie_solve(s->solver, ptie_frame(f, f->c, worker), planes, ptie_frame_scratch(f, worker), NULL);
}

static ptie_status measure(ptie_bench *bench, ptie_boundary boundary, int32_t side) {
    ptie_solver_params params;
    ptie_solver_params_init(&params);
    params.width_px = params.height_px = side;
    params.boundary = boundary;
    solving s = {.solver = NULL};
    ptie_bench_case c = {
        .unit = "frames/s", .mode = PTIE_BENCH_EACH, .amount = 1, .work = solve, .context = &s};
    ptie_status status;
    snprintf(c.name, sizeof c.name, "%s, %d x %d",
             boundary == PTIE_PERIODIC ? "periodic (FFT)" : "mirror (DCT)", side, side);
    PTIE_TRY_DONE(ptie_tie_plan(&s.solver, &params));
    PTIE_TRY_DONE(ptie_frames_create(&s.frames, bench, side));
    PTIE_TRY_DONE(ptie_frames_add_scratch(&s.frames, bench, ptie_tie_scratch(s.solver)));
    status = ptie_bench_measure(bench, &c);
done:
    ptie_frames_free(&s.frames);
    ptie_solver_free(s.solver);
    return status;
}

ptie_status ptie_bench_solving(ptie_bench *bench) {
    PTIE_TRY(measure(bench, PTIE_PERIODIC, 256));
    PTIE_TRY(measure(bench, PTIE_MIRROR, 256));
    PTIE_TRY(measure(bench, PTIE_PERIODIC, 1024));
    return measure(bench, PTIE_MIRROR, 1024);
}
