/* SPDX-License-Identifier: BSD-3-Clause */
/* Stacks of other programs (tests/golden/make_containers.py): MATLAB, OME, ImageJ, raw frames; real
 * ones against SciPy, h5py and tifffile. */
#include "support/files.h"

#include <stdlib.h>

#include "golden.h"
#include "io/recording.h"

static const char *golden_container(const char *name) {
    char path[200];
    snprintf(path, sizeof path, "tests/golden/containers/%s", name);
    return support_source(path);
}

static ptie_recording *open_container(const char *name) {
    ptie_recording *recording;
    print_message("# %s\n", name);
    assert_ok(ptie_recording_open(&recording, golden_container(name)));
    return recording;
}

static void check_frame(ptie_recording *recording, int64_t t) {
    float data[GOLDEN_PIXELS];
    const char *sample = ptie_recording_get_info(recording)->sample;
    assert_ok(ptie_recording_read(recording, t, data));
    for (int32_t i = 0; i < GOLDEN_PIXELS; i++)
        assert_true((double)data[i] == golden_value(sample, t, i));
}

/* Forwards and backwards. */
static void every_kind_is_read(void **state) {
    (void)state;
    static const char *const files[][3] = {
        {"plain.mat", "MAT", "f64"},         {"deflated.mat", "MAT", "f64"},
        {"big_endian.mat", "MAT", "u16"},    {"several.mat:/u8", "MAT", "u8"},
        {"several.mat:/i16", "MAT", "i16"},  {"several.mat:/f32", "MAT", "f32"},
        {"several.mat:/u16", "MAT", "u16"},  {"several.mat:/i32", "MAT", "i32"},
        {"v73.mat", "MAT 7.3", "f32"},       {"stack.ome.tif", "TIFF", "u16"},
        {"no_units.ome.tif", "TIFF", "f32"}, {"one_directory.tif", "TIFF", "f32"},
        {"gaps.raw", "raw", "u16"},          {"plain.f32", "raw", "f32"},
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        ptie_recording *recording = open_container(files[i][0]);
        const ptie_recording_info *info = ptie_recording_get_info(recording);
        assert_string_equal(info->format, files[i][1]);
        assert_string_equal(info->sample, files[i][2]);
        assert_int_equal(info->width_px, GOLDEN_WIDTH);
        assert_int_equal(info->height_px, GOLDEN_HEIGHT);
        assert_int_equal(info->frames, 3);
        assert_string_equal(info->warning, "");
        for (int64_t t = 0; t < 3; t++) check_frame(recording, t);
        for (int64_t t = 2; t >= 0; t--) check_frame(recording, t);
        ptie_recording_close(recording);
    }
}

static void units_are_taken(void **state) {
    (void)state;
    static const struct {
        const char *name;
        double pixel_m, rate_hz;
    } files[] = {{"stack.ome.tif", 20.5e-9, 25000},
                 {"no_units.ome.tif", 0.5e-6, 4},
                 {"one_directory.tif", 20e-6, 25000},
                 {"gaps.raw", 20e-6, 25000},
                 {"plain.f32", 0, 0}};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        ptie_recording *recording = open_container(files[i].name);
        const ptie_recording_info *info = ptie_recording_get_info(recording);
        /* 1 / 4e-5 and 1e-6 / 0.05f round: half of 2^-52 and 2^-24 of the value */
        assert_near(info->pixel_m, files[i].pixel_m, files[i].pixel_m * 1e-7);
        assert_near(info->frame_rate_hz, files[i].rate_hz, files[i].rate_hz * 1e-15);
        ptie_recording_close(recording);
    }
    ptie_recording *recording = open_container("gaps.raw");
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    assert_true(info->exposure_s == 2e-6 && info->bit_depth == 12 && info->bottom_up);
    assert_string_equal(info->unit, "counts");
    assert_string_equal(info->camera, "mine");
    assert_string_equal(info->comment, "by hand");
    ptie_recording_close(recording);
    recording = open_container("stack.ome.tif");
    assert_string_equal(ptie_recording_get_info(recording)->comment, "a & b");
    ptie_recording_close(recording);
}

static void what_cannot_be_read_is_named(void **state) {
    (void)state;
    static const struct {
        const char *name;
        ptie_status status;
        const char *fragment;
    } files[] = {{"several.mat", PTIE_EFORMAT, "found /u8, /i16, /f32, /u16, /i32"},
                 {"several.mat:/z", PTIE_EUNSUPPORTED, "/z is no array of real numbers"},
                 {"several.mat:/q", PTIE_EFORMAT, "no variable 'q'"},
                 {"plain.mat:/name", PTIE_EUNSUPPORTED, "/name is no array"},
                 {"gaps.raw:/a", PTIE_EFORMAT, "raw files have no data sets"}};
    ptie_recording *recording;
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        assert_fails(ptie_recording_open(&recording, golden_container(files[i].name)),
                     files[i].status, files[i].fragment);
    support_write(support_temporary("alone.raw"), "x", 1);
    assert_fails(ptie_recording_open(&recording, support_temporary("alone.raw")), PTIE_EIO,
                 "alone.json");
}

/* --- damage ----------------------------------------------------------------------------------- */

static ptie_status read_all(const char *path) {
    ptie_recording *recording;
    float data[GOLDEN_PIXELS];
    PTIE_TRY(ptie_recording_open(&recording, path));
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    ptie_status status = PTIE_OK;
    if (info->width_px * (int64_t)info->height_px <= GOLDEN_PIXELS)
        for (int64_t t = 0; t < info->frames && t < 8 && status == PTIE_OK; t++)
            status = ptie_recording_read(recording, t, data);
    ptie_recording_close(recording);
    return status;
}

/* A variable says its size first, so that every missing byte shows. */
static void mat_is_cut(void **state) {
    (void)state;
    support_check_truncations(golden_container("plain.mat"), read_all, 0);
    support_check_truncations(golden_container("deflated.mat"), read_all, 0);
    support_check_truncations(golden_container("big_endian.mat"), read_all, 0);
}

static void damage_is_survived(void **state) {
    (void)state;
    support_check_changes(golden_container("plain.mat"), read_all);
    support_check_changes(golden_container("deflated.mat"), read_all);
    support_check_changes(golden_container("big_endian.mat"), read_all);
    support_check_changes(golden_container("one_directory.tif"), read_all);
    support_check_changes(golden_container("stack.ome.tif"), read_all);
}

/* A stack behind one directory may be short of images; the first must be there. */
static void a_cut_stack_says_so(void **state) {
    (void)state;
    size_t bytes;
    unsigned char *data = support_read(golden_container("one_directory.tif"), &bytes);
    ptie_recording *recording;
    const char *path = support_temporary("cut.tif");
    support_write(path, data, bytes - 1);
    assert_ok(ptie_recording_open(&recording, path));
    assert_string_equal(ptie_recording_get_info(recording)->warning,
                        "file is cut short: 2 of 3 frames are there");
    check_frame(recording, 1);
    ptie_recording_close(recording);
    support_write(path, data, bytes - 2 * 140 - 1);
    assert_int_not_equal(ptie_recording_open(&recording, path), PTIE_OK);
    free(data);
}

static void sidecars_that_lie(void **state) {
    (void)state;
    static const struct {
        const char *text;
        ptie_status status;
        const char *fragment;
    } lies[] = {
        {"{\"width\": 7, \"height\": 5, \"sample\": \"u8\"}", PTIE_OK, ""},
        {"{\"width\": 7, \"height\": 5, \"sample\": \"u12\"}", PTIE_OK, ""},
        {"{\"width\": 7, \"height\": 5}", PTIE_EFORMAT, "\"sample\" (expected u8 i8"},
        {"{\"width\": 7, \"height\": 5, \"sample\": \"u12be\"}", PTIE_EFORMAT, "\"sample\""},
        {"{\"width\": 7, \"height\": 5, \"sample\": \"f16\"}", PTIE_EFORMAT, "\"sample\""},
        {"{\"width\": 7, \"height\": 5, \"sample\": \"u8x\"}", PTIE_EFORMAT, "\"sample\""},
        {"{\"height\": 5, \"sample\": \"u8\"}", PTIE_EFORMAT, "found 0 x 5"},
        {"{\"width\": 32769, \"height\": 5, \"sample\": \"u8\"}", PTIE_EFORMAT, "1 .. 32768"},
        {"{\"width\": 7.5, \"height\": 5, \"sample\": \"u8\"}", PTIE_EFORMAT, "a whole number"},
        {"{\"width\": 32768, \"height\": 32768, \"sample\": \"f64\"}", PTIE_EFORMAT,
         "too short for a frame"},
        {"{\"width\": 7, \"height\": 5, \"sample\": \"u8\", \"row\": 6}", PTIE_EFORMAT, "of 7 .. "},
        {"{\"width\": 7, \"height\": 5, \"sample\": \"u8\", \"stride\": 34}", PTIE_EFORMAT,
         "of 35 .. "},
        {"{\"width\": 7, \"height\": 5, \"sample\": \"u8\", \"offset\": 66}", PTIE_EFORMAT,
         "35 bytes behind 66, found 100"},
        {"{\"width\": 7, \"height\": 5, \"sample\": \"u8\", \"offset\": 9223372036854775807}",
         PTIE_EFORMAT, "\"offset\""},
        {"{\"width\": 7, \"height\": 5, \"sample\": \"u8\", \"frame_rate\": 25}", PTIE_EFORMAT,
         "text with a number and its unit"},
        {"{\"width\": 7, \"height\": 5, \"sample\": \"u8\", \"frame_rate\": \"25 um\"}",
         PTIE_EFORMAT, "25 kHz"},
        {"{\"width\": 7, \"height\": 5, \"sample\": \"u8\", \"pixl\": \"25 um\"}", PTIE_EFORMAT,
         "did you mean \"pixel\""},
        {"{\"width\": 7, \"width\": 7}", PTIE_EFORMAT, "duplicate"},
        {"[1]", PTIE_EFORMAT, "not a JSON object"},
        {"{", PTIE_EFORMAT, "not JSON (line 1)"},
        {"", PTIE_EFORMAT, "not JSON"},
    };
    static const unsigned char frames[100];
    support_write(support_temporary("lie.raw"), frames, sizeof frames);
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        ptie_recording *recording = NULL;
        print_message("# %s\n", lies[i].text);
        support_write(support_temporary("lie.json"), lies[i].text, strlen(lies[i].text));
        const char *path = support_temporary("lie.raw");
        if (lies[i].status == PTIE_OK)
            assert_ok(ptie_recording_open(&recording, path));
        else
            assert_fails(ptie_recording_open(&recording, path), lies[i].status, lies[i].fragment);
        ptie_recording_close(recording);
    }
}

/* --- real files ------------------------------------------------------------------------------- */

/* Reads NAME, writes it as NPY, and lets Python compare it with what `program` loads into `a`. */
static void compare(const char *name, const char *inside, const char *program) {
    char path[4096], text[4096];
    ptie_recording *recording;
    ptie_writer *writer;
    const char *out = support_temporary("ours.npy"), *file = support_data(name);
    snprintf(path, sizeof path, "%s%s", file, inside);
    print_message("# %s%s\n", name, inside);
    assert_ok(ptie_recording_open(&recording, path));
    ptie_recording_info info = *ptie_recording_get_info(recording);
    float *data = malloc(sizeof *data * (size_t)info.width_px * (size_t)info.height_px);
    info.sample[0] = 0;
    assert_ok(ptie_writer_create(&writer, out, "map", &info, true));
    for (int64_t t = 0; t < info.frames; t++) {
        assert_ok(ptie_recording_read(recording, t, data));
        assert_ok(ptie_writer_append(writer, data));
    }
    assert_ok(ptie_writer_close(writer));
    ptie_recording_close(recording);
    free(data);
    snprintf(
        text, sizeof text,
        "import sys, numpy as np, scipy.io, h5py, tifffile\nf, v = '%s', '%s'\n%s\n"
        "b = np.load(sys.argv[1])\na = a.reshape(b.shape)\nassert (a.astype('f4') == b).all()\n",
        file, *inside ? inside + 2 : "", program);
    support_python(text, out);
}

static void real_files_as_others_read_them(void **state) {
    (void)state;
    static const char *const names[] = {"d", "s", "i32", "i16", "i8"};
    static const char mat[] = "a = scipy.io.loadmat(f)[v]", hdf5[] = "a = h5py.File(f)[v][()].T";
    char inside[20];
    if (!support_data("containers/stuck.tif")) skip();
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        snprintf(inside, sizeof inside, ":/%s", names[i]);
        compare("containers/test.mat", inside, mat);
        compare("containers/test_le.mat", inside, mat);
        compare("containers/test_le_v6.mat", inside, mat);
        compare("containers/test_le_hdf5.mat", inside, hdf5);
        compare("containers/test_file_hdf5.mat", inside, hdf5);
    }
    compare("containers/stuck.tif", "", "a = tifffile.imread(f)\nassert a.shape == (5, 512, 512)");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_is_read),
        cmocka_unit_test(units_are_taken),
        cmocka_unit_test(what_cannot_be_read_is_named),
        cmocka_unit_test(mat_is_cut),
        cmocka_unit_test(damage_is_survived),
        cmocka_unit_test(a_cut_stack_says_so),
        cmocka_unit_test(sidecars_that_lie),
        cmocka_unit_test(real_files_as_others_read_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
