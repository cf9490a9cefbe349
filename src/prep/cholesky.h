/* SPDX-License-Identifier: BSD-3-Clause */
/* Small symmetric positive definite systems, as least squares makes them. */
#ifndef PTIE_PREP_CHOLESKY_H
#define PTIE_PREP_CHOLESKY_H

#include <stdbool.h>
#include <stdint.h>

/* a (n, n), of which the lower triangle is read, becomes its factor there.  False, and nothing
   usable, if a is not positive definite to 12 digits. */
bool ptie_cholesky(double *a, int32_t n);

/* x (in): the right-hand side; (out): the solution. */
void ptie_cholesky_solve(const double *factor, int32_t n, double *x);

#endif
