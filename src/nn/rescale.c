/* SPDX-License-Identifier: BSD-3-Clause */
/* From rad to the network's [0, 1] and back, docs/math-network.md (N8).
 *
 * The minimum and maximum of a noisy map say nothing about the scale of the clean one, so the way
 * back is fitted: the gain that makes the network's slopes match the measured ones.  The noise of
 * TIE falls as 1/k^4 in power: in the values it is all clouds.  The network's own errors are worst
 * at the finest scale.  Between the two lie the slopes over a few pixels.
 */
#include <string.h>

#include "base/clones.h"
#include "base/image.h"
#include "nn/denoiser.h"

enum { LANES = 8 }; /* sums side by side: a fixed order that vectorises */

/* Sum of (map - centre)^power, power 1 or 3. */
PTIE_INLINE double central_sum(const float *map, size_t count, double centre, int power) {
    double lane[LANES] = {0}, sum = 0;
    size_t i = 0;
    for (; i + LANES <= count; i += LANES)
        for (size_t k = 0; k < LANES; k++) {
            const double d = (double)map[i + k] - centre;
            lane[k] += power == 3 ? d * d * d : d;
        }
    for (; i < count; i++) {
        const double d = (double)map[i] - centre;
        lane[0] += power == 3 ? d * d * d : d;
    }
    for (size_t k = 0; k < LANES; k++) sum += lane[k];
    return sum;
}

/* Sign of the third central moment; +1 for a symmetric map. */
PTIE_CLONES static float skew_sign(const float *map, size_t count) {
    const double mean = central_sum(map, count, 0, 1) / (double)count;
    return central_sum(map, count, mean, 3) < 0 ? -1 : 1;
}

/* Side of the blocks whose means are compared, px.  The error of the result is flat from 4 to 16
 * and rises below (tools/measure-gain); the smallest asks least of a small flow. */
enum { BLOCK = 4 };

/* Sums of `count` blocks side by side, the first one's upper left pixel at `map`. */
PTIE_INLINE void sum_blocks(double *sums, const float *map, int32_t width, int32_t count,
                            int32_t side) {
    for (int32_t b = 0; b < count; b++) {
        const float *block = map + b * side;
        double sum = 0;
        for (int32_t j = 0; j < side; j++)
            for (int32_t i = 0; i < side; i++) sum += (double)block[(ptrdiff_t)j * width + i];
        sums[b] = sum;
    }
}

PTIE_CLONES static void block_row(double *sums, const float *map, int32_t width, int32_t count,
                                  int32_t side) {
    if (side == BLOCK)
        sum_blocks(sums, map, width, count, BLOCK);
    else
        sum_blocks(sums, map, width, count, side);
}

typedef struct fit {
    double product, square;
} fit;

/* Adds the differences from blocks a to blocks b. */
static void add_differences(fit *f, const double *map_a, const double *map_b,
                            const double *measured_a, const double *measured_b, int32_t count) {
    for (int32_t i = 0; i < count; i++) {
        const double d = map_b[i] - map_a[i];
        f->product += d * (measured_b[i] - measured_a[i]);
        f->square += d * d;
    }
}

/* Least squares of the measured differences between neighbouring blocks on the map's; 0 for a map
 * without structure.  The outermost sixteenth is left out: boundary conditions and padding show
 * there.  rows: work space for 4 x width numbers. */
static double fit_gain(const float *map, const float *measured, int32_t width, int32_t height,
                       double *rows) {
    const int32_t shorter = width < height ? width : height;
    const int32_t side = shorter >= 16 * BLOCK ? BLOCK : 1, margin = shorter / 16;
    const int32_t across = (width - 2 * margin) / side, down = (height - 2 * margin) / side;
    double *map_row = rows, *measured_row = rows + width;
    double *map_above = rows + 2 * (size_t)width, *measured_above = rows + 3 * (size_t)width;
    fit f = {0};
    for (int32_t y = 0; y < down; y++) {
        const size_t first = (size_t)(margin + y * side) * (size_t)width + (size_t)margin;
        block_row(map_row, map + first, width, across, side);
        block_row(measured_row, measured + first, width, across, side);
        add_differences(&f, map_row, map_row + 1, measured_row, measured_row + 1, across - 1);
        if (y) add_differences(&f, map_above, map_row, measured_above, measured_row, across);
        double *const map_free = map_above, *const measured_free = measured_above;
        map_above = map_row, measured_above = measured_row;
        map_row = map_free, measured_row = measured_free;
    }
    return f.square > 0 ? f.product / f.square : 0;
}

/* Level of the flow-free background: the 15 % quantile, which is the median of the lowest 30 %, to
   a four-thousandth of the range. */
static float background_level(const float *map, size_t count) {
    enum { BINS = 4096 };
    uint32_t histogram[BINS] = {0};
    const ptie_extent range = ptie_image_extent(map, count);
    const double low = (double)range.low;
    if (!(range.high > range.low)) return range.low;
    const double bins_per_unit = BINS / ((double)range.high - low);
    for (size_t i = 0; i < count; i++) {
        size_t bin = (size_t)(((double)map[i] - low) * bins_per_unit);
        histogram[bin < BINS ? bin : BINS - 1]++;
    }
    size_t below = 0, bin = 0;
    while (bin < BINS - 1 && (double)(below + histogram[bin]) < 0.15 * (double)count)
        below += histogram[bin++];
    return (float)(low + ((double)bin + 0.5) / bins_per_unit);
}

ptie_status ptie_nn_denoise_rad(const ptie_denoiser *denoiser, float *clean_rad,
                                const float *noisy_rad, int32_t polarity, void *scratch) {
    const int32_t width = denoiser->width, height = denoiser->height;
    const size_t count = (size_t)width * (size_t)height;
    const ptie_denoise_scratch slices = ptie_denoise_slice(denoiser, scratch);
    float *image = slices.image;
    PTIE_TRY(ptie_image_finite(noisy_rad, width, height, "noisy_rad"));
    const float sign = polarity ? (float)polarity : skew_sign(noisy_rad, count);
    const ptie_extent found = ptie_image_extent(noisy_rad, count);
    if (!(found.high > found.low)) { /* nothing to see */
        memset(clean_rad, 0, count * sizeof *clean_rad);
        return PTIE_OK;
    }
    const float lowest = sign > 0 ? found.low : -found.high, range = found.high - found.low;
    for (size_t i = 0; i < count; i++) image[i] = (sign * noisy_rad[i] - lowest) / range;
    /* The result may take the place of the input, so the measured map is kept as the network sees
     * it. */
    PTIE_TRY(ptie_denoise_finite(denoiser, clean_rad, image, scratch));
    const double gain = fit_gain(clean_rad, image, width, height, slices.rows);
    const float background = background_level(clean_rad, count);
    const float scale = (float)(gain * (double)(sign * range));
    for (size_t i = 0; i < count; i++) clean_rad[i] = scale * (clean_rad[i] - background);
    return PTIE_OK;
}
