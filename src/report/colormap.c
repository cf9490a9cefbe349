/* SPDX-License-Identifier: BSD-3-Clause */
#include "report/colormap.h"

#include <math.h>

/* Control points, equally spaced from 0 to 1, and linear between them. */
typedef struct table {
    int32_t count;
    uint32_t colour[18];
} table;

static const table tables[] = {
    [PTIE_GRAY] = {2, {0x000000, 0xffffff}},
    /* Every 15th of the 256 entries of viridis (S. van der Walt and N. Smith, 2015; CC0). */
    [PTIE_VIRIDIS] = {18,
                      {0x440154, 0x481769, 0x472a7a, 0x433d84, 0x3d4e8a, 0x355e8d, 0x2e6d8e,
                       0x297b8e, 0x23898e, 0x1f978b, 0x21a585, 0x2eb37c, 0x46c06f, 0x65cb5e,
                       0x89d548, 0xb0dd2f, 0xd8e219, 0xfde725}},
    /* RdBu of ColorBrewer (C. Brewer), from blue to red, with pure white in the middle. */
    [PTIE_DIVERGING] = {11,
                        {0x053061, 0x2166ac, 0x4393c3, 0x92c5de, 0xd1e5f0, 0xffffff, 0xfddbc7,
                         0xf4a582, 0xd6604d, 0xb2182b, 0x67001f}},
};

static uint32_t mixed(uint32_t a, uint32_t b, double share, int shift) {
    double low = (double)(a >> shift & 255), high = (double)(b >> shift & 255);
    return (uint32_t)lround(low + share * (high - low)) << shift;
}

uint32_t ptie_colour(ptie_colormap map, double position) {
    if (isnan(position)) return PTIE_NAN_COLOUR;
    const table *t = &tables[map];
    double place = fmin(fmax(position, 0), 1) * (t->count - 1);
    int32_t i = (int32_t)place;
    if (i == t->count - 1) return t->colour[i];
    uint32_t a = t->colour[i], b = t->colour[i + 1];
    double share = place - i;
    return mixed(a, b, share, 16) | mixed(a, b, share, 8) | mixed(a, b, share, 0);
}

uint32_t ptie_curve_colour(int32_t index) {
    static const uint32_t cycle[] = {0x0072b2, 0xd55e00, 0x009e73, 0xe69f00,
                                     0xcc79a7, 0x56b4e9, 0x000000, 0xf0e442};
    return cycle[(uint32_t)index % 8];
}
