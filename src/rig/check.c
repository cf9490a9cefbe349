/* SPDX-License-Identifier: BSD-3-Clause */
/* Findings, one function each.  Limits: what is doubtful, what is wrong. */
#include "rig/check.h"

#include <math.h>
#include <stdarg.h>

#include "base/memory.h"
#include "base/text.h"
#include "prep/median.h"
#include "prep/prep.h"
#include "rig/planes.h"
#include "rig/sampling.h"
#include "tie/solver.h"


typedef struct check {
    const ptie_rig *rig;
    ptie_sampling recording, reference, target; /* the last two: opened if there is one */
    bool has_reference, has_target;
    ptie_rig_report *report;
} check;

static void add(check *c, const char *name, ptie_verdict verdict, double value, const char *format,
                ...) PTIE_PRINTF(5, 6);

static void add(check *c, const char *name, ptie_verdict verdict, double value, const char *format,
                ...) {
    ptie_rig_finding *finding = &c->report->finding[c->report->count++];
    va_list arguments;
    *finding = (ptie_rig_finding){.name = name, .verdict = verdict, .value = value};
    va_start(arguments, format);
    ptie_vprint(finding->text, sizeof finding->text, format, arguments);
    va_end(arguments);
}

/* The larger the worse; NaN is doubtful. */
static ptie_verdict judge(double value, double doubtful, double wrong) {
    return value > wrong ? PTIE_WRONG : value <= doubtful ? PTIE_GOOD : PTIE_DOUBTFUL;
}

static void check_size(check *c) {
    const ptie_sampling *s = &c->recording;
    const bool odd =
        s->rig.layout != PTIE_LAYOUT_SEPARATE && (s->shape.width_px % 2 || s->shape.height_px % 2);
    const ptie_prepare_shape planes = ptie_prepare_get_shape(s->plan);
    char pixel[PTIE_QUANTITY_BYTES];
    add(c, "size", odd ? PTIE_DOUBTFUL : PTIE_GOOD, planes.width_px,
        "%d x %d px recorded, planes of %d x %d px, %s each%s; %lld frames", s->shape.width_px,
        s->shape.height_px, planes.width_px, planes.height_px,
        ptie_print_rounded(pixel, planes.pixel_m, PTIE_LENGTH),
        odd ? "; the last column or row has no partner" : "", (long long)s->shape.frames);
}

/* Share of pixels at the largest value, and the light's share of the range. */
static ptie_status check_exposure(check *c) {
    ptie_sampling *s = &c->recording;
    const double white =
        s->rig.saturation_counts > 0 ? s->rig.saturation_counts : s->shape.white_level;
    double full = 0, mean = 0;
    if (!(white > 0)) {
        add(c, "saturation", PTIE_DOUBTFUL, (double)NAN,
            "unknown: neither rig nor recording says the largest value");
        return PTIE_OK;
    }
    for (int32_t t = 0; t < s->frames; t++) {
        PTIE_TRY(ptie_sampling_read(s, t));
        for (int32_t i = 0; i < s->shape.images; i++)
            full += (double)ptie_count_saturated(s->frame[i], s->plan->sensor_pixels, white);
    }
    full /= (double)s->plan->sensor_pixels * s->frames * s->shape.images;
    for (int32_t i = 0; i < s->shape.images; i++)
        mean += ptie_masked_mean(s->image[i], NULL, s->plan->sensor_pixels) / s->shape.images;
    add(c, "saturation", judge(full, 1e-4, 0.01), full, "%.3g %% of the pixels reach %g counts",
        100 * full, white);
    add(c, "exposure", mean < 0.1 * white ? PTIE_DOUBTFUL : PTIE_GOOD, mean / white,
        "on average %.3g %% of the range", 100 * mean / white);
    return PTIE_OK;
}

static void check_mosaic(check *c) {
    const ptie_sampling *s = &c->recording;
    if (s->rig.layout != PTIE_LAYOUT_MOSAIC) return;
    const double off = ptie_mosaic_imbalance(s->image[0], s->shape.width_px, s->shape.height_px);
    add(c, "mosaic", judge(off, 0.05, 0.2), off,
        "crossed polarisers add up to the same light within %.3g %% (TL + BR against TR + BL)",
        100 * off);
}

/* A gain error a makes a false phase of a k r^2 / (8 z) where it does not fill the frame. */
static ptie_status check_means(check *c) {
    ptie_sampling *s = &c->recording;
    PTIE_TRY(ptie_sampling_planes(s, s->image, PTIE_STEP_GAIN));
    const ptie_prepare *plan = s->plan;
    const double spread =
        ptie_plane_spread((const float *const *)s->plane, plan->planes, plan->light, plan->pixels);
    const bool matched = c->rig->match_gain;
    add(c, "means of planes", matched ? judge(spread, 0.2, 1) : judge(spread, 0.002, 0.05), spread,
        "differ by %.3g %% of their mean%s", 100 * spread,
        matched ? ", which match_gain takes out" : "");
    return PTIE_OK;
}

static void check_mask(check *c) {
    const ptie_prepare *plan = c->recording.plan;
    size_t opaque = 0;
    if (!plan->light) return;
    for (size_t i = 0; i < plan->pixels; i++) opaque += !plan->light[i];
    const double share = (double)opaque / (double)plan->pixels;
    add(c, "mask", judge(share, 0.5, 0.9), share, "%.3g %% of the pixels are opaque", 100 * share);
}

/* The reference must be of the same light: as bright, and bright enough everywhere to divide by. */
static ptie_status check_flat_field(check *c) {
    ptie_sampling *s = &c->recording;
    const ptie_prepare *plan = s->plan;
    if (!c->has_reference) {
        add(c, "flat field", PTIE_DOUBTFUL, (double)NAN,
            "no reference: dust and fringes that the planes do not share stay in the phase");
        return PTIE_OK;
    }
    PTIE_TRY(ptie_sampling_planes(s, s->image, PTIE_STEP_MIX));
    const double light = ptie_masked_mean(s->plane[0], plan->light, plan->pixels);
    s = &c->reference;
    PTIE_TRY(ptie_sampling_planes(s, s->image, PTIE_STEP_MIX));
    const double still = ptie_masked_mean(s->plane[0], plan->light, plan->pixels);
    const double off = fabs(light / still - 1);
    add(c, "flat field", judge(off, 0.1, 0.5), off,
        "the recording is %.3g %% %s than the reference", 100 * off,
        light < still ? "darker" : "brighter");
    return PTIE_OK;
}

/* Pixels by which the corner of a frame is off. */
static double displacement(const ptie_similarity *s, double radius) {
    return hypot(s->shift_x_px, s->shift_y_px) +
           radius * (fabs(s->magnification - 1) + fabs(s->rotation_rad));
}

/* Of the plane that lies worst: pixels, and their standard deviation.  *unlike: a plane that shows
 * nothing in common. */
static ptie_status measure_displacement(double *worst, double *uncertain, const char **unlike,
                                        ptie_sampling *s) {
    const ptie_prepare *plan = s->plan;
    const double radius = hypot(plan->width, plan->height) / 2;
    PTIE_TRY(ptie_sampling_planes(s, s->image, PTIE_STEP_REGISTRATION));
    for (int32_t i = 1; i < plan->measured; i++) {
        ptie_registration found;
        ptie_status status = ptie_prep_register(&found, s->plane[0], s->plane[i], plan->light,
                                                plan->width, plan->height);
        if (status == PTIE_ENUMERIC) *unlike = ptie_role_names[plan->role[i]];
        if (status == PTIE_ENUMERIC) return PTIE_OK;
        PTIE_TRY(status);
        if (displacement(&found.place, radius) <= *worst) continue;
        *worst = displacement(&found.place, radius);
        *uncertain = hypot(found.deviation.shift_x_px, found.deviation.shift_y_px) +
                     radius * (found.deviation.magnification + found.deviation.rotation_rad);
    }
    return PTIE_OK;
}

/* What registration leaves.  Only a target tells: in other frames dust on the sensor, the same in
   every plane, says that the planes lie where they do not. */
static ptie_status check_registration(check *c) {
    double worst = 0, uncertain = 0;
    const char *unlike = NULL;
    if (c->recording.plan->measured < 2) return PTIE_OK;
    if (!c->has_target) {
        add(c, "registration", PTIE_DOUBTFUL, (double)NAN,
            "not measured: there is no recording of a target");
        return PTIE_OK;
    }
    PTIE_TRY(measure_displacement(&worst, &uncertain, &unlike, &c->target));
    if (unlike)
        add(c, "registration", PTIE_DOUBTFUL, (double)NAN,
            "not measured: '%s' shows nothing that 'plus' does", unlike);
    else
        add(c, "registration", judge(worst - 2 * uncertain, 0.2, 2), worst,
            "planes are off by %.2g px at the corners, +- %.2g px", worst, uncertain);
    return PTIE_OK;
}

static void check_linearity(check *c) {
    const ptie_rig *rig = c->rig;
    char nyquist[PTIE_QUANTITY_BYTES], finest[PTIE_QUANTITY_BYTES];
    const double period_m = 2 * ptie_rig_pixel_m(rig), linear_m = ptie_rig_linear_period_m(rig);
    const double chi = PTIE_LINEAR_CHI * pow(linear_m / period_m, 2);
    ptie_print_rounded(nyquist, period_m, PTIE_LENGTH);
    ptie_print_rounded(finest, linear_m, PTIE_LENGTH);
    add(c, "linear TIE", judge(chi, PTIE_LINEAR_CHI, (double)INFINITY), chi,
        "chi = %.3g at Nyquist (%s); periods below %s come out more than 5 %% too weak", chi,
        nyquist, finest);
}

/* White noise of a plane relative to its mean, from two frames: the median of |difference| does not
 * see the flow. */
static ptie_status measure_noise(double *sigma, ptie_sampling *s) {
    const ptie_prepare *plan = s->plan;
    float *difference; /* its size */
    PTIE_TRY(ptie_source_read(s->source, 0, s->frame));
    PTIE_TRY(ptie_sampling_planes(s, s->frame, PTIE_STEP_MIX));
    PTIE_TRY(ptie_alloc_status(&difference, plan->pixels, sizeof(float), "rig: noise"));
    const double mean = ptie_masked_mean(s->plane[0], plan->light, plan->pixels);
    for (size_t i = 0; i < plan->pixels; i++) difference[i] = s->plane[0][i];
    ptie_status status = ptie_source_read(s->source, 1, s->frame);
    if (status == PTIE_OK) status = ptie_sampling_planes(s, s->frame, PTIE_STEP_MIX);
    if (status == PTIE_OK) {
        const double ratio = mean / ptie_masked_mean(s->plane[0], plan->light,
                                                     plan->pixels); /* of a flickering lamp */
        size_t lit = 0;
        for (size_t i = 0; i < plan->pixels; i++)
            if (!plan->light || plan->light[i])
                difference[lit++] = fabsf(difference[i] - (float)ratio * s->plane[0][i]);
        *sigma = ptie_median(difference, lit) / (0.6745 * sqrt(2) * mean);
    }
    ptie_free(difference);
    return status;
}

static ptie_status check_noise(check *c) {
    ptie_sampling *s =
        c->has_reference && c->reference.shape.frames > 1 ? &c->reference : &c->recording;
    const ptie_prepare_shape shape = ptie_prepare_get_shape(s->plan);
    ptie_solver_params params = ptie_rig_solver(&s->rig, shape.width_px, shape.height_px);
    ptie_solver *solver;
    double sigma = 0;
    if (s->shape.frames < 2) {
        add(c, "noise", PTIE_DOUBTFUL, (double)NAN, "cannot be measured in one frame");
        return PTIE_OK;
    }
    PTIE_TRY(measure_noise(&sigma, s));
    params.method = PTIE_SOLVE_DIRECT;
    PTIE_TRY(ptie_tie_plan(&solver, &params));
    const double phase_rad = ptie_tie_noise_rad(solver, sigma / s->rig.binning);
    ptie_solver_free(solver);
    add(c, "noise", judge(sigma, 0.05, 0.5), sigma,
        "%.3g %% of the light in a plane; %.3g rad rms in the phase", 100 * sigma, phase_rad);
    return PTIE_OK;
}

static ptie_status compare(check *c) {
    check_size(c);
    PTIE_TRY(check_exposure(c));
    check_mosaic(c);
    PTIE_TRY(check_means(c));
    check_mask(c);
    PTIE_TRY(check_flat_field(c));
    PTIE_TRY(check_registration(c));
    check_linearity(c);
    return check_noise(c);
}

ptie_status ptie_rig_compare(const ptie_rig *rig, const char *recording,
                             const char *const plane[PTIE_ROLES], const char *target,
                             ptie_rig_report *report) {
    check c = {.rig = rig,
               .report = report,
               .has_reference = rig->reference[0] != 0,
               .has_target = target != NULL};
    report->count = 0;
    ptie_status status = ptie_sampling_open(&c.recording, rig, recording, plane, false);
    if (status == PTIE_OK && c.has_reference)
        status = ptie_sampling_open(&c.reference, rig, rig->reference, NULL, false);
    if (status == PTIE_OK && target)
        status = ptie_sampling_open(&c.target, rig, target, NULL, true);
    if (status == PTIE_OK) status = compare(&c);
    ptie_sampling_close(&c.recording);
    ptie_sampling_close(&c.reference);
    ptie_sampling_close(&c.target);
    return status;
}
