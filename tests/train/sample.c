/* SPDX-License-Identifier: BSD-3-Clause */
/* Presets, and the samples drawn from them. */
#include "train/tiny.h"

#include <math.h>
#include <stdlib.h>

#include <ptie/flow.h>

#include "train/preset.h"

#define TWO_PI 6.283185307179586476925

static void built_in_presets_print_and_read_back(void **state) {
    (void)state;
    assert_null(ptie_preset_name(-1));
    int32_t count = 0;
    for (const char *name; (name = ptie_preset_name(count)); count++) {
        ptie_preset *preset, *copy;
        assert_ok(ptie_preset_load(&preset, name));
        const char *text = ptie_preset_text(preset), *path = support_temporary("copy.ini");
        support_write(path, text, strlen(text));
        assert_ok(ptie_preset_load(&copy, path));
        assert_string_equal(ptie_preset_text(copy), text);
        assert_non_null(strstr(text, name));
        ptie_preset_free(copy);
        ptie_preset_free(preset);
    }
    assert_int_equal(count, 2);
    assert_null(ptie_preset_name(count));
}

static void paper_preset_has_the_papers_numbers(void **state) {
    (void)state;
    ptie_preset *preset;
    int32_t width, height;
    assert_ok(ptie_preset_load(&preset, "paper"));
    ptie_preset_size(preset, &width, &height);
    assert_int_equal(width, 256);
    assert_int_equal(height, 256);
    assert_near(preset->wavelength_m, 532e-9, 0);
    assert_near(preset->pixel_m, 20e-6, 0);
    assert_near(preset->defocus_m, 10e-3, 0);
    assert_int_equal(preset->mix.family, PTIE_PARAMETRIC);
    ptie_preset_free(preset);
}

static void a_file_changes_what_it_names_and_keeps_its_base(void **state) {
    (void)state;
    static const char text[] =
        "[image]\nwidth = 48\n[preset]\nbase = realistic\n[optics]\ndefocus = 5 mm\n"
        "[morphologies]\nplasma = 0\n";
    const char *path = support_temporary("mine.ini");
    support_write(path, text, sizeof text - 1);
    ptie_preset *mine, *base;
    assert_ok(ptie_preset_load(&mine, path));
    assert_ok(ptie_preset_load(&base, "realistic"));
    assert_int_equal(mine->width_px, 48);
    assert_int_equal(mine->height_px, base->height_px);
    assert_near(mine->defocus_m, 5e-3, 0);
    assert_int_equal(mine->propagation, base->propagation);
    assert_int_equal(mine->mix.family, PTIE_PHYSICAL);
    assert_string_equal(mine->name, "custom");
    for (int i = 0; i < PTIE_MORPHOLOGIES; i++) {
        const bool plasma = strcmp(ptie_morphology_name(i), "plasma") == 0;
        assert_near(mine->mix.weight[i], plasma ? 0 : base->mix.weight[i], 0);
    }
    ptie_preset_free(mine);
    ptie_preset_free(base);
}

static void load_text(const char *text, ptie_status status, const char *fragment) {
    const char *path = support_temporary("bad.ini");
    ptie_preset *preset;
    support_write(path, text, strlen(text));
    assert_fails(ptie_preset_load(&preset, path), status, fragment);
    assert_null(preset);
}

static void bad_presets_are_named(void **state) {
    (void)state;
    ptie_preset *preset;
    assert_fails(ptie_preset_load(&preset, "papr"), PTIE_ENAME, "did you mean 'paper'");
    assert_null(preset);
    assert_fails(ptie_preset_load(&preset, "absent.ini"), PTIE_EIO, "absent.ini");
    assert_fails(ptie_preset_load(&preset, "/tmp/"), PTIE_EIO, "/tmp/");
    load_text("[optics]\nwavelenght = 532 nm\n", PTIE_ENAME, "did you mean 'wavelength'");
    load_text("[optic]\nwavelength = 532 nm\n", PTIE_ENAME, "did you mean [optics]");
    load_text("[morphologies]\nshok = 1\n", PTIE_ENAME, "did you mean 'shock'");
    load_text("[optics]\nwavelength = 532\n", PTIE_EFORMAT,
              "bad.ini:2: wavelength: expected a length");
    load_text("[preset]\nbase = papers\n", PTIE_ENAME, "did you mean 'paper'");
    load_text("[image]\nwidth = 8\n", PTIE_EFORMAT, "out of range");
    load_text("[camera]\nnoise = 0 .. 5 %\n", PTIE_EFORMAT, "log-uniform");
    load_text("[morphologies]\njet = 0\neddies = 0\nfront = 0\npockets = 0\nfan = 0\ndiffusion = "
              "0\nshock = 0\n"
              "combustion = 0\nplasma = 0\nrandom = 0\nnozzle = 0\n",
              PTIE_EFORMAT, "nothing to draw");
}

/* Maps of a sample in rad, without their means. */
static void draw_rad(const ptie_preset *preset, uint64_t index, float *clean, float *noisy,
                     ptie_sample_info *info) {
    int32_t width, height;
    ptie_preset_size(preset, &width, &height);
    const size_t count = (size_t)width * (size_t)height;
    assert_ok(ptie_preset_sample(preset, 11, index, clean, noisy, info));
    double clean_mean = 0, noisy_mean = 0;
    for (size_t i = 0; i < count; i++) {
        clean[i] = info->clean_offset_rad + info->clean_scale_rad * clean[i];
        noisy[i] = info->noisy_offset_rad + info->noisy_scale_rad * noisy[i];
        clean_mean += (double)clean[i] / (double)count;
        noisy_mean += (double)noisy[i] / (double)count;
    }
    for (size_t i = 0; i < count; i++) {
        clean[i] -= (float)clean_mean;
        noisy[i] -= (float)noisy_mean;
    }
}

static void samples_lie_in_0_to_1_and_their_info_is_plausible(void **state) {
    (void)state;
    enum { SIDE = 64, COUNT = SIDE * SIDE };
    static float clean[COUNT], noisy[COUNT];
    ptie_preset *preset = tiny_preset(SIDE, "3 % .. 6 %");
    for (uint64_t index = 0; index < 20; index++) {
        ptie_sample_info info;
        assert_ok(ptie_preset_sample(preset, 1, index, clean, noisy, &info));
        float low[2] = {clean[0], noisy[0]}, high[2] = {clean[0], noisy[0]};
        for (int i = 0; i < COUNT; i++) {
            low[0] = fminf(low[0], clean[i]), high[0] = fmaxf(high[0], clean[i]);
            low[1] = fminf(low[1], noisy[i]), high[1] = fmaxf(high[1], noisy[i]);
        }
        for (int i = 0; i < 2; i++) {
            assert_true(low[i] == 0.0f);
            assert_true(high[i] == 1.0f);
        }
        assert_in_range((uintmax_t)(1e6f * info.sigma), 30000, 60000);
        assert_true(info.clean_scale_rad > 0 && info.clean_scale_rad <= 1);
        assert_true(info.morphologies > 0 && info.morphologies < 1u << PTIE_MORPHOLOGIES);
    }
    ptie_preset_free(preset);
}

static void a_sample_does_not_depend_on_what_was_drawn_before(void **state) {
    (void)state;
    enum { SIDE = 32, COUNT = SIDE * SIDE };
    static float first[2][COUNT], again[2][COUNT], other[2][COUNT];
    ptie_preset *preset = tiny_preset(SIDE, "2 % .. 12 %");
    ptie_sample_info info[2];
    assert_ok(ptie_preset_sample(preset, 3, 5, first[0], first[1], &info[0]));
    for (uint64_t index = 9; index > 4; index--)
        assert_ok(ptie_preset_sample(preset, 3, index, again[0], again[1], &info[1]));
    assert_memory_equal(again, first, sizeof first);
    assert_memory_equal(&info[0], &info[1], sizeof info[0]);
    assert_ok(ptie_preset_sample(preset, 3, 6, other[0], other[1], NULL));
    assert_memory_not_equal(other[0], first[0], sizeof first[0]);
    assert_ok(ptie_preset_sample(preset, 4, 5, other[0], other[1], NULL));
    assert_memory_not_equal(other[0], first[0], sizeof first[0]);
    assert_memory_not_equal(other[1], first[1], sizeof first[1]);
    ptie_preset_free(preset);
}

static void without_noise_noisy_is_clean(void **state) {
    (void)state;
    enum { SIDE = 64, COUNT = SIDE * SIDE };
    static float clean[COUNT], noisy[COUNT];
    ptie_preset *preset = tiny_preset(SIDE, "0");
    for (uint64_t index = 0; index < 20; index++) {
        ptie_sample_info info;
        draw_rad(preset, index, clean, noisy, &info);
        assert_true(info.sigma == 0.0f);
        /* Rounding of intensities near 1 (2^-25) and of two transforms; worst of these samples
         * 8e-7. */
        assert_near(support_relative_error(noisy, clean, COUNT), 0, 1e-5);
    }
    ptie_preset_free(preset);
}

/* |sum of map * exp(-2 pi i mode n / SIDE)|^2 along x or y. */
static double mode_power(const float *map, int side, int mode, bool along_y) {
    double re = 0, im = 0;
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            const double angle = TWO_PI * mode * (along_y ? y : x) / side;
            re += (double)map[y * side + x] * cos(angle);
            im -= (double)map[y * side + x] * sin(angle);
        }
    return re * re + im * im;
}

/* White noise of relative standard deviation s per image, divided by k^2: each mode of the error
   has the mean power N^2 (2 pi / lambda)^2 s^2 / (2 dz^2 k^4), so rms = 0.04397 (2 pi / lambda) s N
   p^2 / dz. */
static void the_error_in_rad_is_the_closed_form_noise(void **state) {
    (void)state;
    enum { SIDE = 32, COUNT = SIDE * SIDE, SAMPLES = 400 };
    const double s = 0.05, k_light = TWO_PI / 532e-9, pixel = 20e-6, dz = 10e-3;
    static float clean[COUNT], noisy[COUNT];
    ptie_preset *preset = tiny_preset(SIDE, "5 %");
    double power = 0, mode1 = 0, mode3 = 0;
    for (uint64_t index = 0; index < SAMPLES; index++) {
        ptie_sample_info info;
        draw_rad(preset, index, clean, noisy, &info);
        for (int i = 0; i < COUNT; i++) {
            clean[i] = noisy[i] - clean[i];
            power += (double)clean[i] * (double)clean[i] / COUNT / SAMPLES;
        }
        for (int axis = 0; axis < 2; axis++) {
            mode1 += mode_power(clean, SIDE, 1, axis) / 2 / SAMPLES;
            mode3 += mode_power(clean, SIDE, 3, axis) / 2 / SAMPLES;
        }
    }
    /* Powers of modes are exponentially distributed.  The lattice sums of k^-8 and k^-4 give one
       sample's total power a relative deviation of 0.49, so its root over 400 samples 0.012; the
       mean over 2 x 400 modes has 0.035.  Five of each. */
    const double rms = 0.04397 * k_light * s * SIDE * pixel * pixel / dz;
    assert_near(sqrt(power), rms, 5 * 0.012 * rms);
    const double k1 = TWO_PI / (SIDE * pixel);
    const double expected = COUNT * pow(k_light * s / dz, 2) / 2 / pow(k1, 4);
    assert_near(mode1, expected, 5 * 0.035 * expected);
    assert_near(mode3, expected / 81, 5 * 0.035 * expected / 81);
    ptie_preset_free(preset);
}

static void both_built_in_presets_draw(void **state) {
    (void)state;
    for (int32_t i = 0; ptie_preset_name(i); i++) {
        ptie_preset *preset;
        int32_t width, height;
        assert_ok(ptie_preset_load(&preset, ptie_preset_name(i)));
        ptie_preset_size(preset, &width, &height);
        const size_t count = (size_t)width * (size_t)height;
        float *maps = malloc(2 * count * sizeof *maps);
        for (uint64_t index = 0; index < 4; index++) {
            ptie_sample_info info;
            assert_ok(ptie_preset_sample(preset, 7, index, maps, maps + count, &info));
            for (size_t j = 0; j < 2 * count; j++) assert_true(maps[j] >= 0 && maps[j] <= 1);
            assert_true(info.clean_scale_rad > 0 && info.noisy_scale_rad > 0);
        }
        free(maps);
        ptie_preset_free(preset);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(built_in_presets_print_and_read_back),
        cmocka_unit_test(paper_preset_has_the_papers_numbers),
        cmocka_unit_test(a_file_changes_what_it_names_and_keeps_its_base),
        cmocka_unit_test(bad_presets_are_named),
        cmocka_unit_test(samples_lie_in_0_to_1_and_their_info_is_plausible),
        cmocka_unit_test(a_sample_does_not_depend_on_what_was_drawn_before),
        cmocka_unit_test(without_noise_noisy_is_clean),
        cmocka_unit_test(the_error_in_rad_is_the_closed_form_noise),
        cmocka_unit_test(both_built_in_presets_draw),
    };
    return cmocka_run_group_tests_name("train/sample", tests, NULL, NULL);
}
