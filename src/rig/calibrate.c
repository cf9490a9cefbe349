/* SPDX-License-Identifier: BSD-3-Clause */
/* Where planes lie and how bright they are, from frames without flow. */
#include <math.h>
#include <string.h>

#include "prep/prep.h"
#include "rig/check.h"
#include "rig/sampling.h"

/* Ratio of means to I+, and its standard deviation over the samples. */
static ptie_status measure_gains(ptie_plane_calibration *calibration, ptie_sampling *s) {
    const ptie_prepare *plan = s->plan;
    double sum[PTIE_ROLES] = {0}, squares[PTIE_ROLES] = {0};
    for (int32_t t = 0; t < s->frames; t++) {
        PTIE_TRY(ptie_sampling_read(s, t));
        PTIE_TRY(ptie_sampling_planes(s, s->frame, PTIE_STEP_MIX));
        const double plus = ptie_masked_mean(s->plane[0], plan->light, plan->pixels);
        for (int32_t i = 1; i < plan->planes; i++) {
            const double gain = plus / ptie_masked_mean(s->plane[i], plan->light, plan->pixels);
            sum[i] += gain;
            squares[i] += gain * gain;
        }
    }
    for (int32_t i = 1; i < plan->planes; i++) {
        ptie_plane_calibration *c = &calibration[plan->role[i]];
        c->gain = sum[i] / s->frames;
        c->gain_deviation = s->frames > 1
                                ? sqrt(fmax(0, squares[i] - sum[i] * c->gain) / (s->frames - 1))
                                : (double)NAN;
    }
    return PTIE_OK;
}

static ptie_status measure(ptie_plane_calibration *calibration, ptie_sampling *s) {
    const ptie_prepare *plan = s->plan;
    PTIE_TRY(measure_gains(calibration, s));
    PTIE_TRY(ptie_sampling_planes(s, s->image, PTIE_STEP_FLAT));
    for (int32_t i = 1; i < plan->planes; i++) {
        ptie_plane_calibration *c = &calibration[plan->role[i]];
        ptie_status status = ptie_prep_register(&c->where, s->plane[0], s->plane[i], plan->light,
                                                plan->width, plan->height);
        if (status != PTIE_OK && status != PTIE_ENUMERIC) return status;
        c->measured = status == PTIE_OK;
    }
    return PTIE_OK;
}

ptie_status ptie_rig_measure(ptie_plane_calibration calibration[PTIE_ROLES], const ptie_rig *rig,
                             const char *recording, const char *const plane[PTIE_ROLES]) {
    ptie_sampling s;
    if (rig->one_plane)
        return PTIE_FAIL(
            PTIE_EINVAL,
            "rig: one plane has nothing to be calibrated against (expected a set of several)");
    for (int i = 0; i < PTIE_ROLES; i++) calibration[i] = (ptie_plane_calibration){.gain = 1};
    const bool itself =
        recording && strcmp(recording, rig->reference) == 0; /* flat, there is nothing to see */
    ptie_status status = ptie_sampling_open(&s, rig, recording, plane, !itself);
    if (status == PTIE_OK) status = measure(calibration, &s);
    ptie_sampling_close(&s);
    return status;
}
