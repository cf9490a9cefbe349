/* SPDX-License-Identifier: BSD-3-Clause */
/* Transforms: one FFTW plan each way, executed on the caller's buffers. */
#include "fft/fft.h"

#include <assert.h>
#include <fftw3.h>
#include <pthread.h>

#include "base/memory.h"
#include "fft/plan.h"

/* FFTW's planner is the one part of it that is not thread-safe. */
static pthread_mutex_t planner = PTHREAD_MUTEX_INITIALIZER;

/* FFTW_ESTIMATE looks at the buffers' alignment only; they need not outlive the planning. */
static void plan_transforms(ptie_fft *fft, float *image, float *spectrum) {
    const unsigned flags = FFTW_ESTIMATE | FFTW_DESTROY_INPUT;
    const int h = fft->height, w = fft->width;
    fftwf_complex *complex_image = (fftwf_complex *)(void *)image;
    fftwf_complex *complex_spectrum = (fftwf_complex *)(void *)spectrum;
    switch (fft->kind) {
    case PTIE_FFT_REAL:
        fft->forward = fftwf_plan_dft_r2c_2d(h, w, image, complex_spectrum, flags);
        fft->inverse = fftwf_plan_dft_c2r_2d(h, w, complex_spectrum, image, flags);
        break;
    case PTIE_FFT_MIRROR:
        fft->forward = fftwf_plan_dft_r2c_2d(h, w, spectrum, complex_spectrum, flags);
        fft->inverse = fftwf_plan_dft_c2r_2d(h, w, complex_spectrum, spectrum, flags);
        break;
    case PTIE_FFT_COMPLEX:
        fft->forward =
            fftwf_plan_dft_2d(h, w, complex_image, complex_spectrum, FFTW_FORWARD, flags);
        fft->inverse =
            fftwf_plan_dft_2d(h, w, complex_spectrum, complex_image, FFTW_BACKWARD, flags);
        break;
    }
}

static ptie_status make_plans(ptie_fft *fft) {
    float *image = ptie_alloc(ptie_fft_image_floats(fft), sizeof *image);
    float *spectrum = ptie_alloc(ptie_fft_spectrum_floats(fft), sizeof *spectrum);
    if (image && spectrum) {
        pthread_mutex_lock(&planner);
        plan_transforms(fft, image, spectrum);
        pthread_mutex_unlock(&planner);
    }
    ptie_free(image);
    ptie_free(spectrum);
    if (fft->forward && fft->inverse) return PTIE_OK;
    return PTIE_FAIL(PTIE_ENOMEM, "transform: out of memory for %d x %d points", fft->width,
                     fft->height);
}

ptie_status ptie_fft_create(ptie_fft **out, ptie_fft_kind kind, int32_t width, int32_t height) {
    assert(width >= 1 && height >= 1);
    ptie_fft *fft;
    *out = NULL;
    PTIE_TRY(ptie_alloc_status(&fft, 1, sizeof *fft, "transform"));
    fft->kind = kind;
    fft->width = width;
    fft->height = height;
    fft->scale = 1.0 / ((double)width * height);
    ptie_status status = make_plans(fft);
    if (status == PTIE_OK && kind == PTIE_FFT_MIRROR) status = ptie_mirror_prepare(fft);
    if (status != PTIE_OK) {
        ptie_fft_free(fft);
        return status;
    }
    *out = fft;
    return PTIE_OK;
}

void ptie_fft_free(ptie_fft *fft) {
    if (!fft) return;
    pthread_mutex_lock(&planner);
    if (fft->forward) fftwf_destroy_plan(fft->forward);
    if (fft->inverse) fftwf_destroy_plan(fft->inverse);
    pthread_mutex_unlock(&planner);
    ptie_free(fft->turns_x);
    ptie_free(fft->turns_y);
    ptie_free(fft);
}

size_t ptie_fft_image_floats(const ptie_fft *fft) {
    return (size_t)fft->width * (size_t)fft->height * (fft->kind == PTIE_FFT_COMPLEX ? 2 : 1);
}

int32_t ptie_fft_columns(const ptie_fft *fft) {
    return fft->kind == PTIE_FFT_REAL ? fft->width / 2 + 1 : fft->width;
}

size_t ptie_fft_entry_floats(const ptie_fft *fft) {
    return fft->kind == PTIE_FFT_MIRROR ? 1 : 2;
}

size_t ptie_fft_spectrum_floats(const ptie_fft *fft) {
    if (fft->kind == PTIE_FFT_MIRROR) /* work space of mirror.c behind the entries */
        return 2 * (size_t)(fft->width / 2 + 1) * (size_t)fft->height;
    return ptie_fft_filter_floats(fft) * ptie_fft_entry_floats(fft);
}

/* New-array execution reuses a plan for any buffers aligned like the planned ones. */
static bool aligned(const float *buffer) {
    return (uintptr_t)buffer % PTIE_ALIGNMENT == 0;
}

void ptie_fft_forward(const ptie_fft *fft, float *spectrum, float *image) {
    assert(aligned(spectrum) && aligned(image) && spectrum != image);
    switch (fft->kind) {
    case PTIE_FFT_REAL:
        fftwf_execute_dft_r2c(fft->forward, image, (fftwf_complex *)(void *)spectrum);
        break;
    case PTIE_FFT_MIRROR: ptie_mirror_forward(fft, spectrum, image); break;
    case PTIE_FFT_COMPLEX:
        fftwf_execute_dft(fft->forward, (fftwf_complex *)(void *)image,
                          (fftwf_complex *)(void *)spectrum);
        break;
    }
}

void ptie_fft_inverse(const ptie_fft *fft, float *image, float *spectrum) {
    assert(aligned(spectrum) && aligned(image) && spectrum != image);
    switch (fft->kind) {
    case PTIE_FFT_REAL:
        fftwf_execute_dft_c2r(fft->inverse, (fftwf_complex *)(void *)spectrum, image);
        break;
    case PTIE_FFT_MIRROR: ptie_mirror_inverse(fft, image, spectrum); break;
    case PTIE_FFT_COMPLEX:
        fftwf_execute_dft(fft->inverse, (fftwf_complex *)(void *)spectrum,
                          (fftwf_complex *)(void *)image);
        break;
    }
    const float scale = (float)fft->scale;
    const size_t count = ptie_fft_image_floats(fft);
    for (size_t i = 0; i < count; i++) image[i] *= scale;
}

double ptie_fft_wavenumber(const ptie_fft *fft, int axis, int32_t index, double pixel_m) {
    const double pi = 3.14159265358979323846;
    const int32_t n = axis == 0 ? fft->width : fft->height;
    assert(index >= 0 && index < n);
    if (fft->kind == PTIE_FFT_MIRROR) return pi * index / (n * pixel_m);
    return 2 * pi * (index <= n / 2 ? index : index - n) / (n * pixel_m);
}
