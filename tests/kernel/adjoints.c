/* SPDX-License-Identifier: BSD-3-Clause */
/* Backward kernels are the adjoints and derivatives of the forward ones, at every level, against
 * double precision: <A x, y> = <x, A' y> for what is linear, central differences in double for what
 * is not.
 */
#include "kernel/block.h"

#include "kernel/engine.h"

enum { HEIGHT = 14, WIDTH = 38, IN = 5, OUT = 11 };

static block make(int32_t channels, int32_t scale, ptie_random *random) {
    block b = block_make(channels, scale * HEIGHT, scale * WIDTH, random);
    block_clear_halo(&b);
    return b;
}

/* Both products are sums of 10^3 to 10^4 terms of either sign, each rounded; measured 3e-9 of
   |A x| |y| at worst. */
static void assert_adjoint(const block *ax, const block *y, const block *x, const block *ay) {
    double size = sqrt(block_dot(ax, ax) * block_dot(y, y));
    assert_near(block_dot(ax, y), block_dot(x, ay), 3e-8 * size);
}

static void at_every_level(void (*check)(const ptie_kernels *, ptie_random *)) {
    for (int level = 0; level <= (int)ptie_cpu_detect(); level++) {
        ptie_random random;
        ptie_random_init(&random, 3, PTIE_STREAM_WEIGHTS, (uint64_t)level);
        check(ptie_kernels_of((ptie_cpu_level)level), &random);
    }
}

static void check_conv3x3(const ptie_kernels *kernels, ptie_random *random) {
    block x = make(IN, 1, random), ax = make(OUT, 1, random), y = make(OUT, 1, random),
          ay = make(IN, 1, random);
    float weights[OUT * IN * 9], packed[16 * IN * 9], packed_adjoint[8 * OUT * 9];
    for (int i = 0; i < OUT * IN * 9; i++) weights[i] = (float)ptie_random_uniform(random, -1, 1);
    ptie_conv3x3_pack(packed, weights, OUT, IN, NULL);
    ptie_conv3x3_pack_adjoint(packed_adjoint, weights, OUT, IN);
    kernels->conv3x3(&ax.map, &x.map, packed, NULL, false);
    kernels->conv3x3(&ay.map, &y.map, packed_adjoint, NULL, false);
    assert_adjoint(&ax, &y, &x, &ay);

    /* The convolution is linear in its weights too: <A_w x, y> = <w, gradient>. */
    double gradient[OUT * IN * 9] = {0}, product = 0;
    float *scratch = malloc(ptie_winograd_scratch(OUT, IN) * sizeof *scratch);
    kernels->conv3x3_weights(gradient, &y.map, &x.map, scratch, NULL);
    free(scratch);
    for (int i = 0; i < OUT * IN * 9; i++) product += gradient[i] * (double)weights[i];
    assert_near(product, block_dot(&ax, &y), 3e-8 * sqrt(block_dot(&ax, &ax) * block_dot(&y, &y)));
    block_free(&x), block_free(&ax), block_free(&y), block_free(&ay);
}

static void conv3x3_backward_is_the_adjoint(void **state) {
    (void)state;
    at_every_level(check_conv3x3);
}

static void check_conv1x1(const ptie_kernels *kernels, ptie_random *random) {
    block x = make(IN, 1, random), ax = make(1, 1, random), y = make(1, 1, random),
          ay = make(IN, 1, random);
    float weights[IN];
    double gradient[IN] = {0}, bias_gradient = 0, product = 0, sum = 0;
    for (int i = 0; i < IN; i++) weights[i] = (float)ptie_random_uniform(random, -1, 1);
    kernels->conv1x1(&ax.map, &x.map, weights, NULL);
    kernels->conv1x1(&ay.map, &y.map, weights, NULL);
    assert_adjoint(&ax, &y, &x, &ay);
    kernels->conv1x1_weights(gradient, &bias_gradient, &y.map, &x.map);
    const double size = sqrt(block_dot(&ax, &ax) * block_dot(&y, &y));
    for (int i = 0; i < IN; i++) product += gradient[i] * (double)weights[i];
    assert_near(product, block_dot(&ax, &y), 3e-8 * size);
    for (int32_t row = 0; row < HEIGHT; row++)
        for (int32_t column = 0; column < WIDTH; column++)
            sum += (double)*block_pixel(&y, 0, row, column);
    assert_near(bias_gradient, sum, 1e-6 * HEIGHT * WIDTH);
    block_free(&x), block_free(&ax), block_free(&y), block_free(&ay);
}

static void conv1x1_backward_is_the_adjoint(void **state) {
    (void)state;
    at_every_level(check_conv1x1);
}

enum { BAND = 3 };

static void check_upsample(const ptie_kernels *kernels, ptie_random *random) {
    block x = make(IN, 1, random), ax = make(IN, 2, random), y = make(IN, 2, random),
          ay = make(IN, 1, random);
    for (size_t i = 0; i < ay.floats; i++) ay.memory[i] = 0;     /* it adds */
    for (int32_t first = 0; first < 2 * HEIGHT; first += BAND) { /* band by band */
        const int32_t rows = 2 * HEIGHT - first < BAND ? 2 * HEIGHT - first : BAND;
        const ptie_map out = ptie_map_rows(ax.map, first, rows),
                       grad = ptie_map_rows(y.map, first, rows);
        kernels->upsample(&out, &x.map, first);
        kernels->upsample_backward(&ay.map, &grad, first);
    }
    assert_adjoint(&ax, &y, &x, &ay);
    block_free(&x), block_free(&ax), block_free(&y), block_free(&ay);
}

static void upsample_backward_is_the_adjoint(void **state) {
    (void)state;
    at_every_level(check_upsample);
}

/* Every value lies at (2 i + 1/2) / 2 of its neighbours: a plane stays a plane away from the edges.
 */
static void check_plane(const ptie_kernels *kernels, ptie_random *random) {
    block x = make(1, 1, random), ax = make(1, 2, random);
    for (int32_t row = 0; row < HEIGHT; row++)
        for (int32_t column = 0; column < WIDTH; column++)
            *block_pixel(&x, 0, row, column) = (float)(3 * row - 2 * column);
    kernels->upsample(&ax.map, &x.map, 0);
    for (int32_t row = 1; row < 2 * HEIGHT - 1; row++)
        for (int32_t column = 1; column < 2 * WIDTH - 1; column++) /* quarters are exact */
            assert_near((double)*block_pixel(&ax, 0, row, column),
                        3 * (row / 2.0 - 0.25) - 2 * (column / 2.0 - 0.25), 0);
    assert_near((double)*block_pixel(&ax, 0, 0, 0), 0, 0); /* edges continue */
    assert_near((double)*block_pixel(&ax, 0, 2 * HEIGHT - 1, 2 * WIDTH - 1),
                3 * (HEIGHT - 1) - 2 * (WIDTH - 1), 0);
    block_free(&x), block_free(&ax);
}

static void upsample_keeps_a_plane(void **state) {
    (void)state;
    at_every_level(check_plane);
}

/* With the places of the maxima held fixed the maximum is linear: A x picks, A' y puts back. */
static void check_maxpool(const ptie_kernels *kernels, ptie_random *random) {
    block x = make(IN, 2, random), ax = make(IN, 1, random), y = make(IN, 1, random),
          ay = make(IN, 2, random);
    for (size_t i = 0; i < ay.floats; i++) ay.memory[i] = 0; /* it adds */
    kernels->maxpool(&ax.map, &x.map);
    kernels->maxpool_backward(&ay.map, &y.map, &x.map, &ax.map);
    assert_adjoint(&ax, &y, &x, &ay);
    block_free(&x), block_free(&ax), block_free(&y), block_free(&ay);
}

static void maxpool_backward_is_the_adjoint(void **state) {
    (void)state;
    at_every_level(check_maxpool);
}

static void check_window(const ptie_kernels *kernels, ptie_random *random) {
    enum {
        MARGIN = PTIE_SSIM_WINDOW - 1,
        LARGE = HEIGHT * WIDTH,
        SMALL = (HEIGHT - MARGIN) * (WIDTH - MARGIN)
    };
    float x[LARGE], ay[LARGE], ax[SMALL], y[SMALL], taps[PTIE_SSIM_WINDOW], row[WIDTH + 64];
    double left = 0, right = 0, ax2 = 0, y2 = 0;
    for (int i = 0; i < LARGE; i++) x[i] = (float)ptie_random_uniform(random, -1, 1);
    for (int i = 0; i < SMALL; i++) y[i] = (float)ptie_random_uniform(random, -1, 1);
    for (int i = 0; i < PTIE_SSIM_WINDOW; i++)
        taps[i] = 1 / (1 + (float)abs(i - PTIE_SSIM_WINDOW / 2));
    kernels->window(ax, x, WIDTH, HEIGHT, taps, row);
    kernels->window_adjoint(ay, y, WIDTH, HEIGHT, taps, row);
    for (int i = 0; i < SMALL; i++) {
        left += (double)ax[i] * (double)y[i];
        ax2 += (double)ax[i] * (double)ax[i];
        y2 += (double)y[i] * (double)y[i];
    }
    for (int i = 0; i < LARGE; i++) right += (double)x[i] * (double)ay[i];
    assert_near(left, right, 3e-8 * sqrt(ax2 * y2));
}

static void window_adjoint_is_the_adjoint(void **state) {
    (void)state;
    at_every_level(check_window);
}

/* L = <r, max(0, gamma xhat(z) + beta)> of one channel over the batch z, in double, by definition.
 */
static double normalised_product(const double *z, const double *r, int count, double gamma,
                                 double beta) {
    double mean = 0, variance = 0, product = 0;
    for (int i = 0; i < count; i++) mean += z[i] / count;
    for (int i = 0; i < count; i++) variance += (z[i] - mean) * (z[i] - mean) / count;
    for (int i = 0; i < count; i++)
        product += r[i] * fmax(0, gamma * (z[i] - mean) / sqrt(variance + 1e-3) + beta);
    return product;
}

static void check_normalise(const ptie_kernels *kernels, ptie_random *random) {
    enum { COUNT = HEIGHT * WIDTH };
    const double gamma = 1.3, beta = 0.2;
    block z = make(1, 1, random), g = make(1, 1, random);
    double z64[COUNT], r64[COUNT], sums[2] = {0}, mean, inverse_std;
    for (int i = 0; i < COUNT; i++) {
        z64[i] = (double)*block_pixel(&z, 0, i / WIDTH, i % WIDTH);
        r64[i] = (double)*block_pixel(&g, 0, i / WIDTH, i % WIDTH);
        sums[0] += z64[i];
        sums[1] += z64[i] * z64[i];
    }
    mean = sums[0] / COUNT;
    inverse_std = 1 / sqrt(sums[1] / COUNT - mean * mean + 1e-3);
    ptie_norm norm = {.scale = (float)(gamma * inverse_std),
                      .shift = (float)(beta - mean * gamma * inverse_std),
                      .mean = (float)mean,
                      .inverse_std = (float)inverse_std};
    sums[0] = sums[1] = 0;
    kernels->normalise_sums(sums, &g.map, &z.map, &norm);
    norm.mean_g = (float)(sums[0] / COUNT);
    norm.mean_gx = (float)(sums[1] / COUNT);
    kernels->normalise_backward(&g.map, &g.map, &z.map, &norm);

    /* Central differences with h = 1e-5: truncation h^2 ~ 1e-10, rounding 1e-16 / h ~ 1e-11 of L ~
       10^2, unless a ReLU opens within h (its kink adds at most |r| gamma inverse_std / 2, and is
       left out). */
    const double h = 1e-5;
    double gradient_gamma = (normalised_product(z64, r64, COUNT, gamma + h, beta) -
                             normalised_product(z64, r64, COUNT, gamma - h, beta)) /
                            (2 * h);
    double gradient_beta = (normalised_product(z64, r64, COUNT, gamma, beta + h) -
                            normalised_product(z64, r64, COUNT, gamma, beta - h)) /
                           (2 * h);
    assert_near(sums[1], gradient_gamma, 1e-5); /* 532 rounded terms; measured 1.3e-6 */
    assert_near(sums[0], gradient_beta, 1e-5);
    for (int i = 0; i < COUNT; i += 7) {
        if (fabs((double)norm.scale * z64[i] + (double)norm.shift) < 1e-3) continue;
        const double kept = z64[i];
        z64[i] = kept + h;
        double above = normalised_product(z64, r64, COUNT, gamma, beta);
        z64[i] = kept - h;
        double below = normalised_product(z64, r64, COUNT, gamma, beta);
        z64[i] = kept;
        assert_near((double)*block_pixel(&g, 0, i / WIDTH, i % WIDTH), (above - below) / (2 * h),
                    2e-6);
    }
    block_free(&z), block_free(&g);
}

static void normalise_backward_is_the_derivative(void **state) {
    (void)state;
    at_every_level(check_normalise);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(conv3x3_backward_is_the_adjoint),
        cmocka_unit_test(conv1x1_backward_is_the_adjoint),
        cmocka_unit_test(upsample_backward_is_the_adjoint),
        cmocka_unit_test(upsample_keeps_a_plane),
        cmocka_unit_test(maxpool_backward_is_the_adjoint),
        cmocka_unit_test(window_adjoint_is_the_adjoint),
        cmocka_unit_test(normalise_backward_is_the_derivative),
    };
    return cmocka_run_group_tests_name("adjoints", tests, NULL, NULL);
}
