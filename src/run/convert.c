/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/convert.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/image.h"
#include "base/memory.h"
#include "io/recording.h"
#include "run/columns.h"

#define NAME_BYTES 64

typedef struct conversion {
    const ptie_convert_params *params;
    const uint32_t *colours;
    ptie_recording *input;
    ptie_writer *output;
    ptie_rect roi;
    int64_t frames, passes, done; /* frames read in all passes */
    double low, high;
    float *frame; /* (H, W) as read; the rectangle is moved to its front */
} conversion;

static ptie_status choose_pixels(conversion *c) {
    const ptie_recording_info *info = ptie_io_info(c->input);
    const ptie_rect roi = c->params->roi, none = {0};
    if (memcmp(&roi, &none, sizeof roi) == 0) {
        c->roi = (ptie_rect){0, 0, info->width_px, info->height_px};
        return PTIE_OK;
    }
    if (roi.x_px < 0 || roi.y_px < 0 || roi.width_px < 1 || roi.height_px < 1 || roi.x_px >= info->width_px ||
        roi.y_px >= info->height_px || roi.width_px > info->width_px - roi.x_px ||
        roi.height_px > info->height_px - roi.y_px)
        return PTIE_FAIL(PTIE_EINVAL,
                         "%s: rectangle outside the frame (expected inside %d x %d px, found %d,%d,%d,%d)",
                         c->params->input, info->width_px, info->height_px, roi.x_px, roi.y_px, roi.width_px,
                         roi.height_px);
    c->roi = roi;
    return PTIE_OK;
}

/* What the output says of itself. */
static ptie_recording_info describe(const conversion *c) {
    const ptie_convert_params *p = c->params;
    ptie_recording_info info = *ptie_io_info(c->input);
    info.width_px = c->roi.width_px;
    info.height_px = c->roi.height_px;
    info.roi_x_px += c->roi.x_px;
    info.roi_y_px += c->roi.y_px;
    info.frames = c->frames;
    info.first_frame += p->frames.first * info.frame_step;
    if (c->frames > 1) {
        info.frame_step *= p->frames.step;
        info.frame_rate_hz /= (double)p->frames.step;
    }
    return info;
}

/* The last part of a data set's path, with '_' for what a name cannot have. */
static void name_map(char name[NAME_BYTES], const ptie_recording_info *info) {
    static const char letters[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    const char *slash = strrchr(info->dataset, '/');
    const char *from = slash && slash[1] ? slash + 1 : "data";
    size_t length = strnlen(from, NAME_BYTES - 1);
    for (size_t i = 0; i < length; i++) name[i] = strchr(letters, from[i]) ? from[i] : '_';
    name[length] = 0;
}

static ptie_status open_input(conversion *c) {
    const ptie_convert_params *p = c->params;
    PTIE_TRY(ptie_output_differs(p->output, p->input));
    PTIE_TRY(ptie_io_open(&c->input, p->input));
    PTIE_TRY(ptie_io_choose(&c->frames, p->frames, ptie_io_info(c->input)->frames, p->input));
    PTIE_TRY(choose_pixels(c));
    const ptie_recording_info *info = ptie_io_info(c->input);
    c->low = p->low;
    c->high = p->high;
    c->passes = p->low == p->high && ptie_io_needs_range(p->output) ? 2 : 1;
    return ptie_alloc_status(&c->frame, (size_t)info->width_px * (size_t)info->height_px,
                             sizeof *c->frame, p->input);
}

static ptie_status create_output(conversion *c, ptie_pool *pool) {
    const ptie_convert_params *p = c->params;
    char name[NAME_BYTES];
    name_map(name, ptie_io_info(c->input));
    return ptie_io_create(&c->output, &(ptie_writer_job){.path = p->output,
                                                         .name = p->name ? p->name : name,
                                                         .info = describe(c),
                                                         .overwrite = p->overwrite,
                                                         .source = p->input,
                                                         .command = p->provenance,
                                                         .compress = p->compress,
                                                         .pool = pool,
                                                         .low = c->low,
                                                         .high = c->high,
                                                         .colours = c->colours,
                                                         .played_hz = p->played_hz});
}

/* Reads frame i of the output. */
static ptie_status read_frame(conversion *c, int64_t i) {
    const ptie_convert_params *p = c->params;
    const size_t pitch = (size_t)ptie_io_info(c->input)->width_px, width = (size_t)c->roi.width_px;
    PTIE_TRY(ptie_io_read(c->input, p->frames.first + i * p->frames.step, c->frame));
    const float *from = c->frame + (size_t)c->roi.y_px * pitch + (size_t)c->roi.x_px;
    for (size_t y = 0; y < (size_t)c->roi.height_px; y++)
        memmove(c->frame + y * width, from + y * pitch, width * sizeof *from);
    return PTIE_OK;
}

static ptie_status report(conversion *c, ptie_progress progress) {
    return ptie_progress_report(progress, (uint64_t)++c->done, (uint64_t)(c->passes * c->frames), NULL);
}

/* The smallest and the largest value of all frames; before that, may the output be written at all? */
static ptie_status find_range(conversion *c, ptie_progress progress) {
    ptie_output_file output;
    PTIE_TRY(ptie_output_open(&output, c->params->output, c->params->overwrite));
    ptie_output_discard(&output);
    const size_t pixels = (size_t)c->roi.width_px * (size_t)c->roi.height_px;
    for (int64_t i = 0; i < c->frames; i++) {
        PTIE_TRY(read_frame(c, i));
        const ptie_extent extent = ptie_image_extent(c->frame, pixels);
        c->low = i ? fmin(c->low, (double)extent.low) : (double)extent.low;
        c->high = i ? fmax(c->high, (double)extent.high) : (double)extent.high;
        PTIE_TRY(report(c, progress));
    }
    if (c->params->colours == PTIE_DIVERGING) {
        c->high = fmax(fabs(c->low), fabs(c->high));
        c->low = -c->high;
    }
    return PTIE_OK;
}

static ptie_status copy_frames(conversion *c, ptie_progress progress) {
    for (int64_t i = 0; i < c->frames; i++) {
        PTIE_TRY(read_frame(c, i));
        PTIE_TRY(ptie_io_append(c->output, c->frame));
        PTIE_TRY(report(c, progress));
    }
    ptie_writer *output = c->output;
    c->output = NULL;
    return ptie_io_complete(output);
}

ptie_status ptie_convert_recording(ptie_pool *pool, const ptie_convert_params *params,
                                   const uint32_t *colours, ptie_progress progress) {
    conversion c = {.params = params, .colours = colours};
    ptie_status status = open_input(&c);
    if (status == PTIE_OK && c.passes > 1) status = find_range(&c, progress);
    if (status == PTIE_OK) status = create_output(&c, pool);
    if (status == PTIE_OK)
        status = ptie_copy_columns(c.output, params->input, ptie_io_info(c.input), params->frames, c.frames);
    if (status == PTIE_OK) status = copy_frames(&c, progress);
    ptie_io_discard(c.output);
    ptie_io_close(c.input);
    ptie_free(c.frame);
    return status;
}
