/* SPDX-License-Identifier: BSD-3-Clause */
/* Two-dimensional transforms over FFTW: real periodic (r2c), real mirrored (DCT-II), complex.
 * Plans are const and thread-safe once made; buffers must be 64-byte aligned.  FFTW_ESTIMATE, so
 * that the same plan (and the same bits) comes out every time.
 */
#ifndef PTIE_FFT_FFT_H
#define PTIE_FFT_FFT_H

#include "base/status.h"

typedef enum ptie_fft_kind {
    PTIE_FFT_REAL,   /* spectrum: height x (width/2 + 1) complex */
    PTIE_FFT_MIRROR, /* spectrum: height x width real; DCT-II forward (twice the textbook's per axis,
                        as FFTW defines it), DCT-III back */
    PTIE_FFT_COMPLEX /* spectrum: height x width complex; the image is complex too */
} ptie_fft_kind;

typedef struct ptie_fft ptie_fft;

ptie_status ptie_fft_create(ptie_fft **out, ptie_fft_kind kind, int32_t width, int32_t height);
void ptie_fft_free(ptie_fft *fft);

size_t ptie_fft_image_floats(const ptie_fft *fft);
/* Of the buffer, at least as many as the entries take. */
size_t ptie_fft_spectrum_floats(const ptie_fft *fft);
/* Per entry: 2 complex, 1 real. */
size_t ptie_fft_entry_floats(const ptie_fft *fft);
int32_t ptie_fft_columns(const ptie_fft *fft); /* spectrum columns: width/2 + 1 or width */

/* inverse(forward(x)) = x: the inverse divides by the number of points.  Inputs are destroyed. */
void ptie_fft_forward(const ptie_fft *fft, float *spectrum, float *image);
void ptie_fft_inverse(const ptie_fft *fft, float *image, float *spectrum);

/* Angular frequency in rad/m of spectrum column (axis 0) or row (axis 1) `index` at `pixel_m`:
   2 pi f for PERIODIC kinds (negative above Nyquist), pi i / (n p) for the mirrored one. */
double ptie_fft_wavenumber(const ptie_fft *fft, int axis, int32_t index, double pixel_m);

/* An isotropic filter: one real factor per spectrum entry (height x columns). */
size_t ptie_fft_filter_floats(const ptie_fft *fft);
/* filter (out): response(k^2), k^2 in (rad/m)^2. */
void ptie_fft_filter_fill(const ptie_fft *fft, float *filter, double pixel_m,
                          double (*response)(double k2, const void *context), const void *context);
/* out = filter times the spectrum; out may be the spectrum. */
void ptie_fft_filter_to(const ptie_fft *fft, float *out, const float *spectrum, const float *filter);
/* Multiplies the spectrum, in place. */
void ptie_fft_filter_apply(const ptie_fft *fft, float *spectrum, const float *filter);
/* Modes of the image that an entry of this column stands for. */
int32_t ptie_fft_multiplicity(const ptie_fft *fft, int32_t column);
/* An entry's squared magnitude times its share, summed over all entries, is the image's sum of squares. */
double ptie_fft_share(const ptie_fft *fft, int32_t column, int32_t row);
/* Mean of filter^2 over all modes of the image: what it does to the variance of white noise. */
double ptie_fft_filter_power(const ptie_fft *fft, const float *filter);

#endif
