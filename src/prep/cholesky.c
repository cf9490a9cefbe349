/* SPDX-License-Identifier: BSD-3-Clause */
#include "prep/cholesky.h"

#include <math.h>

bool ptie_cholesky(double *a, int32_t n) {
    for (int32_t i = 0; i < n; i++)
        for (int32_t j = 0; j <= i; j++) {
            double sum = a[i * n + j];
            for (int32_t k = 0; k < j; k++) sum -= a[i * n + k] * a[j * n + k];
            if (i != j)
                a[i * n + j] = sum / a[j * n + j];
            else if (sum > 1e-12 * a[i * n + i])
                a[i * n + i] = sqrt(sum);
            else
                return false;
        }
    return true;
}

void ptie_cholesky_solve(const double *factor, int32_t n, double *x) {
    for (int32_t i = 0; i < n; i++) {
        for (int32_t k = 0; k < i; k++) x[i] -= factor[i * n + k] * x[k];
        x[i] /= factor[i * n + i];
    }
    for (int32_t i = n - 1; i >= 0; i--) {
        for (int32_t k = i + 1; k < n; k++) x[i] -= factor[k * n + i] * x[k];
        x[i] /= factor[i * n + i];
    }
}
