/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef PTIE_PREP_MEDIAN_H
#define PTIE_PREP_MEDIAN_H

#include <stddef.h>
#include <stdint.h>

/* Median of the values whose mask is not 0 (NULL: all); finite values, at least one of them.  Of an even number
   the mean of the middle two. */
double ptie_median(const float *values, const uint8_t *mask, size_t count);

#endif
