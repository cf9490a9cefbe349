/* SPDX-License-Identifier: BSD-3-Clause */
#include "recording_facts.h"

#include <stdio.h>
#include <string.h>

static void add_if(facts *f, const char *name, const char *text) {
    if (text[0]) add_text(f, name, "%s", text);
}

static void add_shape(facts *f, const ptie_recording_info *info) {
    add_text(f, "format", "%s", info->format);
    add_if(f, "data set", info->dataset);
    if (info->recorded > info->frames)
        add_number(f, "frames", (double)info->frames, "%lld of %lld", (long long)info->frames,
                   (long long)info->recorded);
    else
        add_number(f, "frames", (double)info->frames, "%lld", (long long)info->frames);
    add_number(f, "width", info->width_px, "%d px", info->width_px);
    add_number(f, "height", info->height_px, "%d px", info->height_px);
    if (info->roi_x_px > 0 || info->roi_y_px > 0)
        add_text(f, "corner", "x=%d, y=%d on the sensor", info->roi_x_px, info->roi_y_px);
    if (info->bottom_up) add_text(f, "rows", "bottom row first in the file; read top row first");
}

static void add_values(facts *f, const ptie_recording_info *info) {
    add_text(f, "sample", "%s", info->sample);
    if (info->bit_depth > 0) add_number(f, "bit depth", info->bit_depth, "%d", info->bit_depth);
    if (info->white_level > info->black_level) {
        add_number(f, "black level", info->black_level, "%g", info->black_level);
        add_number(f, "white level", info->white_level, "%g", info->white_level);
    }
    add_if(f, "unit", info->unit);
    if (info->pixel_m > 0) add_quantity(f, "pixel", info->pixel_m, PTIE_LENGTH);
}

static void add_times(facts *f, const ptie_recording_info *info) {
    char exposed[PTIE_QUANTITY_BYTES], kept[PTIE_QUANTITY_BYTES];
    const double rate_hz = info->frame_rate_hz;
    if (rate_hz > 0 && info->skip > 1)
        add_number(f, "frame rate", rate_hz, "%s (one of %lld at %s)",
                   ptie_print_rounded(kept, rate_hz, PTIE_RATE), (long long)info->skip,
                   ptie_print_rounded(exposed, rate_hz * (double)info->skip, PTIE_RATE));
    else if (rate_hz > 0)
        add_quantity(f, "frame rate", rate_hz, PTIE_RATE);
    if (rate_hz > 0 && info->frames > 0)
        add_quantity(f, "duration", (double)info->frames / rate_hz, PTIE_TIME);
    if (info->exposure_s > 0) add_quantity(f, "exposure", info->exposure_s, PTIE_TIME);
}

static void add_notes(facts *f, const ptie_recording_info *info) {
    add_if(f, "camera", info->camera);
    add_if(f, "date", info->date);
    add_if(f, "trigger", info->trigger);
    add_if(f, "comment", info->comment);
}

/* Range, mean, and the share of pixels that a camera could not count any further. */
static void add_frame(facts *f, const float *frame, size_t count, double white) {
    double low = (double)frame[0], high = low, sum = 0;
    size_t saturated = 0;
    for (size_t i = 0; i < count; i++) {
        const double value = (double)frame[i];
        low = value < low ? value : low;
        high = value > high ? value : high;
        sum += value;
        saturated += value >= white;
    }
    add_text(f, "first frame", "%.6g .. %.6g, mean %.6g", low, high, sum / (double)count);
    if (white > 0 && saturated > 0) {
        const double share = (double)saturated / (double)count;
        add_number(f, "saturated", share, "%.3g %% of its pixels", 100 * share);
    }
}

static ptie_status add_first_frame(facts *f, const ptie_recording_info *info, const char *path) {
    ptie_recording *recording;
    const size_t count = (size_t)info->width_px * (size_t)info->height_px;
    ptie_status status = ptie_recording_open(&recording, path);
    if (status != PTIE_OK) return status;
    float *frame = ptie_scratch_alloc(count * sizeof *frame);
    status = frame ? ptie_recording_read(recording, 0, frame) : PTIE_ENOMEM;
    if (status == PTIE_OK) add_frame(f, frame, count, info->white_level);
    ptie_scratch_free(frame);
    ptie_recording_close(recording);
    return status;
}

ptie_status add_recording(facts *f, const char *path) {
    ptie_recording_info info;
    ptie_status status = ptie_recording_describe(&info, path);
    if (status != PTIE_OK) return status;
    add_text(f, "kind", "recording");
    add_shape(f, &info);
    add_values(f, &info);
    add_times(f, &info);
    add_notes(f, &info);
    if (info.frames > 0) status = add_first_frame(f, &info, path);
    add_if(f, "warning", info.warning);
    return status;
}
