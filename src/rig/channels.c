/* SPDX-License-Identifier: BSD-3-Clause */
#include "rig/channels.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

static const char *const side_names[] = {"left", "right"};
static const char *const row_names[] = {"top", "bottom"};
static const char *const quadrant_names[] = {"tl", "tr", "bl", "br"};

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
static bool parse_term(double mix[PTIE_CHANNELS], const ptie_rig *rig, const char **text,
                       double sign) {
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
    snprintf(expected, 128, "channels of the layout such as '%s' or '0.98*%s + 0.02*%s'", first,
             first, second);
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
