/* SPDX-License-Identifier: BSD-3-Clause */
#include "optics/mosaic.h"

#include <stdio.h>
#include <string.h>

enum { ANGLES = 4 };

/* Sony IMX250MZR and its kin; Photron CRYSTA, 0 45 90 135 clockwise. */
static const struct {
    const char *name;
    int32_t angle_deg[ANGLES];
} mosaics[] = {{"sony", {90, 45, 135, 0}}, {"crysta", {0, 45, 135, 90}}};

static const char *parse_mosaic(void *field, const char *text) {
    static const char expected[] = "sony, crysta or four different angles such as 90 45 135 0";
    int32_t *angle_deg = field;
    for (size_t i = 0; i < sizeof mosaics / sizeof *mosaics; i++)
        if (strcmp(text, mosaics[i].name) == 0) {
            memcpy(angle_deg, mosaics[i].angle_deg, sizeof mosaics[i].angle_deg);
            return NULL;
        }
    int32_t angle[ANGLES], used = 0;
    if (sscanf(text, "%4d %4d %4d %4d%n", &angle[0], &angle[1], &angle[2], &angle[3], &used) != ANGLES ||
        text[used])
        return expected;
    for (int c = 0; c < ANGLES; c++) {
        if (angle[c] < 0 || angle[c] >= 180) return expected;
        for (int d = 0; d < c; d++)
            if (angle[c] == angle[d]) return expected;
    }
    memcpy(angle_deg, angle, sizeof angle);
    return NULL;
}

static void print_mosaic(ptie_text *out, const void *field) {
    const int32_t *angle_deg = field;
    if (memcmp(angle_deg, (int32_t[ANGLES]){0}, sizeof(int32_t[ANGLES])) == 0) return;
    for (size_t i = 0; i < sizeof mosaics / sizeof *mosaics; i++)
        if (memcmp(angle_deg, mosaics[i].angle_deg, sizeof mosaics[i].angle_deg) == 0) {
            ptie_text_append(out, "%s", mosaics[i].name);
            return;
        }
    ptie_text_append(out, "%d %d %d %d", angle_deg[0], angle_deg[1], angle_deg[2], angle_deg[3]);
}

const ptie_ini_type ptie_mosaic_type = {parse_mosaic, print_mosaic};
