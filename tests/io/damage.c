/* SPDX-License-Identifier: BSD-3-Clause */
/* Damaged recordings: cut at every byte, with every byte changed, with headers that lie.  A clean
 * error or, where nothing that matters is hit, success; never a crash, never memory for what cannot
 * be there. */
#include "support/files.h"

#include <stdlib.h>

#include "golden.h"
#include "io/recording.h"

#define LARGEST_FRAME (1 << 20) /* pixels; files here are smaller than 16 kB */

static ptie_status read_frames(ptie_recording *recording) {
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    const size_t pixels = (size_t)info->width_px * (size_t)info->height_px;
    assert_true(info->width_px >= 1 && info->width_px <= 32768);
    assert_true(info->height_px >= 1 && info->height_px <= 32768);
    assert_true(info->frames >= 1);
    if (pixels > LARGEST_FRAME)
        return PTIE_OK; /* an HDF5 file may hold less than its data sets say */
    float *data = malloc(pixels * sizeof *data);
    ptie_status status = PTIE_OK;
    for (int64_t t = 0; t < info->frames && t < 8 && status == PTIE_OK; t++)
        status = ptie_recording_read(recording, t, data);
    free(data);
    return status;
}

static ptie_status read_all(const char *path) {
    ptie_recording *recording;
    PTIE_TRY(ptie_recording_open(&recording, path));
    ptie_status status = read_frames(recording);
    ptie_recording_close(recording);
    return status;
}

static void npy_is_cut(void **state) {
    (void)state;
    support_check_truncations(golden_image("f4.npy"), read_all, 0);
    support_check_truncations(golden_image("u2_big.npy"), read_all, 0);
    support_check_truncations(golden_image("version2.npy"), read_all, 0);
    support_check_truncations(golden_image("version3.npy"), read_all, 0);
}

static void png_is_cut(void **state) {
    (void)state;
    static const char *const names[] = {"grey1.png",   "grey16.png", "interlaced.png",
                                        "palette.png", "opaque.png", "rgb_grey.png",
                                        "pil16.png"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        support_check_truncations(golden_image(names[i]), read_all, 0);
}

/* Reads and compares: what lies behind the last value may be lost, and nothing else. */
static ptie_status read_exactly(const char *path) {
    ptie_recording *recording;
    float data[GOLDEN_PIXELS];
    PTIE_TRY(ptie_recording_open(&recording, path));
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    ptie_status status = PTIE_OK;
    for (int64_t t = 0; t < info->frames && status == PTIE_OK; t++) {
        status = ptie_recording_read(recording, t, data);
        for (int32_t i = 0; i < GOLDEN_PIXELS && status == PTIE_OK; i++)
            assert_true((double)data[i] == golden_value(info->sample, t, i));
    }
    assert_true(status != PTIE_OK || info->frames == 3);
    ptie_recording_close(recording);
    return status;
}

static void tiff_is_cut(void **state) {
    (void)state;
    static const char *const names[] = {"u1.tif",     "f8.tif",    "big_endian.tif", "bigtiff.tif",
                                        "strips.tif", "tiles.tif", "deflate.tif",    "imagej.tif"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        /* tifffile writes tables twice; its directories lead to the first. */
        support_check_truncations(golden_image(names[i]), read_exactly, 32);
    ;
}

static void hdf5_is_cut(void **state) {
    (void)state;
    support_check_truncations(golden_image("block.h5"), read_all, 0);
    support_check_truncations(golden_image("nexus.h5"), read_all, 0);
}

/* Every byte in turn becomes 0, 255, itself with one bit changed, and itself again. */
static void change_every_byte(const char *name) {
    size_t bytes;
    unsigned char *data = support_read(golden_image(name), &bytes);
    const char *path = support_temporary("changed");
    print_message("# %s\n", name);
    support_write(path, data, bytes);
    FILE *file = fopen(path, "r+b");
    assert_non_null(file);
    for (size_t i = 0; i < bytes; i++) {
        const unsigned char changes[] = {0, 255, (unsigned char)(data[i] ^ 1), data[i]};
        for (size_t c = 0; c < sizeof changes; c++) {
            fseek(file, (long)i, SEEK_SET);
            fputc(changes[c], file);
            fflush(file);
            ptie_status status = read_all(path);
            if (status != PTIE_OK) assert_non_null(strstr(ptie_last_error(), path));
        }
    }
    fclose(file);
    free(data);
}

static void npy_is_changed(void **state) {
    (void)state;
    change_every_byte("f4.npy");
    change_every_byte("version2.npy");
}

static void png_is_changed(void **state) {
    (void)state;
    change_every_byte("grey4.png");
    change_every_byte("interlaced16.png");
    change_every_byte("palette.png");
}

static void tiff_is_changed(void **state) {
    (void)state;
    change_every_byte("u1.tif");
    change_every_byte("bigtiff_big_endian.tif");
    change_every_byte("strips.tif");
    change_every_byte("lzw.tif");
    change_every_byte("imagej.tif");
}

typedef struct lie {
    const char *header;
    ptie_status status;
    const char *fragment;
} lie;

static void npy_headers_that_lie(void **state) {
    (void)state;
    static const lie lies[] = {
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2, 3), }", PTIE_OK, ""},
        {"{\"shape\":(1,2,3),\"fortran_order\":False,\"descr\":\"<f4\"}", PTIE_OK, ""},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (0, 3), }", PTIE_EFORMAT,
         "found 3 x 0"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (-2, 3), }", PTIE_EFORMAT, "'shape'"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, }", PTIE_EFORMAT, "'shape'"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (2 3.5), }", PTIE_EFORMAT, "'shape'"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2, 2, 2, 2), }", PTIE_EFORMAT,
         "'shape'"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (), }", PTIE_EUNSUPPORTED,
         "0 dimensions"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (32769, 3), }", PTIE_EUNSUPPORTED,
         "too large"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (32768, 32768), }", PTIE_EFORMAT,
         "cut short"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (9223372036854775807, 2, 3), }",
         PTIE_EFORMAT, "cut short"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (18446744073709551615, 2, 3), }",
         PTIE_EFORMAT, "number of frames"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999999999999, 2, 3), }",
         PTIE_EFORMAT, "'shape'"},
        {"{'descr': '<f3', 'fortran_order': False, 'shape': (2, 3), }", PTIE_EUNSUPPORTED,
         "sample type"},
        {"{'descr': '<f', 'fortran_order': False, 'shape': (2, 3), }", PTIE_EUNSUPPORTED,
         "sample type"},
        {"{'descr': '", PTIE_EUNSUPPORTED, "sample type"},
        {"{'fortran_order': False, 'shape': (2, 3), }", PTIE_EFORMAT, "'descr'"},
        {"{'descr': '<f4', 'shape': (2, 3), }", PTIE_EFORMAT, "'fortran_order'"},
        {"{'descr': '<f4', 'fortran_order': False, }", PTIE_EFORMAT, "'shape'"},
        {"", PTIE_EFORMAT, "'descr'"},
    };
    const char *path = support_temporary("lie.npy");
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        unsigned char file[200] = "\x93NUMPY\x01";
        const size_t length = strlen(lies[i].header);
        file[8] = (unsigned char)length;
        memcpy(file + 10, lies[i].header, length);
        support_write(path, file, 10 + length + 24); /* six floats */
        print_message("# %s\n", lies[i].header);
        if (lies[i].status == PTIE_OK)
            assert_ok(read_all(path));
        else
            assert_fails(read_all(path), lies[i].status, lies[i].fragment);
    }
    support_write(path, "\x93NUMPY\x04\0\0\0\0\0\0", 12);
    assert_fails(read_all(path), PTIE_EUNSUPPORTED,
                 "NPY version not read (expected 1 to 3, found 4)");
    support_write(path, "\x93NUMPY\x02\0\xff\xff\xff\xff{'descr'", 20);
    assert_fails(read_all(path), PTIE_EFORMAT, "header too long");
}

/* A valid header chunk of another size before the same pixels. */
static void png_headers_that_lie(void **state) {
    (void)state;
    static const struct {
        uint32_t width, height;
        ptie_status status;
        const char *fragment;
    } lies[] = {
        {7, 5, PTIE_OK, ""},
        {0, 5, PTIE_EFORMAT, "Invalid IHDR"},
        {7, 0, PTIE_EFORMAT, "Invalid IHDR"},
        {7, 6, PTIE_EFORMAT, "lie.png"},
        {32769, 5, PTIE_EFORMAT, "Invalid IHDR"},
        {0xffffffff, 5, PTIE_EFORMAT, "lie.png"},
        {32768, 32768, PTIE_EFORMAT, "too short for its frames"},
    };
    size_t bytes;
    unsigned char *data = support_read(golden_image("grey8.png"), &bytes);
    const char *path = support_temporary("lie.png");
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        support_put_be32(data + 16, lies[i].width);
        support_put_be32(data + 20, lies[i].height);
        support_put_be32(data + 29, support_crc32(data + 12, 17));
        support_write(path, data, bytes);
        if (lies[i].status == PTIE_OK)
            assert_ok(read_all(path));
        else
            assert_fails(read_all(path), lies[i].status, lies[i].fragment);
    }
    free(data);
}

/* Sets the value of a tag in the first directory of a small classic little-endian TIFF. */
static void set_tag(unsigned char *data, unsigned tag, uint32_t value) {
    unsigned char *directory = data + (data[4] | data[5] << 8);
    for (unsigned i = 0; i < (unsigned)directory[0]; i++) {
        unsigned char *entry = directory + 2 + 12 * i;
        if ((unsigned)(entry[0] | entry[1] << 8) != tag) continue;
        for (int b = 0; b < 4; b++) entry[8 + b] = (unsigned char)(value >> 8 * b);
        return;
    }
    fail_msg("no tag %u", tag);
}

static void tiff_headers_that_lie(void **state) {
    (void)state;
    static const struct {
        unsigned tag;
        uint32_t value;
        ptie_status status;
        const char *fragment;
    } lies[] = {
        {256, 0, PTIE_EFORMAT, "lie.tif"},
        {257, 0, PTIE_EFORMAT, "lie.tif"},
        {256, 40000, PTIE_EUNSUPPORTED, "too large"},
        {257, 0xffffffff, PTIE_EFORMAT, "lie.tif"},
        {257, 32768, PTIE_EFORMAT, "expected 229376 bytes, found 646"},
        {258, 12, PTIE_EUNSUPPORTED, "expected integers of 8, 16, 32 or 64 bits, found 12"},
        {259, 7, PTIE_EFORMAT, "lie.tif"},
        {273, 0xffffff00, PTIE_EFORMAT, "lie.tif"},
        {277, 3, PTIE_EUNSUPPORTED, "colour image"},
    };
    size_t bytes;
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        const char *path = support_temporary("lie.tif");
        unsigned char *data = support_read(golden_image("u1.tif"), &bytes);
        set_tag(data, lies[i].tag, lies[i].value);
        support_write(path, data, bytes);
        print_message("# tag %u = %u\n", lies[i].tag, lies[i].value);
        assert_fails(read_all(path), lies[i].status, lies[i].fragment);
        free(data);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(npy_is_cut),           cmocka_unit_test(png_is_cut),
        cmocka_unit_test(tiff_is_cut),          cmocka_unit_test(hdf5_is_cut),
        cmocka_unit_test(npy_is_changed),       cmocka_unit_test(png_is_changed),
        cmocka_unit_test(tiff_is_changed),      cmocka_unit_test(npy_headers_that_lie),
        cmocka_unit_test(png_headers_that_lie), cmocka_unit_test(tiff_headers_that_lie),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
