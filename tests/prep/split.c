/* SPDX-License-Identifier: BSD-3-Clause */
/* Channels of a sensor image: every layout by its definition, every demosaicing by what it keeps.
 */
#include "support/support.h"

#include <math.h>

#include <ptie/preprocess.h>

#define PI 3.14159265358979323846

enum { W = 48, H = 36, CW = W / 2, CH = H / 2 };

static void split(float channel[4][CW * CH], const float *image, ptie_demosaic demosaic,
                  int32_t roi_x, int32_t roi_y) {
    ptie_splitter_params p;
    ptie_splitter_params_init(&p);
    p.width_px = W, p.height_px = H, p.demosaic = demosaic, p.roi_x_px = roi_x, p.roi_y_px = roi_y;
    ptie_splitter *splitter;
    assert_ok(ptie_splitter_create(&splitter, &p));
    int32_t width, height;
    assert_int_equal(ptie_splitter_channels(splitter, &width, &height), 4);
    assert_true(width == CW && height == CH);
    void *scratch = ptie_scratch_alloc(ptie_splitter_scratch_bytes(splitter));
    float *const out[] = {channel[0], channel[1], channel[2], channel[3]};
    assert_ok(ptie_splitter_run(splitter, out, image, scratch));
    ptie_scratch_free(scratch);
    ptie_splitter_free(splitter);
}

/* Channel c of the sensor's cells is at columns with the parity of c % 2 of the sensor, rows of c
 * / 2. */
static void pixels_go_to_their_channel_for_any_region(void **state) {
    (void)state;
    float image[W * H], channel[4][CW * CH];
    for (int roi = 0; roi < 4; roi++) {
        const int32_t roi_x = 6 + roi % 2, roi_y = 10 + roi / 2;
        for (int i = 0; i < W * H; i++) {
            const int sensor_x = roi_x + i % W, sensor_y = roi_y + i / W;
            image[i] = (float)(sensor_y % 2 * 2 + sensor_x % 2);
        }
        for (int method = PTIE_DEMOSAIC_NONE; method <= PTIE_DEMOSAIC_FOURIER; method++) {
            split(channel, image, (ptie_demosaic)method, roi_x, roi_y);
            for (int c = 0; c < 4; c++) /* transforms of constants: 2e-7 */
                for (int i = 0; i < CW * CH; i++) assert_near((double)channel[c][i], c, 1e-6);
        }
    }
}

static void none_keeps_the_pixels(void **state) {
    (void)state;
    float image[W * H], channel[4][CW * CH];
    for (int i = 0; i < W * H; i++) image[i] = (float)i;
    split(channel, image, PTIE_DEMOSAIC_NONE, 0, 0);
    for (int c = 0; c < 4; c++)
        for (int y = 0; y < CH; y++)
            for (int x = 0; x < CW; x++)
                assert_true(channel[c][y * CW + x] == (float)((2 * y + c / 2) * W + 2 * x + c % 2));
}

static void bilinear_keeps_planes_at_the_centres_of_the_cells(void **state) {
    (void)state;
    float image[W * H], channel[4][CW * CH];
    for (int i = 0; i < W * H; i++) image[i] = (float)(3 * (i % W) - 2 * (i / W));
    split(channel, image, PTIE_DEMOSAIC_BILINEAR, 0, 0);
    for (int c = 0; c < 4; c++)
        for (int y = 1; y < CH - 1; y++)
            for (int x = 1; x < CW - 1; x++)
                assert_true(channel[c][y * CW + x] ==
                            (float)(3 * (2 * x + 0.5) - 2 * (2 * y + 0.5)));
}

/* A wave on the sensor, at the centre of cell (x, y). */
static double wave(double x, double y, int i, int j) {
    return cos(2 * PI * (i * x / W + j * y / H) + 0.3 * i - 0.2 * j);
}

static void fourier_keeps_band_limited_images(void **state) {
    (void)state;
    float image[W * H], channel[4][CW * CH];
    for (int i = -W / 4 + 1; i < W / 4; i += 5)
        for (int j = -H / 4 + 1; j < H / 4; j += 4) {
            for (int k = 0; k < W * H; k++) image[k] = (float)wave(k % W, k / W, i, j);
            split(channel, image, PTIE_DEMOSAIC_FOURIER, 0, 0);
            for (int c = 0; c < 4; c++)
                for (int k = 0; k < CW * CH; k++) /* measured 3.1e-7 */
                    assert_near((double)channel[c][k],
                                wave(2 * (k % CW) + 0.5, 2 * (k / CW) + 0.5, i, j), 1e-6);
        }
}

/* (P2): a wave of k rad per pixel of the channel keeps |3/4 + 1/4 exp(ik)| of its amplitude per
 * axis. */
static void bilinear_fades_as_its_transfer_function_says(void **state) {
    (void)state;
    float image[W * H], channel[4][CW * CH];
    for (int i = 0; i <= W / 4; i += 3) {
        const double k = 2 * PI * 2 * i / W, re = 0.75 + 0.25 * cos(k), im = 0.25 * sin(k);
        const double turn =
            atan2(im, re) - k / 4; /* of channel 0, moved to the right; the others by symmetry */
        for (int n = 0; n < W * H; n++) image[n] = (float)cos(2 * PI * i * (n % W) / W);
        split(channel, image, PTIE_DEMOSAIC_BILINEAR, 0, 0);
        for (int c = 0; c < 4; c++)
            for (int x = 1; x < CW - 1; x++) {
                const double expected =
                    hypot(re, im) * cos(k * (x + 0.25) + (c % 2 ? -turn : turn));
                assert_near((double)channel[c][5 * CW + x], expected, 1e-6);
            }
    }
}

static void frames_are_divided_into_their_parts(void **state) {
    (void)state;
    static const struct {
        ptie_layout layout;
        int32_t channels, across, down;
    } cases[] = {{PTIE_LAYOUT_SEPARATE, 1, 1, 1},
                 {PTIE_LAYOUT_SIDE_BY_SIDE, 2, 2, 1},
                 {PTIE_LAYOUT_TOP_BOTTOM, 2, 1, 2},
                 {PTIE_LAYOUT_QUADRANTS, 4, 2, 2}};
    enum { OW = 9, OH = 7 }; /* odd: the last column or row is not used */
    float image[OW * OH], part[4][OW * OH];
    for (int i = 0; i < OW * OH; i++) image[i] = (float)i;
    for (int n = 0; n < 4; n++) {
        ptie_splitter_params p;
        ptie_splitter_params_init(&p);
        p.width_px = OW, p.height_px = OH, p.layout = cases[n].layout;
        ptie_splitter *splitter;
        assert_ok(ptie_splitter_create(&splitter, &p));
        int32_t width, height;
        assert_int_equal(ptie_splitter_channels(splitter, &width, &height), cases[n].channels);
        assert_true(width == OW / cases[n].across && height == OH / cases[n].down);
        void *scratch = ptie_scratch_alloc(ptie_splitter_scratch_bytes(splitter));
        float *out[4] = {part[0], part[1], part[2], part[3]};
        part[0][0] = -1, out[0] = cases[n].channels > 1 ? NULL : out[0]; /* NULL: not needed */
        assert_ok(ptie_splitter_run(splitter, out, image, scratch));
        assert_true(part[0][0] == (cases[n].channels > 1 ? -1 : 0));
        for (int c = cases[n].channels > 1; c < cases[n].channels; c++)
            for (int i = 0; i < width * height; i++) {
                const int x = c % cases[n].across * width + i % width,
                          y = c / cases[n].across * height + i / width;
                assert_true(part[c][i] == image[y * OW + x]);
            }
        ptie_scratch_free(scratch);
        ptie_splitter_free(splitter);
    }
}

static void arguments_are_checked(void **state) {
    (void)state;
    ptie_splitter_params p;
    ptie_splitter_params_init(&p);
    ptie_splitter *splitter;
    assert_fails(ptie_splitter_create(&splitter, &p), PTIE_EINVAL,
                 "width_px is out of range (expected 2..32768, found 0)");
    p.width_px = p.height_px = 4;
    p.roi_x_px = -1;
    assert_fails(ptie_splitter_create(&splitter, &p), PTIE_EINVAL, "roi_x_px");
    assert_null(splitter);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pixels_go_to_their_channel_for_any_region),
        cmocka_unit_test(none_keeps_the_pixels),
        cmocka_unit_test(bilinear_keeps_planes_at_the_centres_of_the_cells),
        cmocka_unit_test(fourier_keeps_band_limited_images),
        cmocka_unit_test(bilinear_fades_as_its_transfer_function_says),
        cmocka_unit_test(frames_are_divided_into_their_parts),
        cmocka_unit_test(arguments_are_checked),
    };
    return cmocka_run_group_tests_name("split", tests, NULL, NULL);
}
