/* SPDX-License-Identifier: BSD-3-Clause */
#include "run/channels.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

static const char *const side_names[] = {"left", "right"};
static const char *const row_names[] = {"top", "bottom"};
static const char *const quadrant_names[] = {"tl", "tr", "bl", "br"};

/* Sony IMX250MZR and its kin; Photron CRYSTA, 0 45 90 135 clockwise. */
static const struct {
    const char *name;
    int32_t angle_deg[PTIE_CHANNELS];
} mosaics[] = {{"sony", {90, 45, 135, 0}}, {"crysta", {0, 45, 135, 90}}};

int32_t ptie_channel_count(ptie_layout layout) {
    static const int32_t counts[] = {0, 4, 2, 2, 4};
    return counts[layout];
}

void ptie_channel_name(char name[PTIE_CHANNEL_BYTES], const ptie_rig *rig, int32_t channel) {
    static const char *const *const names[] = {NULL, NULL, side_names, row_names, quadrant_names};
    if (rig->layout == PTIE_LAYOUT_MOSAIC)
        snprintf(name, PTIE_CHANNEL_BYTES, "%d", rig->angle_deg[channel]);
    else
        snprintf(name, PTIE_CHANNEL_BYTES, "%s", names[rig->layout][channel]);
}

static int32_t find_channel(const ptie_rig *rig, const char *word, size_t length) {
    for (int32_t c = 0; c < ptie_channel_count(rig->layout); c++) {
        char name[PTIE_CHANNEL_BYTES];
        ptie_channel_name(name, rig, c);
        if (strlen(name) == length && strncmp(name, word, length) == 0) return c;
    }
    return -1;
}

/* Skips white space. */
static const char *next(const char *text) {
    while (isspace((unsigned char)*text)) text++;
    return text;
}

/* "0.98*45", "45"; text goes behind it.  False if it is neither. */
static bool parse_term(double mix[PTIE_CHANNELS], const ptie_rig *rig, const char **text, double sign) {
    char *end;
    double weight = ptie_scan_number(*text, &end);
    if (end != *text && *next(end) == '*')
        *text = next(next(end) + 1);
    else
        weight = 1;
    const size_t length = strspn(*text, "abcdefghijklmnopqrstuvwxyz0123456789");
    const int32_t channel = find_channel(rig, *text, length);
    if (channel < 0 || !(weight > -1e6 && weight < 1e6)) return false;
    mix[channel] += sign * weight;
    *text = next(*text + length);
    return true;
}

const char *ptie_mix_parse(double mix[PTIE_CHANNELS], const ptie_rig *rig, const char *text,
                           char expected[128]) {
    char first[PTIE_CHANNEL_BYTES], second[PTIE_CHANNEL_BYTES];
    ptie_channel_name(first, rig, 0);
    ptie_channel_name(second, rig, 1);
    snprintf(expected, 128, "channels of the layout such as '%s' or '0.98*%s + 0.02*%s'", first, first, second);
    double sum[PTIE_CHANNELS] = {0}, size = 0;
    for (text = next(text);;) {
        double sign = 1;
        if (*text == '+' || *text == '-') {
            sign = *text == '-' ? -1 : 1;
            text = next(text + 1);
        }
        if (!parse_term(sum, rig, &text, sign)) return expected;
        if (!*text) break;
        if (*text != '+' && *text != '-') return expected;
    }
    for (int c = 0; c < PTIE_CHANNELS; c++) size += sum[c] * sum[c];
    if (size == 0) return expected;
    memcpy(mix, sum, sizeof sum);
    return NULL;
}

void ptie_mix_print(ptie_text *out, const ptie_rig *rig, const double mix[PTIE_CHANNELS]) {
    bool first = true;
    for (int32_t c = 0; c < ptie_channel_count(rig->layout); c++) {
        char name[PTIE_CHANNEL_BYTES], number[PTIE_QUANTITY_BYTES];
        if (mix[c] == 0) continue;
        ptie_channel_name(name, rig, c);
        const double size = mix[c] < 0 ? -mix[c] : mix[c];
        ptie_text_append(out, "%s", mix[c] < 0 ? (first ? "-" : " - ") : (first ? "" : " + "));
        if (size != 1) ptie_text_append(out, "%s*", ptie_print_quantity(number, size, PTIE_NUMBER));
        ptie_text_append(out, "%s", name);
        first = false;
    }
}

static const char *parse_mosaic(void *field, const char *text) {
    static const char expected[] = "sony, crysta or four different angles such as 90 45 135 0";
    int32_t *angle_deg = field;
    for (size_t i = 0; i < sizeof mosaics / sizeof *mosaics; i++)
        if (strcmp(text, mosaics[i].name) == 0) {
            memcpy(angle_deg, mosaics[i].angle_deg, sizeof mosaics[i].angle_deg);
            return NULL;
        }
    int32_t angle[PTIE_CHANNELS], used = 0;
    if (sscanf(text, "%4d %4d %4d %4d%n", &angle[0], &angle[1], &angle[2], &angle[3], &used) != PTIE_CHANNELS ||
        text[used])
        return expected;
    for (int c = 0; c < PTIE_CHANNELS; c++) {
        if (angle[c] < 0 || angle[c] >= 180) return expected;
        for (int d = 0; d < c; d++)
            if (angle[c] == angle[d]) return expected;
    }
    memcpy(angle_deg, angle, sizeof angle);
    return NULL;
}

static void print_mosaic(ptie_text *out, const void *field) {
    const int32_t *angle_deg = field;
    if (memcmp(angle_deg, (int32_t[PTIE_CHANNELS]){0}, sizeof(int32_t[PTIE_CHANNELS])) == 0) return;
    for (size_t i = 0; i < sizeof mosaics / sizeof *mosaics; i++)
        if (memcmp(angle_deg, mosaics[i].angle_deg, sizeof mosaics[i].angle_deg) == 0) {
            ptie_text_append(out, "%s", mosaics[i].name);
            return;
        }
    ptie_text_append(out, "%d %d %d %d", angle_deg[0], angle_deg[1], angle_deg[2], angle_deg[3]);
}

const ptie_ini_type ptie_mosaic_type = {parse_mosaic, print_mosaic};
