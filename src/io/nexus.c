/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/nexus.h"

#include <stdio.h>

#include <ptie/version.h>

#include "base/memory.h"

#define ENTRY "/entry"
#define TIME PTIE_NEXUS_DATA "/time"
#define LARGEST_SIGNALS 16

static ptie_status write_groups(ptie_h5 *h5, const ptie_nexus_signal *signals, size_t count) {
    static const char *const axes[] = {"time", "y", "x"};
    const char *others[LARGEST_SIGNALS];
    if (count > LARGEST_SIGNALS)
        return PTIE_FAIL(PTIE_EINVAL, "too many signals (expected at most %d, found %zu)",
                         LARGEST_SIGNALS, count);
    for (size_t i = 1; i < count; i++) others[i - 1] = signals[i].name;
    PTIE_TRY(ptie_h5_set_text(h5, "/", "default", "entry"));
    PTIE_TRY(ptie_h5_set_text(h5, ENTRY, "NX_class", "NXentry"));
    PTIE_TRY(ptie_h5_set_text(h5, ENTRY, "default", "data"));
    PTIE_TRY(ptie_h5_set_text(h5, PTIE_NEXUS_DATA, "NX_class", "NXdata"));
    PTIE_TRY(ptie_h5_set_text(h5, PTIE_NEXUS_DATA, "signal", signals[0].name));
    if (count > 1)
        PTIE_TRY(ptie_h5_set_texts(h5, PTIE_NEXUS_DATA, "auxiliary_signals", others, count - 1));
    return ptie_h5_set_texts(h5, PTIE_NEXUS_DATA, "axes", axes, 3);
}

/* count values first, first + step, ... of an axis that exists already. */
static ptie_status write_ramp(ptie_h5 *h5, const char *path, uint64_t count, double first,
                              double step) {
    double *values;
    PTIE_TRY(ptie_alloc_status(&values, (size_t)count, sizeof *values, path));
    for (uint64_t i = 0; i < count; i++) values[i] = first + step * (double)i;
    ptie_status status = ptie_h5_write(h5, path, PTIE_H5_F64, 0, count, values);
    ptie_free(values);
    return status;
}

static ptie_status write_axis(ptie_h5 *h5, const char *path, int32_t count, double pixel_m) {
    const uint64_t length = (uint64_t)count;
    PTIE_TRY(ptie_h5_dataset(h5, path, PTIE_H5_F64, 1, &length, 0));
    PTIE_TRY(ptie_h5_set_text(h5, path, "units", pixel_m > 0 ? "m" : "px"));
    return write_ramp(h5, path, length, 0, pixel_m > 0 ? pixel_m : 1);
}

static int64_t step_of(const ptie_nexus_axes *axes) {
    return axes->frame_step ? axes->frame_step : 1;
}

static ptie_status write_time(ptie_h5 *h5, const ptie_nexus_axes *axes) {
    const double rate = axes->frame_rate_hz > 0 ? axes->frame_rate_hz : 1;
    const double step = (double)step_of(axes);
    return write_ramp(h5, TIME, axes->frames, (double)axes->first_frame / rate, step / rate);
}

static ptie_status make_time(ptie_h5 *h5, const ptie_nexus_axes *axes) {
    PTIE_TRY(ptie_h5_dataset(h5, TIME, PTIE_H5_F64, 1, &axes->frames, axes->frames ? 0 : 1024));
    PTIE_TRY(ptie_h5_set_text(h5, TIME, "units", axes->frame_rate_hz > 0 ? "s" : ""));
    PTIE_TRY(ptie_h5_set_integer(h5, TIME, PTIE_NEXUS_FIRST_FRAME, axes->first_frame));
    PTIE_TRY(ptie_h5_set_integer(h5, TIME, PTIE_NEXUS_FRAME_STEP, step_of(axes)));
    return axes->frames ? write_time(h5, axes) : PTIE_OK;
}

static ptie_status make_signal(ptie_h5 *h5, const ptie_nexus_axes *axes,
                               const ptie_nexus_signal *signal) {
    char path[256];
    const uint64_t dims[3] = {axes->frames, (uint64_t)axes->height_px, (uint64_t)axes->width_px};
    const double pixel_um = 1e6 * axes->pixel_m;
    snprintf(path, sizeof path, PTIE_NEXUS_DATA "/%s", signal->name);
    PTIE_TRY(signal->packed ? ptie_h5_dataset_packed(h5, path, signal->type, 3, dims)
                            : ptie_h5_dataset(h5, path, signal->type, 3, dims, !axes->in_place));
    PTIE_TRY(ptie_h5_set_text(h5, path, "units", signal->unit));
    PTIE_TRY(ptie_h5_set_text(h5, path, "long_name",
                              signal->long_name ? signal->long_name : signal->name));
    if (axes->pixel_m > 0) /* for Fiji: z y x */
        PTIE_TRY(
            ptie_h5_set_numbers(h5, path, "element_size_um", (double[]){1, pixel_um, pixel_um}, 3));
    return ptie_h5_set_text(h5, path, "interpretation", "image");
}

ptie_status ptie_nexus_begin(ptie_h5 *h5, const ptie_nexus_axes *axes,
                             const ptie_nexus_signal *signals, size_t count) {
    PTIE_TRY(write_groups(h5, signals, count));
    for (size_t i = 0; i < count; i++) PTIE_TRY(make_signal(h5, axes, &signals[i]));
    PTIE_TRY(make_time(h5, axes));
    PTIE_TRY(write_axis(h5, PTIE_NEXUS_DATA "/y", axes->height_px, axes->pixel_m));
    return write_axis(h5, PTIE_NEXUS_DATA "/x", axes->width_px, axes->pixel_m);
}

ptie_status ptie_nexus_end(ptie_h5 *h5, const ptie_nexus_axes *axes) {
    return write_time(h5, axes);
}

ptie_status ptie_nexus_process(ptie_h5 *h5, const char *recording, const char *command) {
    static const char process[] = PTIE_NEXUS_PROCESS;
    PTIE_TRY(ptie_h5_set_text(h5, process, "NX_class", "NXprocess"));
    PTIE_TRY(ptie_h5_set_text(h5, process, "program", "ptie"));
    PTIE_TRY(ptie_h5_set_text(h5, process, "version", PTIE_VERSION_STRING));
    if (recording) PTIE_TRY(ptie_h5_set_text(h5, process, "recording", recording));
    return command ? ptie_h5_set_text(h5, process, "command", command) : PTIE_OK;
}
