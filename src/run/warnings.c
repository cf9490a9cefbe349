/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/warnings.h"

#include <math.h>
#include <stdarg.h>

#include "base/text.h"
#include "rig/planes.h"

/* From here on something is worth a word. */
static const double LARGEST_IMBALANCE = 0.004; /* Zhang et al. 2020 (US-TIE) ask for 1/255 */
static const double LARGEST_FLICKER = 0.02;    /* rms of the brightness */
static const double COARSEST_PX = 16;          /* a period that linear TIE should pass */
static const double LARGEST_DRIFT = 0.5;       /* of the background, in units of BNS */
static const double LARGEST_EXCESS = 3;        /* BNS over what the planes' noise explains */

static void warn(ptie_run_summary *s, const char *format, ...) PTIE_PRINTF(2, 3);

static void warn(ptie_run_summary *s, const char *format, ...) {
    va_list arguments;
    if (s->warnings == PTIE_RUN_MOST_WARNINGS) return;
    va_start(arguments, format);
    ptie_vprint(s->warning[s->warnings++], PTIE_RUN_WARNING_BYTES, format, arguments);
    va_end(arguments);
}

static void warn_of_files(ptie_run_summary *s, const ptie_source *source) {
    for (int32_t i = 0; i < ptie_source_get_shape(source).images; i++)
        if (ptie_source_warning(source, i)[0])
            warn(s, "%s: %s", ptie_source_path(source, i), ptie_source_warning(source, i));
}

static void warn_of_planes(ptie_run_summary *s, const ptie_rig *rig, const ptie_running *of_frame) {
    const ptie_stat imbalance = ptie_running_stat(&of_frame[PTIE_IMBALANCE]);
    const ptie_stat brightness = ptie_running_stat(&of_frame[PTIE_BRIGHTNESS]);
    const double saturated = of_frame[PTIE_SATURATED].largest, period_m = ptie_rig_linear_period_m(rig);
    if (saturated > 0)
        warn(s, "saturation: up to %.2g %% of a frame's pixels reach %g counts", 100 * saturated,
             rig->saturation_counts);
    if (imbalance.mean > LARGEST_IMBALANCE)
        warn(s, "planes unequal: their means are apart by %.2g %% (expected below %.2g %%; see match_gain, and "
                "'ptie rig calibrate')",
             100 * imbalance.mean, 100 * LARGEST_IMBALANCE);
    if (brightness.std > LARGEST_FLICKER * brightness.mean)
        warn(s, "light unsteady: the brightness varies by %.2g %% rms over the frames",
             100 * brightness.std / brightness.mean);
    if (period_m > COARSEST_PX * s->pixel_m) {
        char text[PTIE_QUANTITY_BYTES];
        warn(s, "defocus large: structures finer than %s (%.0f px) are weaker than linear TIE says by more than 5 %%",
             ptie_print_rounded(text, period_m, PTIE_LENGTH), period_m / s->pixel_m);
    }
}

static void warn_of_phase(ptie_run_summary *s, const ptie_running *early, const ptie_running *late) {
    const double drift = ptie_running_stat(late).mean - ptie_running_stat(early).mean, bns = s->phase.bns.mean;
    if (fabs(drift) > LARGEST_DRIFT * bns)
        warn(s, "background drifts: by %.2g rad from the first to the last tenth of the frames", drift);
    if (bns > LARGEST_EXCESS * s->noise_rad.mean)
        warn(s, "background uneven: BNS %.2g rad, the planes' noise explains %.2g rad (gain, flat field, registration?)",
             bns, s->noise_rad.mean);
    if (!s->has_regions)
        warn(s, "no regions: no flow to tell from the background, so no MGM, SBR, BNS and CNR");
}

void ptie_run_warn(ptie_run_summary *s, const ptie_source *source, const ptie_rig *rig,
                   const ptie_running *of_frame, const ptie_running *early, const ptie_running *late) {
    warn_of_files(s, source);
    warn_of_planes(s, rig, of_frame);
    warn_of_phase(s, early, late);
}
