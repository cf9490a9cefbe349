/* SPDX-License-Identifier: BSD-3-Clause */
/* Phantom CINE: every packing (tests/golden/make_cameras.py), headers of all ages, damage. */
#include "support/files.h"

#include <math.h>
#include <stdlib.h>

#include "golden.h"
#include "io/recording.h"

static void every_packing_is_read(void **state) {
    (void)state;
    static const struct {
        const char *name, *sample;
        double factor;
        int32_t depth;
        bool bottom_up;
    } files[] = {{"plain8.cine", "u8", 1, 8, true},
                 {"plain16.cine", "u16", 27, 12, false},
                 {"old.cine", "u16", 27, 16, true},
                 {"packed10.cine:/codes", "u10 packed", 7, 10, false},
                 {"packed12.cine", "u12 packed", 27, 12, true}};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        ptie_recording *recording = golden_open(golden_camera(files[i].name));
        const ptie_recording_info *info = ptie_recording_get_info(recording);
        assert_string_equal(info->sample, files[i].sample);
        assert_int_equal(info->bit_depth, files[i].depth);
        assert_int_equal(info->bottom_up, files[i].bottom_up);
        golden_check_camera(recording, "CINE", 3, files[i].factor);
        ptie_recording_close(recording);
    }
}

/* Codes become counts that are linear in light: the inverse transfer function of BT.709 between
   black 64 and white 1014 -> 4064; half a count of rounding, and the 0.35 that the maker rounds up.
 */
static void ten_bits_are_expanded(void **state) {
    (void)state;
    float data[GOLDEN_PIXELS];
    ptie_recording *recording = golden_open(golden_camera("packed10.cine"));
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    assert_int_equal(info->bit_depth, 12);
    assert_true(info->black_level == 64 && info->white_level == 4064);
    for (int64_t t = 0; t < 3; t++) {
        assert_ok(ptie_recording_read(recording, t, data));
        for (int32_t i = 0; i < GOLDEN_PIXELS; i++) {
            const double code = 7 * golden_value("u", t, i), v = (code - 64) / 950;
            const double light = v < 0.0812 ? v / 4.5 : pow((v + 0.099) / 1.099, 1 / 0.45);
            /* 1 for the published, shorter constants of the curve: at most 0.6 counts, measured */
            assert_near((double)data[i], code > 1014 ? 4095 : 64 + 4000 * light, 0.85 + 1);
        }
    }
    ptie_recording_close(recording);
}

static void a_header_is_understood(void **state) {
    (void)state;
    ptie_recording *recording = golden_open(golden_camera("plain16.cine"));
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    assert_string_equal(info->camera, "v2512, serial 4711");
    assert_string_equal(info->date, "2023-11-14 22:13:20 UTC");
    assert_string_equal(info->comment, "a  ? plum");
    assert_string_equal(info->trigger, "at frame 2");
    /* Stamps count 2^-32 s and lose their last two bits: at most 4 of 954437 units in two
     * intervals. */
    assert_near(info->frame_rate_hz, 9000, 9000 * 4.2e-6);
    assert_int_equal(info->skip, 10);
    assert_true(info->exposure_s == 9.7e-6);
    assert_true(info->pixel_m == 2e-5);
    assert_true(info->black_level == 64 && info->white_level == 4064);
    assert_int_equal(info->recorded, 3);
    ptie_recording_close(recording);
}

/* Fields that an old SETUP does not have yet are not read from what follows it. */
static void an_old_header_says_less(void **state) {
    (void)state;
    ptie_recording *recording = golden_open(golden_camera("old.cine"));
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    assert_string_equal(info->camera, "Phantom");
    assert_string_equal(info->comment, "");
    assert_true(info->frame_rate_hz == 65535 && info->skip == 1);
    assert_true(info->exposure_s == 10e-6);
    assert_true(info->black_level == 0 && info->white_level == 0);
    ptie_recording_close(recording);
}

static void a_short_file_is_read_as_far_as_it_goes(void **state) {
    (void)state;
    size_t bytes;
    unsigned char *data = support_read(golden_camera("old.cine"), &bytes);
    const char *path = support_temporary("short.cine");
    for (int64_t frames = 2; frames >= 1; frames--) {
        support_write(path, data,
                      bytes -
                          (size_t)(3 - frames) * 78); /* 8 + 70 bytes of a frame, or a few more */
        ptie_recording *recording = golden_open(path);
        const ptie_recording_info *info = ptie_recording_get_info(recording);
        char expected[100];
        snprintf(expected, sizeof expected, "file is cut short: %d of 3 frames are there",
                 (int)frames);
        assert_string_equal(info->warning, expected);
        golden_check_camera(recording, "CINE", frames, 27);
        ptie_recording_close(recording);
    }
    support_write(path, data, 320);
    ptie_recording *recording;
    assert_fails(ptie_recording_open(&recording, path), PTIE_EFORMAT, "no frame of 7 x 5 px");
    free(data);
}

static ptie_status read_all(const char *path) {
    ptie_recording *recording;
    float data[GOLDEN_PIXELS];
    PTIE_TRY(ptie_recording_open(&recording, path));
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    ptie_status status = PTIE_OK;
    if (info->width_px * info->height_px <= GOLDEN_PIXELS)
        for (int64_t t = 0; t < info->frames && status == PTIE_OK; t++)
            status = ptie_recording_read(recording, t, data);
    ptie_recording_close(recording);
    return status;
}

/* Up to the first whole frame it is refused; every changed byte is an error with a name, or none.
 */
static void damage_is_survived(void **state) {
    (void)state;
    size_t bytes;
    unsigned char *data = support_read(golden_camera("old.cine"), &bytes);
    const char *path = support_temporary("cut.cine");
    support_check_changes(golden_camera("old.cine"), read_all);
    for (size_t length = 0; length < 84 + 144 + 24 + 78; length++) {
        support_write(path, data, length);
        assert_int_not_equal(read_all(path), PTIE_OK);
        assert_non_null(strstr(ptie_last_error(), path));
    }
    free(data);
}

static void put(unsigned char *data, size_t at, size_t count, uint64_t value) {
    for (size_t i = 0; i < count; i++) data[at + i] = (unsigned char)(value >> 8 * i);
}

static void headers_that_lie(void **state) {
    (void)state;
    static const struct {
        size_t at, bytes;
        uint64_t value;
        ptie_status status;
        const char *fragment;
    } lies[] = {{4, 2, 1, PTIE_EUNSUPPORTED, "expected compression 0 or 2, found 1"},
                {44 + 14, 2, 24, PTIE_EUNSUPPORTED, "expected 8 or 16, found 24"},
                {44 + 16, 4, 2, PTIE_EUNSUPPORTED, "expected 0, 256 or 1024, found 2"},
                {44 + 4, 4, 0, PTIE_EFORMAT, "found 0 x 5"},
                {44 + 4, 4, 32768, PTIE_EFORMAT, "too short"},
                {44 + 8, 4, 0xffffffff, PTIE_EUNSUPPORTED, "too large"},
                {20, 4, 0, PTIE_EFORMAT, "offsets of 0 images"},
                {20, 4, 0xffffffff, PTIE_EFORMAT, "offsets of 4294967295 images"},
                {32, 4, 0xffffffff, PTIE_EFORMAT, "offsets of 3 images"},
                {84 + 140, 2, 0, PTIE_EFORMAT, "no SETUP"}};
    size_t bytes;
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        ptie_recording *recording;
        const char *path = support_temporary("lie.cine");
        unsigned char *data = support_read(golden_camera("old.cine"), &bytes);
        put(data, lies[i].at, lies[i].bytes, lies[i].value);
        support_write(path, data, bytes);
        free(data);
        assert_fails(ptie_recording_open(&recording, path), lies[i].status, lies[i].fragment);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_packing_is_read),
        cmocka_unit_test(ten_bits_are_expanded),
        cmocka_unit_test(a_header_is_understood),
        cmocka_unit_test(an_old_header_says_less),
        cmocka_unit_test(a_short_file_is_read_as_far_as_it_goes),
        cmocka_unit_test(damage_is_survived),
        cmocka_unit_test(headers_that_lie),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
