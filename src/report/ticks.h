/* SPDX-License-Identifier: BSD-3-Clause */
/* Where an axis or a colour bar has its ticks, and what is written at them. */
#ifndef PTIE_REPORT_TICKS_H
#define PTIE_REPORT_TICKS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PTIE_MAX_TICKS 16
#define PTIE_LABEL_BYTES 32

typedef struct ptie_ticks {
    double value[PTIE_MAX_TICKS];
    int32_t count;
    int32_t exponent; /* labels are value / 10^exponent; 0 unless numbers are very large or small */
    int32_t
        decimals; /* of the labels; negative: each label stands for itself (logarithmic ticks) */
} ptie_ticks;

/* Opens an empty, inverted or not finite range, so that low < high. */
void ptie_widen(double *low, double *high);

/* The largest of 1, 2, 5 times a power of ten that is <= value > 0. */
double ptie_round_down(double value);

/* At most `most` (2..PTIE_MAX_TICKS) multiples of a round step inside low..high, low < high;
   `whole` numbers only where asked. */
void ptie_linear_ticks(ptie_ticks *ticks, double low, double high, int32_t most, bool whole);

/* Powers of ten inside low..high, 0 < low < high, with 2 and 5 between them where there is room;
   round linear steps when the range is too short for that. */
void ptie_log_ticks(ptie_ticks *ticks, double low, double high, int32_t most);

/* UTF-8 text of tick `which`, with a true minus sign. */
void ptie_tick_label(char text[PTIE_LABEL_BYTES], const ptie_ticks *ticks, int32_t which);

/* "×10⁻⁴" for labels that leave a power of ten out, "" for others. */
void ptie_tick_factor(char text[PTIE_LABEL_BYTES], const ptie_ticks *ticks);

#endif
