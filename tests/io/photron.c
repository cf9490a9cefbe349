/* SPDX-License-Identifier: BSD-3-Clause */
/* Photron MRAW: every packing (tests/golden/make_cameras.py), what headers say, and what we write.
 */
#include "support/files.h"

#include <stdlib.h>
#include <sys/stat.h>

#include "golden.h"
#include "io/recording.h"

static void every_packing_is_read(void **state) {
    (void)state;
    static const struct {
        const char *name, *sample;
        double factor;
        int32_t depth;
    } files[] = {{"u8.mraw", "u8", 1, 8},
                 {"u10.mraw", "u10 packed", 7, 10},
                 {"u12.mraw", "u12 packed", 27, 12},
                 {"padded.mraw", "u12 packed", 27, 12},
                 {"u16.mraw", "u16", 27, 12},
                 {"higher.mraw", "u16", 27, 12},
                 {"xml.mraw", "u12 packed", 27, 12},
                 {"xml.cihx", "u12 packed", 27, 12},
                 {"u16.cih", "u16", 27, 12}};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        ptie_recording *recording = golden_open(golden_camera(files[i].name));
        const ptie_recording_info *info = ptie_recording_get_info(recording);
        assert_string_equal(info->sample, files[i].sample);
        assert_int_equal(info->bit_depth, files[i].depth);
        assert_string_equal(info->warning, "");
        golden_check_camera(recording, "MRAW", 3, files[i].factor);
        ptie_recording_close(recording);
    }
}

static void a_text_header_is_understood(void **state) {
    (void)state;
    ptie_recording *recording = golden_open(golden_camera("u12.cih"));
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    assert_string_equal(info->camera, "FASTCAM Test");
    assert_string_equal(info->date, "2024/2/29 23:59");
    assert_string_equal(info->comment, "gr??e"); /* Latin-1 */
    assert_string_equal(info->trigger, "Start");
    assert_true(info->frame_rate_hz == 60000.0 / 36);
    assert_true(info->exposure_s == 1250e-9);
    assert_true(info->black_level == 0 && info->white_level == 4095);
    assert_int_equal(info->skip, 36);
    assert_int_equal(info->recorded, 3);
    ptie_recording_close(recording);
}

static void an_xml_header_is_understood(void **state) {
    (void)state;
    ptie_recording *recording = golden_open(golden_camera("xml.cihx"));
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    assert_string_equal(info->camera, "FASTCAM Test X");
    assert_string_equal(info->date, "2024/2/29 23:59");
    assert_string_equal(info->comment, "a < b & c");
    assert_string_equal(info->trigger, "mode 7");
    assert_true(info->frame_rate_hz == 20);
    assert_true(info->exposure_s == 1.0 / 200000);
    assert_int_equal(info->roi_x_px, 129);
    assert_int_equal(info->roi_y_px, 64);
    ptie_recording_close(recording);
}

static void a_short_file_is_read_as_far_as_it_goes(void **state) {
    (void)state;
    ptie_recording *recording = golden_open(golden_camera("short.mraw"));
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    assert_string_equal(info->warning, "file is cut short: 3 of 9 frames are there");
    assert_int_equal(info->recorded, 9);
    golden_check_camera(recording, "MRAW", 3, 27);
    ptie_recording_close(recording);
}

/* A header of one changed line beside the frames of u16.mraw. */
static void headers_that_lie(void **state) {
    (void)state;
    static const struct {
        const char *from, *to;
        ptie_status status;
        const char *fragment;
    } lies[] = {
        {"Color Bit : 16", "Color Bit : 14", PTIE_EUNSUPPORTED,
         "expected 8, 10, 12 or 16, found 14"},
        {"Color Bit : 16", "Color Bit : 12", PTIE_EFORMAT, "3 frames of 53 or 80 bytes, found 210"},
        {"Type : Mono", "Type : Color", PTIE_EUNSUPPORTED, "colour"},
        {"Format : MRaw", "Format : Tiff", PTIE_EUNSUPPORTED, "found Tiff"},
        {"Width : 7", "Width : 0", PTIE_EFORMAT, "found 0 x 5"},
        {"Width : 7", "Width :-7", PTIE_EUNSUPPORTED, "too large"},
        {"Width : 7", "Width : x", PTIE_EFORMAT, "found 0 x 5"},
        {"Width : 7\r\nImage Height: 5", "Width : 32768\r\nImage Height: 32768", PTIE_EFORMAT,
         "too short"},
        {"Frame : 3", "Frame : 0", PTIE_EFORMAT, "number of frames"},
        {"Frame : 3", "Frame : 9223372036854775807", PTIE_EFORMAT, "number of frames"},
        {"#Camera", "#Kamera", PTIE_EFORMAT, "not a CIHX header"},
    };
    size_t bytes;
    unsigned char *frames = support_read(golden_camera("u16.mraw"), &bytes);
    support_write(support_temporary("lie.mraw"), frames, bytes);
    free(frames);
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        ptie_recording *recording;
        char text[2000];
        char *header = (char *)support_read(golden_camera("u16.cih"), &bytes);
        const char *at = memmem(header, bytes, lies[i].from, strlen(lies[i].from));
        assert_non_null(at);
        const int length = snprintf(
            text, sizeof text, "%.*s%s%.*s", (int)(at - header), header, lies[i].to,
            (int)(bytes - (size_t)(at - header) - strlen(lies[i].from)), at + strlen(lies[i].from));
        support_write(support_temporary("lie.cih"), text, (size_t)length);
        print_message("# %s\n", lies[i].to);
        assert_fails(ptie_recording_open(&recording, support_temporary("lie.mraw")), lies[i].status,
                     lies[i].fragment);
        free(header);
    }
}

static ptie_status read_one(const char *path) {
    ptie_recording *recording;
    float data[GOLDEN_PIXELS];
    PTIE_TRY(ptie_recording_open(&recording, path));
    assert_int_equal(ptie_recording_get_info(recording)->width_px, GOLDEN_WIDTH);
    const ptie_status status = ptie_recording_read(recording, 0, data);
    ptie_recording_close(recording);
    return status;
}

/* An XML header needs its end; what is behind it is not looked at. */
static void a_cut_header_is_refused(void **state) {
    (void)state;
    size_t bytes, frame_bytes;
    unsigned char *header = support_read(golden_camera("xml.cihx"), &bytes);
    unsigned char *frames = support_read(golden_camera("xml.mraw"), &frame_bytes);
    support_write(support_temporary("cut.mraw"), frames, frame_bytes);
    const char *path = support_temporary("cut.cihx");
    const unsigned char *end = memmem(header, bytes, "</cih>", 6);
    for (size_t length = 0; length <= bytes; length++) {
        support_write(path, header, length);
        if (length < (size_t)(end - header) + 6)
            assert_fails(read_one(path), PTIE_EFORMAT, "cut.cihx");
        else
            assert_ok(read_one(path));
    }
    free(header);
    free(frames);
}

static void the_other_file_is_missing(void **state) {
    (void)state;
    ptie_recording *recording;
    support_write(support_temporary("alone.mraw"), "x", 1);
    support_write(support_temporary("alone2.cih"), "#Camera Information Header\n", 27);
    assert_fails(ptie_recording_open(&recording, support_temporary("alone.mraw")), PTIE_EIO,
                 "expected a .cihx or .cih beside it");
    assert_fails(ptie_recording_open(&recording, support_temporary("alone2.cih")), PTIE_EIO,
                 "expected the .mraw beside it");
    assert_fails(ptie_recording_open(&recording, support_temporary("nothere.mraw")), PTIE_EIO,
                 "No such file");
}

static void a_header_alone_is_described(void **state) {
    (void)state;
    size_t bytes;
    ptie_recording_info info;
    unsigned char *header = support_read(golden_camera("u12.cih"), &bytes);
    const char *path = support_temporary("header.cih");
    support_write(path, header, bytes);
    free(header);
    assert_ok(ptie_recording_describe(&info, path));
    assert_string_equal(info.format, "MRAW");
    assert_string_equal(info.camera, "FASTCAM Test");
    assert_non_null(strstr(info.warning, "header alone"));
    assert_true(info.frames == 0 && info.recorded == 3 && info.width_px == 7);
    assert_ok(ptie_recording_describe(&info, golden_camera("u12.cih")));
    assert_true(info.frames == 3 && !*info.warning);
    support_write(support_temporary("frames.mraw"), "x", 1);
    assert_fails(ptie_recording_describe(&info, support_temporary("frames.mraw")), PTIE_EIO,
                 ".cihx or .cih beside it");
    assert_fails(ptie_recording_describe(&info, support_temporary("nothere.cih")), PTIE_EIO,
                 "No such file");
}

/* --- writing ---------------------------------------------------------------------------------- */

static const ptie_recording_info camera = {.width_px = GOLDEN_WIDTH,
                                           .height_px = GOLDEN_HEIGHT,
                                           .frame_rate_hz = 25000,
                                           .camera = "Simulated <1> & co",
                                           .date = "2024/2/29 23:59",
                                           .comment = "jet",
                                           .exposure_s = 2.5e-6,
                                           .bit_depth = 12,
                                           .roi_x_px = 33,
                                           .roi_y_px = 2,
                                           .skip = 4};

/* Three frames 27 f + 0.4, with one pixel below and one above what 12 bits hold. */
static ptie_status write_frames(const char *path, const ptie_recording_info *info) {
    ptie_writer *writer;
    float data[GOLDEN_PIXELS];
    PTIE_TRY(ptie_writer_create(&writer, path, "counts", info, false));
    for (int64_t t = 0; t < 3; t++) {
        for (int32_t i = 0; i < GOLDEN_PIXELS; i++)
            data[i] = (float)(27 * golden_value("u", t, i) + 0.4);
        if (t == 0) data[0] = -3;
        const ptie_status status = ptie_writer_append(writer, data);
        if (status != PTIE_OK) {
            ptie_writer_discard(writer);
            return status;
        }
    }
    return ptie_writer_close(writer);
}

static void what_is_written_is_read(void **state) {
    (void)state;
    static const char *const samples[] = {"", "u16"};
    for (int i = 0; i < 2; i++) {
        ptie_recording_info info = camera;
        const char *path = support_temporary(i ? "b.mraw" : "a.mraw");
        snprintf(info.sample, sizeof info.sample, "%s", samples[i]);
        assert_ok(write_frames(path, &info));
        ptie_recording *recording = golden_open(path);
        const ptie_recording_info *found = ptie_recording_get_info(recording);
        assert_string_equal(found->sample, i ? "u16" : "u12 packed");
        assert_string_equal(found->camera, camera.camera);
        assert_string_equal(found->date, camera.date);
        assert_string_equal(found->comment, camera.comment);
        assert_true(found->frame_rate_hz == camera.frame_rate_hz && found->skip == camera.skip);
        assert_near(found->exposure_s, camera.exposure_s, 1e-20); /* 15 digits */
        assert_int_equal(found->bit_depth, 12);
        assert_int_equal(found->roi_x_px, camera.roi_x_px);
        assert_int_equal(found->roi_y_px, camera.roi_y_px);
        golden_check_camera(recording, "MRAW", 3, 27);
        ptie_recording_close(recording);
    }
}

/* 2^depth - 1 is the most, whatever the container holds. */
static void counts_are_rounded_and_clipped(void **state) {
    (void)state;
    static const float values[] = {-1e9f, -0.4f, 0.49f, 0.51f, 1022.4f, 1022.6f, 1024, 1e9f};
    static const float expected[] = {0, 0, 0, 1, 1022, 1023, 1023, 1023};
    ptie_writer *writer;
    ptie_recording *recording;
    float data[8];
    const ptie_recording_info info = {.width_px = 8, .height_px = 1, .frames = 1, .bit_depth = 10};
    const char *path = support_temporary("clipped.mraw");
    assert_ok(ptie_writer_create(&writer, path, "counts", &info, false));
    assert_ok(ptie_writer_append(writer, values));
    assert_ok(ptie_writer_close(writer));
    assert_ok(ptie_recording_open(&recording, path));
    assert_string_equal(ptie_recording_get_info(recording)->sample, "u16");
    assert_ok(ptie_recording_read(recording, 0, data));
    for (int i = 0; i < 8; i++) assert_true(data[i] == expected[i]);
    ptie_recording_close(recording);
}

/* As an independent reader does it: ElementTree and unpackbits. */
static void python_reads_it(void **state) {
    (void)state;
    const char *path = support_temporary("python.mraw");
    assert_ok(write_frames(path, &camera));
    support_python("import sys, numpy as np, xml.etree.ElementTree as et\n"
                   "head = open(sys.argv[1].replace('.mraw', '.cihx'), 'rb').read()\n"
                   "assert head[256:260] == b'CIHX'\n"
                   "at, n = (int.from_bytes(head[i:i + 8], 'little') for i in (276, 284))\n"
                   "x = et.fromstring(head[at:at + n])\n"
                   "text = lambda path: x.find(path).text\n"
                   "assert text('imageDataInfo/colorInfo/bit') == '12' and x.tag == 'cih'\n"
                   "assert text('recordInfo/recordRate') == '100000'\n"
                   "assert text('deviceInfo/deviceName') == 'Simulated <1> & co'\n"
                   "assert text('frameInfo/totalFrame') == '3'\n"
                   "bits = np.unpackbits(np.fromfile(sys.argv[1], 'u1').reshape(3, 53), axis=1)\n"
                   "v = bits[:, :420].reshape(3, 35, 12) @ (1 << np.arange(11, -1, -1))\n"
                   "t, i = np.mgrid[:3, :35]\n"
                   "assert (v == 27 * (i % 7 + i // 7 * 10 + 50 * t)).all()\n",
                   path);
}

static void both_files_or_none(void **state) {
    (void)state;
    ptie_writer *writer;
    float data[GOLDEN_PIXELS] = {0};
    const char *path = support_temporary("both.mraw"), *header = support_temporary("both.cihx");
    assert_ok(ptie_writer_create(&writer, path, "counts", &camera, false));
    assert_ok(ptie_writer_append(writer, data));
    assert_false(support_exists(path) || support_exists(header));
    ptie_writer_discard(writer);
    support_assert_nothing_left(path);
    support_assert_nothing_left(header);
    support_write(header, "mine", 4);
    assert_fails(ptie_writer_create(&writer, path, "counts", &camera, false), PTIE_EEXIST,
                 "both.cihx");
    support_assert_nothing_left(path);
    data[3] = __builtin_nanf("");
    assert_ok(ptie_writer_create(&writer, path, "counts", &camera, true));
    assert_fails(ptie_writer_append(writer, data), PTIE_ENUMERIC, "x=3, y=0");
    ptie_writer_discard(writer);
    support_assert_nothing_left(path);
    size_t bytes;
    free(support_read(header, &bytes));
    assert_int_equal(bytes, 4);
}

/* Large enough that the frames meet the full disk before the header does. */
static ptie_status write_large(const char *path) {
    ptie_writer *writer;
    static float data[256 * 256];
    const ptie_recording_info info = {.width_px = 256, .height_px = 256};
    PTIE_TRY(ptie_writer_create(&writer, path, "counts", &info, true));
    const ptie_status status = ptie_writer_append(writer, data);
    if (status == PTIE_OK) return ptie_writer_close(writer);
    ptie_writer_discard(writer);
    return status;
}

static void a_full_disk_is_reported(void **state) {
    (void)state;
    support_check_full_disk(support_temporary("full.mraw"), write_large);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_packing_is_read),
        cmocka_unit_test(a_text_header_is_understood),
        cmocka_unit_test(an_xml_header_is_understood),
        cmocka_unit_test(a_short_file_is_read_as_far_as_it_goes),
        cmocka_unit_test(headers_that_lie),
        cmocka_unit_test(a_cut_header_is_refused),
        cmocka_unit_test(the_other_file_is_missing),
        cmocka_unit_test(a_header_alone_is_described),
        cmocka_unit_test(what_is_written_is_read),
        cmocka_unit_test(counts_are_rounded_and_clipped),
        cmocka_unit_test(python_reads_it),
        cmocka_unit_test(both_files_or_none),
        cmocka_unit_test(a_full_disk_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
