/* SPDX-License-Identifier: BSD-3-Clause */
#include "report/ticks.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"

/* Slack for multiples of the step that rounding puts just outside the range. */
#define SLACK 1e-9

void ptie_widen(double *low, double *high) {
    if (isfinite(*low) && isfinite(*high) && *low < *high) return;
    double centre = isfinite(*low) ? *low : 0;
    double half = centre != 0 ? 0.1 * fabs(centre) : 1;
    *low = centre - half;
    *high = centre + half;
}

static int32_t decade(double value) {
    return (int32_t)floor(log10(value) + SLACK);
}

static double power_of_ten(int32_t exponent) {
    return pow(10, exponent);
}

double ptie_round_down(double value) {
    double ten = power_of_ten(decade(value)), mantissa = value / ten + SLACK;
    return ten * (mantissa >= 5 ? 5 : mantissa >= 2 ? 2 : 1);
}

/* The next step after `step`: 1, 2, 5, 10. */
static double next_step(double step) {
    double mantissa = step / power_of_ten(decade(step));
    return mantissa > 1.5 && mantissa < 3 ? step * 2.5 : step * 2;
}

static int32_t multiples(double low, double high, double step) {
    return (int32_t)(floor(high / step + SLACK) - ceil(low / step - SLACK)) + 1;
}

void ptie_linear_ticks(ptie_ticks *ticks, double low, double high, int32_t most, bool whole) {
    double step = ptie_round_down((high - low) / most);
    if (whole && step < 1) step = 1;
    while (multiples(low, high, step) > most) step = next_step(step);
    *ticks = (ptie_ticks){.count = multiples(low, high, step)};
    double first = ceil(low / step - SLACK);
    for (int32_t i = 0; i < ticks->count; i++) ticks->value[i] = (first + i) * step + 0.0;
    int32_t size = decade(fmax(fabs(low), fabs(high)));
    if (size >= 5 || size <= -3) ticks->exponent = size;
    int32_t decimals = ticks->exponent - decade(step);
    ticks->decimals = decimals > 0 ? decimals : 0;
}

/* Adds each of `mantissas` times every `stride`-th power of ten; false when there is no room. */
static bool add_decades(ptie_ticks *ticks, double low, double high, int32_t most, int32_t stride,
                        const char *mantissas) {
    *ticks = (ptie_ticks){.decimals = -1};
    for (int32_t e = decade(low); e <= decade(high) + 1; e++) {
        if (e % stride != 0) continue;
        for (const char *m = mantissas; *m; m++) {
            double value = (*m - '0') * power_of_ten(e);
            if (value < low * (1 - SLACK) || value > high * (1 + SLACK)) continue;
            if (ticks->count == most) return false;
            ticks->value[ticks->count++] = value;
        }
    }
    return true;
}

void ptie_log_ticks(ptie_ticks *ticks, double low, double high, int32_t most) {
    bool fits = add_decades(ticks, low, high, most, 1, "125");
    for (int32_t stride = 1; !fits; stride++)
        fits = add_decades(ticks, low, high, most, stride, "1");
    if (ticks->count < 3 && high < 100 * low) ptie_linear_ticks(ticks, low, high, most, false);
}

/* Appends 10^exponent in superscript digits. */
static void append_power(char text[PTIE_LABEL_BYTES], int32_t exponent) {
    static const char *const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    char plain[16];
    snprintf(plain, sizeof plain, "%d", (int)exponent);
    size_t used = strlen(text);
    used += (size_t)snprintf(text + used, PTIE_LABEL_BYTES - used, "10");
    for (const char *c = plain; *c && used < PTIE_LABEL_BYTES; c++)
        used += (size_t)snprintf(text + used, PTIE_LABEL_BYTES - used, "%s",
                                 *c == '-' ? "⁻" : digits[*c - '0']);
}

static void log_label(char text[PTIE_LABEL_BYTES], double value) {
    int32_t exponent = decade(value);
    double mantissa = value / power_of_ten(exponent);
    text[0] = 0;
    if (exponent >= -3 && exponent <= 3) {
        ptie_print(text, PTIE_LABEL_BYTES, "%g", value);
        return;
    }
    if (mantissa > 1.5) ptie_print(text, PTIE_LABEL_BYTES, "%.0f×", mantissa);
    append_power(text, exponent);
}

void ptie_tick_label(char text[PTIE_LABEL_BYTES], const ptie_ticks *ticks, int32_t which) {
    double value = ticks->value[which];
    if (ticks->decimals < 0) {
        log_label(text, value);
        return;
    }
    const char *sign = value < 0 ? "−" : "";
    ptie_print(text, PTIE_LABEL_BYTES, "%s%.*f", sign, (int)ticks->decimals,
             fabs(value) / power_of_ten(ticks->exponent));
}

void ptie_tick_factor(char text[PTIE_LABEL_BYTES], const ptie_ticks *ticks) {
    text[0] = 0;
    if (ticks->exponent == 0) return;
    snprintf(text, PTIE_LABEL_BYTES, "×");
    append_power(text, ticks->exponent);
}
