/* SPDX-License-Identifier: BSD-3-Clause */
/* The forward model against closed forms, against itself, and against a direct sum. */
#include "support/support.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/random.h"
#include "optics/optics.h"

#define PI 3.14159265358979323846

/* CMPLX of C11, which clang does not find in every C library. */
static double complex complex_of(double re, double im) {
    return re + im * (double complex)I;
}

/* A plan, its scratch, and images of its size. */
typedef struct setup {
    ptie_optics_params params;
    ptie_optics *optics;
    void *scratch;
    float *phase, *plus, *minus;
    int32_t w, h;
} setup;

static setup make(ptie_propagation propagation, ptie_boundary boundary, int32_t w, int32_t h,
                  double pixel_m) {
    setup s = {.w = w, .h = h};
    ptie_optics_params_init(&s.params);
    s.params.width_px = w, s.params.height_px = h, s.params.pixel_m = pixel_m;
    s.params.propagation = propagation, s.params.boundary = boundary;
    assert_ok(ptie_optics_plan(&s.optics, &s.params));
    s.scratch = ptie_alloc(ptie_optics_scratch(s.optics), 1);
    float **images[] = {&s.phase, &s.plus, &s.minus};
    for (int i = 0; i < 3; i++) {
        *images[i] = calloc((size_t)w * (size_t)h, sizeof(float));
        assert_non_null(*images[i]);
    }
    return s;
}

static void drop(setup *s) {
    ptie_optics_free(s->optics);
    ptie_free(s->scratch);
    free(s->phase), free(s->plus), free(s->minus);
}

static void defocus(setup *s, const float *i_zero) {
    assert_ok(ptie_optics_defocus(s->optics, s->plus, s->minus, s->phase, i_zero, s->scratch));
}

/* a cos cos, an eigenfunction of both Laplacians under both boundaries; returns k^2 in (rad/m)^2
   and the 5-point Laplacian's symbol for it. */
static double set_mode(setup *s, int i, int j, double amplitude, double *stencil_k2) {
    const double p = s->params.pixel_m, half = s->params.boundary == PTIE_MIRROR ? 1 : 2;
    const double kx = half * PI * i / (s->w * p), ky = half * PI * j / (s->h * p);
    for (int32_t y = 0; y < s->h; y++)
        for (int32_t x = 0; x < s->w; x++)
            s->phase[y * s->w + x] =
                (float)(amplitude * cos(kx * p * (x + 0.5)) * cos(ky * p * (y + 0.5)));
    *stencil_k2 = (4 - 2 * cos(kx * p) - 2 * cos(ky * p)) / (p * p);
    return kx * kx + ky * ky;
}

/* Coefficient of (I+ - I-) / 2 along the phase. */
static double response(const setup *s) {
    double product = 0, norm = 0;
    for (int32_t i = 0; i < s->w * s->h; i++) {
        const double phase = (double)s->phase[i];
        product += ((double)s->plus[i] - (double)s->minus[i]) / 2 * phase;
        norm += phase * phase;
    }
    return product / norm;
}

/* What f32 transforms (relative error 6e-8) leave in a linear TIE signal: the highest modes have
   the gain (lambda dz / 2 pi) k^2, which is 42 at pixels of 20 um. */
static double rounding(double amplitude_rad) {
    return 6e-8 * amplitude_rad * (532e-9 * 10e-3 / (2 * PI) * 2 * pow(PI / 20e-6, 2));
}

static void linear_tie_scales_eigenfunctions_by_k2(void **state) {
    (void)state;
    for (int boundary = 0; boundary < 2; boundary++)
        for (int stencil = 0; stencil < 2; stencil++) {
            setup s = make(stencil ? PTIE_TIE_STENCIL : PTIE_TIE_SPECTRAL, (ptie_boundary)boundary,
                           40, 27, 20e-6);
            double stencil_k2, k2 = set_mode(&s, 5, 3, 1.5, &stencil_k2);
            defocus(&s, NULL);
            const double expected = 532e-9 * 10e-3 / (2 * PI) * (stencil ? stencil_k2 : k2);
            for (int32_t i = 0; i < s.w * s.h; i++) {
                const double signal = expected * (double)s.phase[i];
                assert_near((double)s.plus[i], 1 + signal,
                            rounding(1.5)); /* 3.8e-6; measured 1.5e-6 */
                assert_near((double)s.minus[i], 1 - signal, rounding(1.5));
            }
            drop(&s);
        }
}

static void set_gaussian(setup *s, double amplitude, double sigma_m) {
    const double p = s->params.pixel_m;
    for (int32_t y = 0; y < s->h; y++)
        for (int32_t x = 0; x < s->w; x++) {
            const double u = (x - (s->w - 1) / 2.0) * p, v = (y - (s->h - 1) / 2.0) * p;
            s->phase[y * s->w + x] =
                (float)(amplitude * exp(-(u * u + v * v) / (2 * sigma_m * sigma_m)));
        }
}

/* A thick middle is a converging lens: it brightens downstream (+z), whatever the propagation. */
static void a_converging_lens_brightens_at_plus(void **state) {
    (void)state;
    for (int boundary = 0; boundary < 2; boundary++)
        for (int propagation = 0; propagation < 3; propagation++) {
            setup s = make((ptie_propagation)propagation, (ptie_boundary)boundary, 63, 63, 20e-6);
            set_gaussian(&s, +1, 200e-6);
            defocus(&s, NULL);
            const int32_t centre = 31 * 63 + 31;
            /* dI/dz at the top: (lambda / 2 pi) 2 a / sigma^2; diffraction takes below a fifth. */
            const double signal = 532e-9 * 10e-3 / (2 * PI) * 2 / (200e-6 * 200e-6);
            assert_near((double)s.plus[centre] - 1, signal, signal / 5);
            assert_near((double)s.minus[centre] - 1, -signal, signal / 5);
            drop(&s);
        }
}

static void a_gaussian_phase_has_its_laplacian(void **state) {
    (void)state;
    const double a = 2, sigma = 120e-6, p = 20e-6, c = -532e-9 * 10e-3 / (2 * PI);
    for (int boundary = 0; boundary < 2; boundary++) {
        setup s = make(PTIE_TIE_SPECTRAL, (ptie_boundary)boundary, 96, 96, p);
        set_gaussian(&s, a, sigma);
        defocus(&s, NULL);
        for (int32_t y = 0; y < s.h; y++)
            for (int32_t x = 0; x < s.w; x++) {
                const double u = (x - 47.5) * p, v = (y - 47.5) * p,
                             r2 = (u * u + v * v) / (sigma * sigma);
                const double signal = c * a * (r2 - 2) / (sigma * sigma) * exp(-r2 / 2);
                /* The tail at the frame (7.9 sigma) and above Nyquist is below 1e-12;
                   measured 3.4e-6. */
                assert_near((double)s.plus[y * s.w + x] - 1, signal, rounding(a));
            }
        drop(&s);
    }
}

/* Relative difference of stencil and spectral signals of one field sampled at `refinement` times
   the resolution. */
static double stencil_error(int refinement) {
    const int32_t n = 48 * refinement;
    setup spectral = make(PTIE_TIE_SPECTRAL, PTIE_MIRROR, n, n, 20e-6 / refinement);
    setup stencil = make(PTIE_TIE_STENCIL, PTIE_MIRROR, n, n, 20e-6 / refinement);
    set_gaussian(&spectral, 2, 100e-6);
    set_gaussian(&stencil, 2, 100e-6);
    defocus(&spectral, NULL);
    defocus(&stencil, NULL);
    double off = 0, norm = 0;
    for (int32_t i = 0; i < n * n; i++) {
        off += pow((double)stencil.plus[i] - (double)spectral.plus[i], 2);
        norm += pow((double)spectral.plus[i] - 1, 2);
    }
    drop(&spectral), drop(&stencil);
    return sqrt(off / norm);
}

static void the_stencil_converges_with_the_square_of_the_pixel(void **state) {
    (void)state;
    const double coarse = stencil_error(1), fine = stencil_error(2);
    /* Error h^2 k^2 / 12 + O(h^4): 4 up to the next order, (h / sigma)^2 / 10 = 0.4 %. */
    assert_near(coarse / fine, 4, 0.1);
    assert_true(coarse < 0.02);
}

/* The angular spectrum answers sin(chi) where the linear TIE has chi = k^2 dz lambda / 4 pi. */
static void angular_spectrum_tends_to_linear_tie(void **state) {
    (void)state;
    for (int boundary = 0; boundary < 2; boundary++)
        for (int mode = 2; mode <= 5; mode++) {
            setup s = make(PTIE_ANGULAR_SPECTRUM, (ptie_boundary)boundary, 64, 64, 20e-6);
            double unused;
            const double k2 = set_mode(&s, 2 * mode, mode, 4e-3, &unused);
            const double chi = k2 * 10e-3 * 532e-9 / (4 * PI);
            defocus(&s, NULL);
            /* Third order in a; rounding near 1 against the signal 2 chi a = 0.008 chi:
               measured 2.8e-6 / chi. */
            const double found = response(&s) / (2 * chi), slack = 1.6e-5 + 6e-6 / chi;
            assert_near(found, sin(chi) / chi, slack);
            assert_near(found, 1, chi * chi / 6 + slack);
            drop(&s);
        }
}

static void set_random(float *image, int32_t count, double low, double high, uint64_t which) {
    ptie_random random;
    ptie_random_init(&random, 2, PTIE_STREAM_TEXTURE, which);
    for (int32_t i = 0; i < count; i++) image[i] = (float)ptie_random_uniform(&random, low, high);
}

static double mean(const float *image, int32_t count) {
    double sum = 0;
    for (int32_t i = 0; i < count; i++) sum += (double)image[i];
    return sum / count;
}

static void diffraction_keeps_the_energy(void **state) {
    (void)state;
    for (int boundary = 0; boundary < 2; boundary++) {
        setup s = make(PTIE_ANGULAR_SPECTRUM, (ptie_boundary)boundary, 50, 33, 5e-6);
        float *i_zero = calloc(50 * 33, sizeof *i_zero);
        set_random(s.phase, s.w * s.h, -3, 3, 1);
        set_random(i_zero, s.w * s.h, 0, 2, 2);
        defocus(&s, i_zero);
        /* 2e-7 per transform, twice for the square. */
        assert_near(mean(s.plus, s.w * s.h) / mean(i_zero, s.w * s.h), 1, 1e-6);
        assert_near(mean(s.minus, s.w * s.h) / mean(i_zero, s.w * s.h), 1, 1e-6);
        assert_true(support_relative_error(s.plus, i_zero, (size_t)(s.w * s.h)) > 0.1);
        free(i_zero);
        drop(&s);
    }
}

static int32_t folded(int32_t i, int32_t n) {
    return i < n ? i : 2 * n - 1 - i;
}

static void a_mirror_is_the_even_extension(void **state) {
    (void)state;
    enum { W = 22, H = 15 };
    setup small = make(PTIE_ANGULAR_SPECTRUM, PTIE_MIRROR, W, H, 10e-6);
    setup large = make(PTIE_ANGULAR_SPECTRUM, PTIE_PERIODIC, 2 * W, 2 * H, 10e-6);
    float small_zero[W * H], large_zero[4 * W * H];
    set_random(small.phase, W * H, -2, 2, 3);
    set_random(small_zero, W * H, 0, 2, 4);
    for (int32_t y = 0; y < 2 * H; y++)
        for (int32_t x = 0; x < 2 * W; x++) {
            const int32_t from = folded(y, H) * W + folded(x, W), to = y * 2 * W + x;
            large.phase[to] = small.phase[from];
            large_zero[to] = small_zero[from];
        }
    defocus(&small, small_zero);
    defocus(&large, large_zero);
    for (int32_t y = 0; y < H; y++)
        for (int32_t x = 0; x < W; x++) {
            /* Intensities up to about 10; a few eps of each. */
            assert_near((double)small.plus[y * W + x], (double)large.plus[y * 2 * W + x], 4e-6);
            assert_near((double)small.minus[y * W + x], (double)large.minus[y * 2 * W + x], 4e-6);
        }
    drop(&small), drop(&large);
}

static double signed_frequency(int32_t i, int32_t n, double pixel_m) {
    return (2 * i < n ? i : i - n) / (n * pixel_m);
}

/* The definition, in double: a direct Fourier sum, H = exp(i k dz sqrt(1 - (lambda f)^2)) or 0. */
static void direct_intensity(double *intensity, const setup *s, const float *i_zero, double z) {
    const int32_t w = s->w, h = s->h;
    const double lambda = s->params.wavelength_m;
    double complex *wave = calloc((size_t)(w * h), sizeof *wave);
    assert_non_null(wave);
    for (int32_t v = 0; v < h; v++)
        for (int32_t u = 0; u < w; u++) {
            const double fx = signed_frequency(u, w, s->params.pixel_m);
            const double fy = signed_frequency(v, h, s->params.pixel_m);
            const double q = 1 - lambda * lambda * (fx * fx + fy * fy);
            if (q < 0) continue;
            double complex sum = 0;
            for (int32_t i = 0; i < w * h; i++) {
                const double turn = (double)u * (i % w) / w + (double)v * (i / w) / h;
                const double angle = (double)s->phase[i] - 2 * PI * turn;
                sum += sqrt((double)i_zero[i]) * cexp(complex_of(0, angle));
            }
            sum *= cexp(complex_of(0, 2 * PI / lambda * z * sqrt(q))) / (w * h);
            for (int32_t i = 0; i < w * h; i++) {
                const double turn = (double)u * (i % w) / w + (double)v * (i / w) / h;
                wave[i] += sum * cexp(complex_of(0, 2 * PI * turn));
            }
        }
    for (int32_t i = 0; i < w * h; i++) intensity[i] = pow(cabs(wave[i]), 2);
    free(wave);
}

/* Pixels of 0.2 um see the edge of the light cone: a third of the modes is evanescent. */
static void angular_spectrum_matches_its_definition(void **state) {
    (void)state;
    enum { W = 12, H = 9 };
    static const double pixels[] = {20e-6, 0.2e-6};
    for (int i = 0; i < 2; i++) {
        setup s = make(PTIE_ANGULAR_SPECTRUM, PTIE_PERIODIC, W, H, pixels[i]);
        float i_zero[W * H];
        double plus[W * H], minus[W * H];
        set_random(s.phase, W * H, -3, 3, 5);
        set_random(i_zero, W * H, 0, 2, 6);
        defocus(&s, i_zero);
        direct_intensity(plus, &s, i_zero, +10e-3);
        direct_intensity(minus, &s, i_zero, -10e-3);
        for (int32_t j = 0; j < W * H; j++) {
            assert_near((double)s.plus[j], plus[j], 3e-6); /* intensities up to 8, a few eps */
            assert_near((double)s.minus[j], minus[j], 3e-6);
        }
        drop(&s);
    }
}

static void intensity_in_focus_scales_the_planes(void **state) {
    (void)state;
    enum { N = 16 };
    float i_zero[N * N];
    for (int32_t i = 0; i < N * N; i++)
        i_zero[i] = 4; /* a power of two: exact, also under the root */
    for (int propagation = 0; propagation < 3; propagation++) {
        setup one = make((ptie_propagation)propagation, PTIE_MIRROR, N, N, 20e-6);
        setup four = make((ptie_propagation)propagation, PTIE_MIRROR, N, N, 20e-6);
        set_random(one.phase, N * N, -1, 1, 7);
        set_random(four.phase, N * N, -1, 1, 7);
        defocus(&one, NULL);
        defocus(&four, i_zero);
        for (int32_t i = 0; i < N * N; i++) {
            assert_true(four.plus[i] == 4 * one.plus[i]);
            assert_true(four.minus[i] == 4 * one.minus[i]);
        }
        drop(&one), drop(&four);
    }
}

static void a_plane_may_replace_the_phase(void **state) {
    (void)state;
    for (int propagation = 0; propagation < 3; propagation++) {
        setup s = make((ptie_propagation)propagation, PTIE_PERIODIC, 20, 12, 20e-6);
        set_random(s.phase, 240, -1, 1, 8);
        defocus(&s, NULL);
        assert_ok(ptie_optics_defocus(s.optics, s.phase, s.minus, s.phase, NULL, s.scratch));
        assert_memory_equal(s.phase, s.plus, 240 * sizeof(float));
        drop(&s);
    }
}

static void bad_images_are_named_with_their_pixel(void **state) {
    (void)state;
    setup linear = make(PTIE_TIE_SPECTRAL, PTIE_PERIODIC, 8, 6, 20e-6);
    setup wave = make(PTIE_ANGULAR_SPECTRUM, PTIE_PERIODIC, 8, 6, 20e-6);
    float i_zero[48];
    for (int i = 0; i < 48; i++) i_zero[i] = 1;
    i_zero[2 * 8 + 5] = 1.5f;
    assert_fails(ptie_optics_defocus(linear.optics, linear.plus, linear.minus, linear.phase, i_zero,
                                     linear.scratch),
                 PTIE_EINVAL,
                 "i_zero: linear TIE needs a constant intensity (at x=5, y=2; expected 1");
    i_zero[2 * 8 + 5] = -1;
    assert_fails(
        ptie_optics_defocus(wave.optics, wave.plus, wave.minus, wave.phase, i_zero, wave.scratch),
        PTIE_ENUMERIC, "i_zero: intensity is negative (at x=5, y=2");
    i_zero[2 * 8 + 5] = INFINITY;
    assert_fails(
        ptie_optics_defocus(wave.optics, wave.plus, wave.minus, wave.phase, i_zero, wave.scratch),
        PTIE_ENUMERIC, "i_zero: value is not finite (at x=5, y=2");
    wave.phase[47] = NAN;
    assert_fails(
        ptie_optics_defocus(wave.optics, wave.plus, wave.minus, wave.phase, NULL, wave.scratch),
        PTIE_ENUMERIC, "phase_rad: value is not finite (at x=7, y=5");
    assert_true(wave.plus[0] == 0); /* untouched */
    drop(&linear), drop(&wave);
}

static void noise_is_gaussian_and_named(void **state) {
    (void)state;
    enum { N = 100003 }; /* not a multiple of any block */
    float *a = calloc(N, sizeof *a), *b = calloc(N, sizeof *b);
    ptie_add_gaussian_noise(a, N, 0.25, 11, PTIE_STREAM_NOISE_PLUS, 3);
    ptie_add_gaussian_noise(b, N, 0.25, 11, PTIE_STREAM_NOISE_PLUS, 3);
    assert_memory_equal(a, b, N * sizeof *a);
    double sum = 0, squares = 0, product = 0;
    memset(b, 0, N * sizeof *b);
    ptie_add_gaussian_noise(b, N, 0.25, 11, PTIE_STREAM_NOISE_MINUS, 3);
    for (int i = 0; i < N; i++) {
        sum += (double)a[i], squares += (double)a[i] * (double)a[i];
        product += (double)a[i] * (double)b[i];
    }
    /* Five standard errors: s/sqrt(N), s^2 sqrt(2/N), s^2/sqrt(N). */
    assert_near(sum / N, 0, 5 * 0.25 / sqrt(N));
    assert_near(squares / N, 0.0625, 5 * 0.0625 * sqrt(2.0 / N));
    assert_near(product / N, 0, 5 * 0.0625 / sqrt(N));
    float part[7] = {1, 1, 1, 1, 1, 1, 1};
    ptie_add_gaussian_noise(part, 7, 0.25, 11, PTIE_STREAM_NOISE_PLUS, 3);
    for (int i = 0; i < 7; i++)
        assert_true(part[i] == 1 + a[i]); /* added; a prefix is the same draw */
    free(a), free(b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(linear_tie_scales_eigenfunctions_by_k2),
        cmocka_unit_test(a_converging_lens_brightens_at_plus),
        cmocka_unit_test(a_gaussian_phase_has_its_laplacian),
        cmocka_unit_test(the_stencil_converges_with_the_square_of_the_pixel),
        cmocka_unit_test(angular_spectrum_tends_to_linear_tie),
        cmocka_unit_test(diffraction_keeps_the_energy),
        cmocka_unit_test(a_mirror_is_the_even_extension),
        cmocka_unit_test(angular_spectrum_matches_its_definition),
        cmocka_unit_test(intensity_in_focus_scales_the_planes),
        cmocka_unit_test(a_plane_may_replace_the_phase),
        cmocka_unit_test(bad_images_are_named_with_their_pixel),
        cmocka_unit_test(noise_is_gaussian_and_named),
    };
    return cmocka_run_group_tests_name("optics", tests, NULL, NULL);
}
