/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef PTIE_PREP_MEDIAN_H
#define PTIE_PREP_MEDIAN_H

#include <stddef.h>
#include <stdint.h>

/* Of finite values, 1..2^31 of them; of an even number the mean of the middle two. */
double ptie_median(const float *values, size_t count);

#endif
