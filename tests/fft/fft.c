/* SPDX-License-Identifier: BSD-3-Clause */
/* Transforms against direct sums and by their identities, for every kind and any size. */
#include "support/support.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/random.h"
#include "fft/fft.h"

#define PI 3.14159265358979323846

/* CMPLX of C11, which clang does not find in every C library. */
static double complex complex_of(double re, double im) {
    return re + im * (double complex)I;
}

static const ptie_fft_kind kinds[] = {PTIE_FFT_REAL, PTIE_FFT_MIRROR, PTIE_FFT_COMPLEX};
static const int32_t sizes[][2] = {{1, 1},   {1, 9},   {2, 2},   {3, 2},  {16, 16}, {17, 31},
                                   {30, 14}, {64, 48}, {97, 89}, {11, 1}, {127, 4}};
enum { KINDS = 3, SIZES = sizeof sizes / sizeof *sizes };

/* A plan with its buffers. */
typedef struct setup {
    ptie_fft *fft;
    float *image, *spectrum;
    size_t image_floats, spectrum_floats;
} setup;

static setup make(ptie_fft_kind kind, int32_t width, int32_t height) {
    setup s;
    assert_ok(ptie_fft_create(&s.fft, kind, width, height));
    s.image_floats = ptie_fft_image_floats(s.fft);
    s.spectrum_floats = ptie_fft_spectrum_floats(s.fft);
    s.image = ptie_alloc(s.image_floats, sizeof(float));
    s.spectrum = ptie_alloc(s.spectrum_floats, sizeof(float));
    assert_true(s.image && s.spectrum);
    return s;
}

static void drop(setup *s) {
    ptie_fft_free(s->fft);
    ptie_free(s->image);
    ptie_free(s->spectrum);
}

static void fill(float *values, size_t count, uint64_t which) {
    ptie_random random;
    ptie_random_init(&random, 1, PTIE_STREAM_TEXTURE, which);
    ptie_random_normals(&random, values, count);
}

static float *copy_of(const float *values, size_t count) {
    float *copy = malloc(count * sizeof *copy);
    assert_non_null(copy);
    memcpy(copy, values, count * sizeof *copy);
    return copy;
}

/* Kernel of one axis, as FFTW defines it: exp(-2 pi i j k / n), or 2 cos(pi (j + 1/2) k / n). */
static double complex kernel(ptie_fft_kind kind, int32_t j, int32_t k, int32_t n) {
    if (kind == PTIE_FFT_MIRROR) return 2 * cos(PI * (2 * j + 1) * k / (2 * n));
    return cexp(complex_of(0, -2 * PI * (double)((int64_t)j * k % n) / n));
}

static double complex element(ptie_fft_kind kind, const float *image, int32_t i) {
    if (kind != PTIE_FFT_COMPLEX) return (double)image[i];
    return complex_of((double)image[2 * i], (double)image[2 * i + 1]);
}

/* The whole transform by its definition, rows then columns.  out: height x width. */
static void direct(double complex *out, ptie_fft_kind kind, const float *image, int32_t w,
                   int32_t h) {
    double complex *rows = calloc((size_t)w * (size_t)h, sizeof *rows);
    assert_non_null(rows);
    for (int32_t y = 0; y < h; y++)
        for (int32_t k = 0; k < w; k++)
            for (int32_t x = 0; x < w; x++)
                rows[y * w + k] += kernel(kind, x, k, w) * element(kind, image, y * w + x);
    for (int32_t i = 0; i < w * h; i++) out[i] = 0;
    for (int32_t k = 0; k < h; k++)
        for (int32_t y = 0; y < h; y++) {
            const double complex factor = kernel(kind, y, k, h);
            for (int32_t x = 0; x < w; x++) out[k * w + x] += factor * rows[y * w + x];
        }
    free(rows);
}

static void check_against_direct(ptie_fft_kind kind, int32_t w, int32_t h) {
    setup s = make(kind, w, h);
    double complex *expected = malloc((size_t)w * (size_t)h * sizeof *expected);
    assert_non_null(expected);
    fill(s.image, s.image_floats, (uint64_t)(w * 1000 + h));
    direct(expected, kind, s.image, w, h);
    ptie_fft_forward(s.fft, s.spectrum, s.image);
    const int32_t columns = ptie_fft_columns(s.fft);
    const ptie_fft_kind spectrum_kind =
        kind == PTIE_FFT_MIRROR ? PTIE_FFT_MIRROR : PTIE_FFT_COMPLEX;
    double off = 0, norm = 0;
    for (int32_t y = 0; y < h; y++)
        for (int32_t x = 0; x < columns; x++) {
            const int32_t i = y * columns + x;
            const double complex found = element(spectrum_kind, s.spectrum, i);
            off += pow(cabs(found - expected[y * w + x]), 2);
            norm += pow(cabs(expected[y * w + x]), 2);
        }
    /* f32 transforms err by some eps = 6e-8 in L2; measured 2.6e-7 at the worst (primes). */
    assert_near(sqrt(off / norm), 0, 6e-7);
    free(expected);
    drop(&s);
}

static void transforms_match_direct_sums_for_every_length(void **state) {
    (void)state;
    for (int k = 0; k < KINDS; k++)
        for (int32_t n = 1; n <= 67; n++) {
            check_against_direct(kinds[k], n, 1);
            check_against_direct(kinds[k], 1, n);
        }
}

static void transforms_match_direct_sums_in_two_dimensions(void **state) {
    (void)state;
    for (int k = 0; k < KINDS; k++)
        for (int i = 0; i < SIZES; i++) check_against_direct(kinds[k], sizes[i][0], sizes[i][1]);
}

static void inverse_undoes_forward(void **state) {
    (void)state;
    for (int k = 0; k < KINDS; k++)
        for (int i = 0; i < SIZES; i++) {
            setup s = make(kinds[k], sizes[i][0], sizes[i][1]);
            fill(s.image, s.image_floats, 5);
            float *image = copy_of(s.image, s.image_floats);
            ptie_fft_forward(s.fft, s.spectrum, s.image);
            ptie_fft_inverse(s.fft, s.image, s.spectrum);
            /* Two transforms; measured 3.8e-7. */
            assert_near(support_relative_error(s.image, image, s.image_floats), 0, 8e-7);
            free(image);
            drop(&s);
        }
}

static void transforms_are_linear(void **state) {
    (void)state;
    for (int k = 0; k < KINDS; k++) {
        setup a = make(kinds[k], 30, 14), b = make(kinds[k], 30, 14), sum = make(kinds[k], 30, 14);
        fill(a.image, a.image_floats, 1);
        fill(b.image, b.image_floats, 2);
        for (size_t i = 0; i < a.image_floats; i++) sum.image[i] = 2 * a.image[i] - b.image[i];
        ptie_fft_forward(a.fft, a.spectrum, a.image);
        ptie_fft_forward(b.fft, b.spectrum, b.image);
        ptie_fft_forward(sum.fft, sum.spectrum, sum.image);
        for (size_t i = 0; i < a.spectrum_floats; i++)
            a.spectrum[i] = 2 * a.spectrum[i] - b.spectrum[i];
        /* Three transforms of independent rounding; measured 1.7e-7. */
        assert_near(support_relative_error(sum.spectrum, a.spectrum, a.spectrum_floats), 0, 6e-7);
        drop(&a), drop(&b), drop(&sum);
    }
}

static void an_impulse_is_white(void **state) {
    (void)state;
    for (int k = 0; k < 3; k += 2) { /* the periodic kinds */
        setup s = make(kinds[k], 17, 31);
        s.image[0] = 3;
        ptie_fft_forward(s.fft, s.spectrum, s.image);
        for (size_t i = 0; i < s.spectrum_floats; i += 2) {
            assert_near((double)s.spectrum[i], 3, 1e-6); /* 3 eps per stage; measured 0 */
            assert_near((double)s.spectrum[i + 1], 0, 1e-6);
        }
        drop(&s);
    }
}

static void a_shift_is_a_phase_ramp(void **state) {
    (void)state;
    enum { W = 20, H = 9, DX = 3, DY = 2 };
    setup s = make(PTIE_FFT_REAL, W, H), moved = make(PTIE_FFT_REAL, W, H);
    fill(s.image, s.image_floats, 3);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            moved.image[(y + DY) % H * W + (x + DX) % W] = s.image[y * W + x];
    ptie_fft_forward(s.fft, s.spectrum, s.image);
    ptie_fft_forward(moved.fft, moved.spectrum, moved.image);
    for (int32_t y = 0; y < H; y++)
        for (int32_t x = 0; x < ptie_fft_columns(s.fft); x++) {
            const int32_t i = y * ptie_fft_columns(s.fft) + x;
            const double angle =
                ptie_fft_wavenumber(s.fft, 0, x, 1) * DX + ptie_fft_wavenumber(s.fft, 1, y, 1) * DY;
            const double complex expected =
                element(PTIE_FFT_COMPLEX, s.spectrum, i) * cexp(complex_of(0, -angle));
            const double complex found = element(PTIE_FFT_COMPLEX, moved.spectrum, i);
            /* Entries are of size sqrt(W H) = 13: 13 * 4e-7; measured 3.2e-6. */
            assert_near(cabs(found - expected), 0, 6e-6);
        }
    drop(&s), drop(&moved);
}

static double energy(const float *values, size_t count) {
    double sum = 0;
    for (size_t i = 0; i < count; i++) sum += (double)values[i] * (double)values[i];
    return sum;
}

/* Energy of a whole spectrum.  REAL: inner columns stand for two.  MIRROR: cosine modes have half
   the energy of the mean along each axis, and FFTW's factor 2 counts twice. */
static double spectrum_energy(const setup *s, ptie_fft_kind kind, int32_t w, int32_t h) {
    const int32_t columns = ptie_fft_columns(s->fft);
    const size_t entry = kind == PTIE_FFT_MIRROR ? 1 : 2;
    double sum = 0;
    for (int32_t y = 0; y < h; y++)
        for (int32_t x = 0; x < columns; x++) {
            double weight = 1;
            if (kind == PTIE_FFT_REAL) weight = x == 0 || 2 * x == w ? 1 : 2;
            if (kind == PTIE_FFT_MIRROR) weight = (x > 0 ? 2 : 1) * (y > 0 ? 2 : 1) / 16.0;
            assert_near(ptie_fft_share(s->fft, x, y) * w * h / weight, 1, 1e-15);
            sum += weight * energy(s->spectrum + (size_t)(y * columns + x) * entry, entry);
        }
    return sum / ((double)w * h);
}

static void energy_is_kept(void **state) {
    (void)state;
    for (int k = 0; k < KINDS; k++)
        for (int i = 0; i < SIZES; i++) {
            const int32_t w = sizes[i][0], h = sizes[i][1];
            setup s = make(kinds[k], w, h);
            fill(s.image, s.image_floats, 4);
            const double before = energy(s.image, s.image_floats);
            ptie_fft_forward(s.fft, s.spectrum, s.image);
            /* Twice the L2 error of one transform; measured 1.6e-7. */
            assert_near(spectrum_energy(&s, kinds[k], w, h) / before, 1, 6e-7);
            drop(&s);
        }
}

static void wavenumbers_are_those_of_the_grid(void **state) {
    (void)state;
    ptie_fft *fft;
    assert_ok(ptie_fft_create(&fft, PTIE_FFT_REAL, 8, 5));
    assert_near(ptie_fft_wavenumber(fft, 0, 4, 1e-3), PI / 1e-3, 1e-9); /* Nyquist */
    assert_near(ptie_fft_wavenumber(fft, 1, 2, 1e-3), 2 * PI * 2 / 5e-3, 1e-9);
    assert_near(ptie_fft_wavenumber(fft, 1, 3, 1e-3), -2 * PI * 2 / 5e-3, 1e-9);
    ptie_fft_free(fft);
    assert_ok(ptie_fft_create(&fft, PTIE_FFT_MIRROR, 8, 5));
    assert_near(ptie_fft_wavenumber(fft, 0, 7, 1e-3), PI * 7 / 8e-3, 1e-9);
    assert_near(ptie_fft_wavenumber(fft, 1, 1, 1e-3), PI / 5e-3, 1e-9);
    ptie_fft_free(fft);
}

static double low_pass(double k2, const void *context) {
    return exp(-k2 * *(const double *)context);
}

/* White noise through a filter keeps ptie_fft_filter_power of its variance.  The half spectrum must
   count as the whole one does. */
static void filter_power_counts_every_mode_once(void **state) {
    (void)state;
    const double width = 0.05;
    for (int i = 0; i < SIZES; i++) {
        double power[KINDS];
        for (int k = 0; k < KINDS; k++) {
            setup s = make(kinds[k], sizes[i][0], sizes[i][1]);
            float *filter = ptie_alloc(ptie_fft_filter_floats(s.fft), sizeof *filter);
            ptie_fft_filter_fill(s.fft, filter, 1, low_pass, &width);
            power[k] = ptie_fft_filter_power(s.fft, filter);
            ptie_free(filter);
            drop(&s);
        }
        assert_near(power[0] / power[2], 1, 1e-6); /* f32 filter values */
        assert_true(power[1] > power[2] ||
                    sizes[i][0] * sizes[i][1] == 1); /* half-steps: more low modes */
    }
}

static void a_filter_scales_each_mode(void **state) {
    (void)state;
    enum { W = 24, H = 15 };
    const double width = 0.3;
    for (int k = 0; k < 2; k++) {
        setup s = make(kinds[k], W, H);
        float *filter = ptie_alloc(ptie_fft_filter_floats(s.fft), sizeof *filter);
        ptie_fft_filter_fill(s.fft, filter, 1, low_pass, &width);
        const double kx = ptie_fft_wavenumber(s.fft, 0, 3, 1),
                     ky = ptie_fft_wavenumber(s.fft, 1, 2, 1);
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++) /* half-sample offset: a mode of both kinds */
                s.image[y * W + x] = (float)(cos(kx * (x + 0.5)) * cos(ky * (y + 0.5)));
        float *mode = copy_of(s.image, s.image_floats);
        ptie_fft_forward(s.fft, s.spectrum, s.image);
        ptie_fft_filter_apply(s.fft, s.spectrum, filter);
        ptie_fft_inverse(s.fft, s.image, s.spectrum);
        const float factor = (float)low_pass(kx * kx + ky * ky, &width);
        for (size_t i = 0; i < s.image_floats; i++) mode[i] *= factor;
        assert_near(support_relative_error(s.image, mode, s.image_floats), 0,
                    1e-6); /* two transforms */
        free(mode);
        ptie_free(filter);
        drop(&s);
    }
}

static void equal_plans_give_equal_bits(void **state) {
    (void)state;
    for (int k = 0; k < KINDS; k++) {
        setup a = make(kinds[k], 97, 64), b = make(kinds[k], 97, 64);
        fill(a.image, a.image_floats, 9);
        fill(b.image, b.image_floats, 9);
        ptie_fft_forward(a.fft, a.spectrum, a.image);
        ptie_fft_forward(b.fft, b.spectrum, b.image);
        assert_memory_equal(a.spectrum, b.spectrum, a.spectrum_floats * sizeof(float));
        drop(&a), drop(&b);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transforms_match_direct_sums_for_every_length),
        cmocka_unit_test(transforms_match_direct_sums_in_two_dimensions),
        cmocka_unit_test(inverse_undoes_forward),
        cmocka_unit_test(transforms_are_linear),
        cmocka_unit_test(an_impulse_is_white),
        cmocka_unit_test(a_shift_is_a_phase_ramp),
        cmocka_unit_test(energy_is_kept),
        cmocka_unit_test(wavenumbers_are_those_of_the_grid),
        cmocka_unit_test(filter_power_counts_every_mode_once),
        cmocka_unit_test(a_filter_scales_each_mode),
        cmocka_unit_test(equal_plans_give_equal_bits),
    };
    return cmocka_run_group_tests_name("fft", tests, NULL, NULL);
}
