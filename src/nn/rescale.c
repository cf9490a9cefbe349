/* SPDX-License-Identifier: BSD-3-Clause */
/* From rad to the network's [0, 1] and back, docs/math-network.md (N8).
 *
 * The minimum and maximum of a noisy map say nothing about the scale of the clean one, so the way
 * back is fitted: the gain that makes the network's slopes match the measured ones.  The noise of
 * TIE falls as 1/k^4 in power: in the values it is all clouds.  The network's own errors are worst
 * at the finest scale.  Between the two lie the slopes over a few pixels.
 */
#include <string.h>

#include "base/image.h"
#include "nn/denoiser.h"

/* Sign of the third central moment; +1 for a symmetric map. */
static float skew_sign(const float *map, size_t count) {
    double mean = 0, third = 0;
    for (size_t i = 0; i < count; i++) mean += (double)map[i];
    mean /= (double)count;
    for (size_t i = 0; i < count; i++) {
        double d = (double)map[i] - mean;
        third += d * d * d;
    }
    return third < 0 ? -1 : 1;
}

static void find_range(const float *map, size_t count, float *low, float *high) {
    *low = *high = map[0];
    for (size_t i = 1; i < count; i++) {
        if (map[i] < *low) *low = map[i];
        if (map[i] > *high) *high = map[i];
    }
}

/* Side of the blocks whose means are compared, px.  The error of the result is flat from 4 to 16
 * and rises below (tools/measure-gain); the smallest asks least of a small flow. */
enum { BLOCK = 4 };

static double block_mean(const float *map, int32_t width, int32_t x, int32_t y, int32_t side) {
    double sum = 0;
    for (int32_t j = 0; j < side; j++)
        for (int32_t i = 0; i < side; i++)
            sum += (double)map[(size_t)(y + j) * (size_t)width + (size_t)(x + i)];
    return sum / (double)(side * side);
}

/* Least squares of the measured differences between neighbouring blocks on the map's; 0 for a map
 * without structure.  The outermost sixteenth is left out: boundary conditions and padding show
 * there. */
static double fit_gain(const float *map, const float *measured, int32_t width, int32_t height) {
    const int32_t shorter = width < height ? width : height;
    const int32_t side = shorter >= 16 * BLOCK ? BLOCK : 1, margin = shorter / 16;
    /* Of the last block with a neighbour; a line of pixels has neighbours along itself only. */
    const int32_t right = width > 1 ? width - margin - 2 * side : 0;
    const int32_t bottom = height > 1 ? height - margin - 2 * side : 0;
    double product = 0, square = 0;
    for (int32_t y = margin; y <= bottom; y += side)
        for (int32_t x = margin; x <= right; x += side) {
            const double map_here = block_mean(map, width, x, y, side);
            const double here = block_mean(measured, width, x, y, side);
            const int32_t next[2][2] = {{x + side, y}, {x, y + side}};
            for (int axis = 0; axis < 2; axis++) {
                const int32_t *at = next[axis];
                if (at[0] >= width || at[1] >= height) continue;
                double d = block_mean(map, width, at[0], at[1], side) - map_here;
                product += d * (block_mean(measured, width, at[0], at[1], side) - here);
                square += d * d;
            }
        }
    return square > 0 ? product / square : 0;
}

/* Level of the flow-free background: the 15 % quantile, which is the median of the lowest 30 %, to
   a four-thousandth of the range. */
static float background_level(const float *map, size_t count) {
    enum { BINS = 4096 };
    uint32_t histogram[BINS] = {0};
    float low, high;
    find_range(map, count, &low, &high);
    if (!(high > low)) return low;
    const double bins_per_unit = BINS / ((double)high - (double)low);
    for (size_t i = 0; i < count; i++) {
        size_t bin = (size_t)(((double)map[i] - (double)low) * bins_per_unit);
        histogram[bin < BINS ? bin : BINS - 1]++;
    }
    size_t below = 0, bin = 0;
    while (bin < BINS - 1 && (double)(below + histogram[bin]) < 0.15 * (double)count)
        below += histogram[bin++];
    return (float)((double)low + ((double)bin + 0.5) / bins_per_unit);
}

ptie_status ptie_nn_denoise_rad(const ptie_denoiser *denoiser, float *clean_rad,
                                const float *noisy_rad, int32_t polarity, void *scratch) {
    const int32_t width = denoiser->width, height = denoiser->height;
    const size_t count = (size_t)width * (size_t)height;
    float *image = ptie_denoise_slice(denoiser, scratch).image;
    float low, high;
    PTIE_TRY(ptie_image_finite(noisy_rad, width, height, "noisy_rad"));
    const float sign = polarity ? (float)polarity : skew_sign(noisy_rad, count);
    find_range(noisy_rad, count, &low, &high);
    if (!(high > low)) { /* nothing to see */
        memset(clean_rad, 0, count * sizeof *clean_rad);
        return PTIE_OK;
    }
    const float lowest = sign > 0 ? low : -high, range = high - low;
    for (size_t i = 0; i < count; i++) image[i] = (sign * noisy_rad[i] - lowest) / range;
    /* The result may take the place of the input, so the measured map is kept as the network sees
     * it. */
    PTIE_TRY(ptie_denoise_finite(denoiser, clean_rad, image, scratch));
    const double gain = fit_gain(clean_rad, image, width, height);
    const float background = background_level(clean_rad, count);
    const float scale = (float)(gain * (double)(sign * range));
    for (size_t i = 0; i < count; i++) clean_rad[i] = scale * (clean_rad[i] - background);
    return PTIE_OK;
}
