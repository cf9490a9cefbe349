/* SPDX-License-Identifier: BSD-3-Clause */
/* Channels of one sensor image: parts of the frame, or every other pixel of a mosaic.  docs/math.md
 * (P2). */
#include <math.h>
#include <string.h>

#include "base/clones.h"
#include "base/memory.h"
#include "fft/fft.h"
#include "prep/prep.h"

struct ptie_splitter {
    ptie_splitter_params params;
    int32_t channels, width, height; /* of a channel */
    ptie_fft *fft;                   /* of PTIE_DEMOSAIC_FOURIER, else NULL */
    float *turns_x,
        *turns_y; /* likewise: (cos, sin) per spectrum column and row of a move by +1/4 */
};

void ptie_splitter_params_init(ptie_splitter_params *params) {
    *params = (ptie_splitter_params){.struct_size = sizeof *params,
                                     .layout = PTIE_LAYOUT_MOSAIC,
                                     .demosaic = PTIE_DEMOSAIC_BILINEAR};
}

/* exp(i k / 4) for each index of an axis; at the Nyquist frequency its real part, which is what a
   real image shows of it. */
static ptie_status fill_turns(float **turns, const ptie_fft *fft, int axis, int32_t count,
                              int32_t points) {
    PTIE_TRY(ptie_alloc_status(turns, 2 * (size_t)count, sizeof **turns, "splitter"));
    for (int32_t i = 0; i < count; i++) {
        const double angle = ptie_fft_wavenumber(fft, axis, i, 1) / 4;
        (*turns)[2 * i] = (float)cos(angle);
        (*turns)[2 * i + 1] = 2 * i == points ? 0 : (float)sin(angle);
    }
    return PTIE_OK;
}

static ptie_status plan_fourier(ptie_splitter *s) {
    PTIE_TRY(ptie_fft_create(&s->fft, PTIE_FFT_REAL, s->width, s->height));
    PTIE_TRY(fill_turns(&s->turns_x, s->fft, 0, ptie_fft_columns(s->fft), s->width));
    return fill_turns(&s->turns_y, s->fft, 1, s->height, s->height);
}

ptie_status ptie_prep_splitter(ptie_splitter **out, const ptie_splitter_params *params) {
    static const int32_t across[] = {1, 2, 2, 1, 2}, down[] = {1, 2, 1, 2, 2}; /* per layout */
    *out = NULL;
    ptie_splitter *s;
    PTIE_TRY(ptie_alloc_status(&s, 1, sizeof *s, "splitter"));
    s->params = *params;
    s->channels = across[params->layout] * down[params->layout];
    s->width = params->width_px / across[params->layout];
    s->height = params->height_px / down[params->layout];
    const bool fourier =
        params->layout == PTIE_LAYOUT_MOSAIC && params->demosaic == PTIE_DEMOSAIC_FOURIER;
    const ptie_status status = fourier ? plan_fourier(s) : PTIE_OK;
    if (status == PTIE_OK)
        *out = s;
    else
        ptie_splitter_free(s);
    return status;
}

void ptie_splitter_free(ptie_splitter *s) {
    if (!s) return;
    ptie_fft_free(s->fft);
    ptie_free(s->turns_x);
    ptie_free(s->turns_y);
    ptie_free(s);
}

int32_t ptie_splitter_channels(const ptie_splitter *s, int32_t *width_px, int32_t *height_px) {
    *width_px = s->width;
    *height_px = s->height;
    return s->channels;
}

/* A channel and its spectrum. */
typedef struct scratch {
    float *image, *spectrum;
} scratch;

static scratch carve(ptie_slicer *slicer, const ptie_splitter *s) {
    if (!s->fft) return (scratch){NULL, NULL};
    float *image = ptie_slice(slicer, ptie_fft_image_floats(s->fft), sizeof(float));
    return (scratch){image, ptie_slice(slicer, ptie_fft_spectrum_floats(s->fft), sizeof(float))};
}

size_t ptie_prep_splitter_scratch(const ptie_splitter *s) {
    ptie_slicer slicer = {0};
    carve(&slicer, s);
    return slicer.used;
}

/* Every other pixel of every other row. */
PTIE_CLONES static void pick(float *restrict out, const float *restrict image, int32_t pitch,
                             int32_t width, int32_t height) {
    for (int32_t y = 0; y < height; y++)
        for (int32_t x = 0; x < width; x++)
            out[(ptrdiff_t)y * width + x] = image[2 * ((ptrdiff_t)y * pitch + x)];
}

/* One row between two of a channel: 3/4 of the nearer pixel, 1/4 of the next in the direction of
   `step`; beyond the frame the image is mirrored. */
PTIE_CLONES static void blend_row(float *restrict out, const float *near, const float *far,
                                  int32_t step, int32_t width) {
    const int32_t first = step < 0, last = step < 0 ? width : width - 1,
                  edge = step < 0 ? 0 : width - 1;
    for (int32_t x = first; x < last; x++) {
        const float a = 0.75f * near[2 * x] + 0.25f * far[2 * x];
        const float b = 0.75f * near[2 * (x + step)] + 0.25f * far[2 * (x + step)];
        out[x] = 0.75f * a + 0.25f * b;
    }
    out[edge] = 0.75f * near[2 * edge] + 0.25f * far[2 * edge];
}

static void blend(float *out, const float *image, int32_t pitch, int32_t step_x, int32_t step_y,
                  int32_t width, int32_t height) {
    for (int32_t y = 0; y < height; y++) {
        const int32_t next = y + step_y < 0 || y + step_y >= height ? y : y + step_y;
        blend_row(out + (ptrdiff_t)y * width, image + 2 * (ptrdiff_t)y * pitch,
                  image + 2 * (ptrdiff_t)next * pitch, step_x, width);
    }
}

/* A row of the spectrum, moved by a quarter in the directions of the steps. */
PTIE_CLONES static void turn_row(float *restrict row, const float *restrict turns_x, float step_x,
                                 float re_y, float im_y, int32_t columns) {
    for (int32_t x = 0; x < columns; x++) {
        const float re_x = turns_x[2 * x], im_x = step_x * turns_x[2 * x + 1];
        const float re_t = re_x * re_y - im_x * im_y, im_t = re_x * im_y + im_x * re_y;
        const float re = row[2 * x], im = row[2 * x + 1];
        row[2 * x] = re * re_t - im * im_t;
        row[2 * x + 1] = re * im_t + im * re_t;
    }
}

static void shift(const ptie_splitter *s, float *out, const float *image, int32_t step_x,
                  int32_t step_y, scratch work) {
    const int32_t columns = ptie_fft_columns(s->fft);
    pick(work.image, image, s->params.width_px, s->width, s->height);
    ptie_fft_forward(s->fft, work.spectrum, work.image);
    for (int32_t y = 0; y < s->height; y++)
        turn_row(work.spectrum + 2 * (ptrdiff_t)y * columns, s->turns_x, (float)step_x,
                 s->turns_y[2 * y], (float)step_y * s->turns_y[2 * y + 1], columns);
    ptie_fft_inverse(s->fft, work.image, work.spectrum);
    memcpy(out, work.image, (size_t)s->width * (size_t)s->height * sizeof *out);
}

/* Channel c of a mosaic; in the recorded cells it stands at (cx, cy), and the cell's centre is
   towards the other side. */
static void split_mosaic(const ptie_splitter *s, float *out, const float *image, int32_t c,
                         scratch work) {
    const int32_t pitch = s->params.width_px;
    const int32_t cx = (c ^ s->params.roi_x_px) & 1, cy = (c / 2 ^ s->params.roi_y_px) & 1;
    const float *first = image + (ptrdiff_t)cy * pitch + cx;
    switch (s->params.demosaic) {
    case PTIE_DEMOSAIC_NONE: pick(out, first, pitch, s->width, s->height); break;
    case PTIE_DEMOSAIC_BILINEAR:
        blend(out, first, pitch, 1 - 2 * cx, 1 - 2 * cy, s->width, s->height);
        break;
    case PTIE_DEMOSAIC_FOURIER: shift(s, out, first, 1 - 2 * cx, 1 - 2 * cy, work); break;
    }
}

/* Channel c of a frame that is divided into parts. */
static void split_part(const ptie_splitter *s, float *out, const float *image, int32_t c) {
    const int32_t across = s->params.width_px / s->width;
    const float *corner =
        image + (ptrdiff_t)(c / across) * s->height * s->params.width_px + c % across * s->width;
    for (int32_t y = 0; y < s->height; y++)
        memcpy(out + (ptrdiff_t)y * s->width, corner + (ptrdiff_t)y * s->params.width_px,
               (size_t)s->width * sizeof *out);
}

void ptie_prep_split(const ptie_splitter *s, float *const *channel, const float *image,
                     void *scratch_block) {
    ptie_slicer slicer = {.base = scratch_block};
    const scratch work = carve(&slicer, s);
    for (int32_t c = 0; c < s->channels; c++) {
        if (!channel[c]) continue;
        if (s->params.layout == PTIE_LAYOUT_MOSAIC)
            split_mosaic(s, channel[c], image, c, work);
        else
            split_part(s, channel[c], image, c);
    }
}
