/* SPDX-License-Identifier: BSD-3-Clause */
/* Recordings that others wrote (tests/golden/make_images.py), and sequences of them. */
#include "support/files.h"

#include <stdlib.h>
#include <sys/stat.h>

#include "golden.h"
#include "io/recording.h"

enum { FRAMES = 3 };

/* Opens, checks what the info says, reads every frame, last first, and compares every pixel. */
static void check_recording(const char *path, const char *format, const char *sample,
                            int64_t frames, unsigned modulus) {
    ptie_recording *recording;
    float data[GOLDEN_PIXELS];
    print_message("# %s\n", path);
    assert_ok(ptie_recording_open(&recording, path));
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    assert_string_equal(info->format, format);
    assert_string_equal(info->sample, sample);
    assert_int_equal(info->width_px, GOLDEN_WIDTH);
    assert_int_equal(info->height_px, GOLDEN_HEIGHT);
    assert_int_equal(info->frames, frames);
    for (int64_t t = frames - 1; t >= 0; t--) {
        assert_ok(ptie_recording_read(recording, t, data));
        for (int32_t i = 0; i < GOLDEN_PIXELS; i++) {
            double value = golden_value(sample, t, i);
            if (modulus) value = (unsigned)value % modulus;
            if ((double)data[i] == value) continue;
            fail_msg("%s: frame %d, pixel %d: expected %g, found %g", path, (int)t, i, value,
                     (double)data[i]);
        }
    }
    assert_fails(ptie_recording_read(recording, frames, data), PTIE_EINVAL, "frame");
    assert_fails(ptie_recording_read(recording, -1, data), PTIE_EINVAL, "frame");
    ptie_recording_close(recording);
}

static void npy_of_every_type(void **state) {
    (void)state;
    static const char *const types[][2] = {
        {"u1", "u8"},  {"i1", "i8"},      {"u2", "u16"},       {"u2_big", "u16"},
        {"i2", "i16"}, {"i2_big", "i16"}, {"u4", "u32"},       {"u4_big", "u32"},
        {"i4", "i32"}, {"i4_big", "i32"}, {"u8", "u64"},       {"u8_big", "u64"},
        {"i8", "i64"}, {"i8_big", "i64"}, {"f4", "f32"},       {"f4_big", "f32"},
        {"f8", "f64"}, {"f8_big", "f64"}, {"version2", "u16"}, {"version3", "u16"},
    };
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        char name[40];
        snprintf(name, sizeof name, "%s.npy", types[i][0]);
        check_recording(golden_image(name), "NPY", types[i][1], FRAMES, 0);
    }
    check_recording(golden_image("one_frame.npy"), "NPY", "f32", 1, 0);
}

static void png_of_every_depth(void **state) {
    (void)state;
    check_recording(golden_image("grey1.png"), "PNG", "u8", 1, 2);
    check_recording(golden_image("grey2.png"), "PNG", "u8", 1, 4);
    check_recording(golden_image("grey4.png"), "PNG", "u8", 1, 16);
    check_recording(golden_image("grey8.png"), "PNG", "u8", 1, 0);
    check_recording(golden_image("grey16.png"), "PNG", "u16", 1, 0);
    check_recording(golden_image("interlaced.png"), "PNG", "u8", 1, 0);
    check_recording(golden_image("interlaced16.png"), "PNG", "u16", 1, 0);
    check_recording(golden_image("palette.png"), "PNG", "u8", 1, 0);
    check_recording(golden_image("opaque.png"), "PNG", "u8", 1, 0);
    check_recording(golden_image("rgb_grey.png"), "PNG", "u8", 1, 0);
    check_recording(golden_image("pil16.png"), "PNG", "u16", 1, 0);
}

static void tiff_of_every_kind(void **state) {
    (void)state;
    check_recording(golden_image("u1.tif"), "TIFF", "u8", FRAMES, 0);
    check_recording(golden_image("u2.tif"), "TIFF", "u16", FRAMES, 0);
    check_recording(golden_image("i2.tif"), "TIFF", "i16", FRAMES, 0);
    check_recording(golden_image("u4.tif"), "TIFF", "u32", FRAMES, 0);
    check_recording(golden_image("f4.tif"), "TIFF", "f32", FRAMES, 0);
    check_recording(golden_image("f8.tif"), "TIFF", "f64", FRAMES, 0);
    check_recording(golden_image("big_endian.tif"), "TIFF", "u16", FRAMES, 0);
    check_recording(golden_image("bigtiff.tif"), "TIFF", "f32", FRAMES, 0);
    check_recording(golden_image("bigtiff_big_endian.tif"), "TIFF", "f32", FRAMES, 0);
    check_recording(golden_image("strips.tif"), "TIFF", "u16", FRAMES, 0);
    check_recording(golden_image("tiles.tif"), "TIFF", "u16", FRAMES, 0);
    check_recording(golden_image("deflate.tif"), "TIFF", "u16", FRAMES, 0);
    check_recording(golden_image("lzw.tif"), "TIFF", "u8", 1, 0);
    check_recording(golden_image("imagej.tif"), "TIFF", "f32", FRAMES, 0);
}

static void imagej_scale_is_read(void **state) {
    (void)state;
    ptie_recording *recording;
    assert_ok(ptie_recording_open(&recording, golden_image("imagej.tif")));
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    assert_near(info->pixel_m, 2e-6, 1e-20); /* 0.5 pixels per um */
    assert_near(info->frame_rate_hz, 4, 1e-12);
    ptie_recording_close(recording);
}

static void hdf5_named_or_found(void **state) {
    (void)state;
    char path[300];
    check_recording(golden_image("only.h5"), "HDF5", "u16", FRAMES, 0);
    check_recording(golden_image("block.h5"), "HDF5", "f64", 1, 0);
    check_recording(golden_image("nexus.h5"), "HDF5", "f32", FRAMES, 0);
    snprintf(path, sizeof path, "%s:/plus", golden_image("several.h5"));
    check_recording(path, "HDF5", "u8", FRAMES, 0);
    snprintf(path, sizeof path, "%s:/minus", golden_image("several.h5"));
    check_recording(path, "HDF5", "i32", FRAMES, 0);
    snprintf(path, sizeof path, "%s:/link", golden_image("several.h5"));
    check_recording(path, "HDF5", "u8", FRAMES, 0);
}

static void nexus_units_are_read(void **state) {
    (void)state;
    ptie_recording *recording;
    assert_ok(ptie_recording_open(&recording, golden_image("nexus.h5")));
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    assert_string_equal(info->dataset, "/entry/plot/phase");
    assert_string_equal(info->unit, "rad");
    assert_near(info->pixel_m, 2e-6, 1e-20);
    assert_near(info->frame_rate_hz, 2000, 1e-9);
    ptie_recording_close(recording);
}

typedef struct refusal {
    const char *name, *inside;
    ptie_status status;
    const char *fragment;
} refusal;

static void what_cannot_be_read_is_named(void **state) {
    (void)state;
    static const refusal cases[] = {
        {"bad_fortran.npy", "", PTIE_EUNSUPPORTED, "Fortran"},
        {"bad_rank.npy", "", PTIE_EUNSUPPORTED, "1 dimensions (expected 2 or 3)"},
        {"bad_complex.npy", "", PTIE_EUNSUPPORTED, "found '<c8'"},
        {"bad_struct.npy", "", PTIE_EUNSUPPORTED, "sample type"},
        {"bad_empty.npy", "", PTIE_EFORMAT, "no valid number of frames"},
        {"bad_white.tif", "", PTIE_EUNSUPPORTED, "not a grey image"},
        {"bad_rgb.tif", "", PTIE_EUNSUPPORTED, "expected 1 sample per pixel, found 3"},
        {"bad_pages.tif", "", PTIE_EUNSUPPORTED,
         "page 1 differs from page 0 (expected 7 x 5 u8, found 7 x 4"},
        {"bad_none.h5", "", PTIE_EFORMAT, "no numeric data set of 2 or 3 dimensions"},
        {"several.h5", "", PTIE_EFORMAT, "found /minus, /plus)"},
        {"several.h5", ":/line", PTIE_EUNSUPPORTED, "/line has 1 dimensions"},
        {"several.h5", ":/volume", PTIE_EUNSUPPORTED, "/volume has 4 dimensions"},
        {"several.h5", ":/none", PTIE_EFORMAT, "/none"},
        {"only.h5", ":/names", PTIE_EUNSUPPORTED, "/names has 0 dimensions"},
        {"u1.npy", ":/plus", PTIE_EFORMAT, "NPY files have no data sets"},
        {"../make_images.py", "", PTIE_EFORMAT, "NPY, PNG, TIFF, HDF5"},
        {"none.png", "", PTIE_EIO, "No such file"},
        {"none_%d.png", "", PTIE_EIO, "no frames"},
        {"none_/%d.png", "", PTIE_EIO, "none_/: cannot read the folder: No such file"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char path[300];
        ptie_recording *recording = (void *)path; /* must become NULL */
        snprintf(path, sizeof path, "%s%s", golden_image(cases[i].name), cases[i].inside);
        print_message("# %s%s\n", cases[i].name, cases[i].inside);
        assert_fails(ptie_recording_open(&recording, path), cases[i].status, cases[i].fragment);
        assert_non_null(strstr(ptie_last_error(), "tests/golden/images/"));
        assert_null(recording);
    }
}

static void pixels_that_cannot_be_read_are_named(void **state) {
    (void)state;
    static const struct {
        const char *name;
        int64_t frame;
        ptie_status status;
        const char *fragment;
    } cases[] = {
        {"bad_colour.png", 0, PTIE_EUNSUPPORTED, "red 0, green 0, blue 1 at x=0, y=0"},
        {"bad_palette.png", 0, PTIE_EUNSUPPORTED, "red 1, green 0, blue 0 at x=1, y=0"},
        {"bad_alpha.png", 0, PTIE_EUNSUPPORTED, "alpha 100 at x=0, y=0"},
        {"bad_key.png", 0, PTIE_EUNSUPPORTED, "alpha 0 at x=3, y=2"},
        {"bad_nan.npy", 1, PTIE_ENUMERIC, "frame 1: value is not finite (at x=3, y=2"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ptie_recording *recording;
        float data[GOLDEN_PIXELS];
        assert_ok(ptie_recording_open(&recording, golden_image(cases[i].name)));
        assert_fails(ptie_recording_read(recording, cases[i].frame, data), cases[i].status,
                     cases[i].fragment);
        assert_non_null(strstr(ptie_last_error(), cases[i].name));
        ptie_recording_close(recording);
    }
}

/* --- sequences -----------------------------------------------------------------------------------
 */

static void copy(const char *from, const char *to) {
    size_t bytes;
    unsigned char *data = support_read(golden_image(from), &bytes);
    support_write(support_temporary(to), data, bytes);
    free(data);
}

/* A one-frame file whose pixels are all `value`. */
static void write_constant(const char *name, int32_t width, float value) {
    ptie_writer *writer;
    float frame[16];
    const ptie_recording_info info = {.width_px = width, .height_px = 2, .frames = 1};
    for (int i = 0; i < 16; i++) frame[i] = value;
    assert_ok(ptie_writer_create(&writer, support_temporary(name), "phase", &info, true));
    assert_ok(ptie_writer_append(writer, frame));
    assert_ok(ptie_writer_close(writer));
}

static void make_folder(const char *name) {
    assert_int_equal(mkdir(support_temporary(name), 0777), 0);
}

static void check_order(const char *path, const char *format, int64_t frames) {
    ptie_recording *recording;
    float data[4];
    assert_ok(ptie_recording_open(&recording, support_temporary(path)));
    assert_string_equal(ptie_recording_get_info(recording)->format, format);
    assert_int_equal(ptie_recording_get_info(recording)->frames, frames);
    for (int64_t t = 0; t < frames; t++) {
        assert_ok(ptie_recording_read(recording, t, data));
        assert_true(data[3] == (float)t);
    }
    ptie_recording_close(recording);
}

static void a_folder_is_sorted_by_number(void **state) {
    (void)state;
    make_folder("folder");
    write_constant("folder/run2_flow_10.npy", 2, 3);
    write_constant("folder/run2_flow_9.npy", 2, 2);
    write_constant("folder/run2_flow_1.npy", 2, 0);
    write_constant("folder/run2_flow_002.npy", 2, 1);
    support_write(support_temporary("folder/notes.txt"), "x", 1);
    check_order("folder", "NPY sequence", 4);
    check_order("folder/", "NPY sequence", 4);
}

static void a_pattern_takes_only_what_fits(void **state) {
    (void)state;
    make_folder("pattern");
    write_constant("pattern/a_07.npy", 2, 0);
    write_constant("pattern/a_08.npy", 2, 1);
    write_constant("pattern/a_100.npy", 2, 2);
    write_constant("pattern/a_9.npy", 2, -1);    /* too few digits */
    write_constant("pattern/a_0101.npy", 2, -1); /* too many */
    write_constant("pattern/b_09.npy", 2, -1);
    write_constant("pattern/a_x9.npy", 2, -1);
    check_order("pattern/a_%02d.npy", "NPY sequence", 3);
}

static void frames_must_be_alike(void **state) {
    (void)state;
    ptie_recording *recording;
    float data[GOLDEN_PIXELS];
    make_folder("unlike");
    write_constant("unlike/a_0.npy", 2, 0);
    write_constant("unlike/a_1.npy", 3, 0);
    copy("one_frame.npy", "unlike/a_2.npy");
    copy("f4.npy", "unlike/a_3.npy");
    copy("grey8.png", "unlike/a_4.npy");
    assert_ok(ptie_recording_open(&recording, support_temporary("unlike")));
    assert_ok(ptie_recording_read(recording, 0, data));
    assert_fails(ptie_recording_read(recording, 1, data), PTIE_ESIZE,
                 "a_1.npy: unlike the first frame (expected 2 x 2 f32, found 3 x 2 f32)");
    assert_fails(ptie_recording_read(recording, 3, data), PTIE_EUNSUPPORTED,
                 "expected 1 frame, found 3");
    assert_fails(ptie_recording_read(recording, 4, data), PTIE_ESIZE, "found 7 x 5 u8");
    remove(support_temporary("unlike/a_2.npy"));
    assert_fails(ptie_recording_read(recording, 2, data), PTIE_EIO, "a_2.npy");
    ptie_recording_close(recording);
    write_constant("unlike/noflow.npy", 2, 0);
    assert_fails(ptie_recording_open(&recording, support_temporary("unlike")), PTIE_EFORMAT,
                 "such as a_0.npy and noflow.npy (give a pattern like flow_%02d.png)");
}

static void a_folder_without_images_is_refused(void **state) {
    (void)state;
    ptie_recording *recording;
    make_folder("empty");
    assert_fails(ptie_recording_open(&recording, support_temporary("empty")), PTIE_EIO,
                 "no frames");
}

static void real_recordings_are_read(void **state) {
    (void)state;
    ptie_recording *recording;
    const char *path = support_data("plume/flow_00.png");
    char pattern[1024];
    if (!path) skip();
    snprintf(pattern, sizeof pattern, "%.*s_%%02d.png", (int)strlen(path) - 7, path);
    assert_ok(ptie_recording_open(&recording, pattern));
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    assert_int_equal(info->frames, 6);
    assert_int_equal(info->width_px, 1152);
    assert_int_equal(info->height_px, 928);
    float *data = malloc(1152 * 928 * sizeof *data);
    assert_ok(ptie_recording_read(recording, 5, data));
    free(data);
    ptie_recording_close(recording);
    assert_ok(ptie_recording_open(&recording, support_data("containers/stuck.tif")));
    assert_int_equal(ptie_recording_get_info(recording)->frames, 5);
    ptie_recording_close(recording);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(npy_of_every_type),
        cmocka_unit_test(png_of_every_depth),
        cmocka_unit_test(tiff_of_every_kind),
        cmocka_unit_test(imagej_scale_is_read),
        cmocka_unit_test(hdf5_named_or_found),
        cmocka_unit_test(nexus_units_are_read),
        cmocka_unit_test(what_cannot_be_read_is_named),
        cmocka_unit_test(pixels_that_cannot_be_read_are_named),
        cmocka_unit_test(a_folder_is_sorted_by_number),
        cmocka_unit_test(a_pattern_takes_only_what_fits),
        cmocka_unit_test(frames_must_be_alike),
        cmocka_unit_test(a_folder_without_images_is_refused),
        cmocka_unit_test(real_recordings_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
