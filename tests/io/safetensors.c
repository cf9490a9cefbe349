/* SPDX-License-Identifier: BSD-3-Clause */
/* safetensors: round trip, the exact bytes, what NumPy makes of them, and every way to be damaged.
 */
#include "support/files.h"

#include <stdlib.h>

#include "io/safetensors.h"

static const float kernel[2][3] = {{1, -2.5f, 3e-38f}, {0.1f, 1e30f, -0.0f}};
static const float step[1] = {7};

static const ptie_tensor_view tensors[] = {
    {.name = "enc1.conv1.weight", .rank = 2, .shape = {2, 3}, .data = kernel[0]},
    {.name = "none", .rank = 1, .shape = {0}, .data = NULL},
    {.name = "step", .rank = 0, .data = step},
};
static const ptie_note notes[] = {{"format", "ptie"}, {"title", "naïve \"µm\"\n"}};

static ptie_status write_example(const char *path) {
    return ptie_safetensors_write(path, tensors, 3, notes, 2, true);
}

static const char *example(const char *name) {
    const char *path = support_temporary(name);
    assert_ok(write_example(path));
    return path;
}

static void what_is_written_is_read(void **state) {
    (void)state;
    ptie_safetensors *file;
    const ptie_note *found;
    assert_ok(ptie_safetensors_read(&file, example("round.safetensors")));
    assert_int_equal(ptie_safetensors_count(file), 3);
    const ptie_tensor_view *weight = ptie_safetensors_find(file, "enc1.conv1.weight");
    assert_non_null(weight);
    assert_int_equal(weight->rank, 2);
    assert_int_equal(weight->shape[0], 2);
    assert_int_equal(weight->shape[1], 3);
    assert_memory_equal(weight->data, kernel, sizeof kernel);
    assert_true(ptie_safetensors_find(file, "step")->data[0] == 7.0f);
    assert_int_equal(ptie_safetensors_find(file, "none")->shape[0], 0);
    assert_null(ptie_safetensors_find(file, "other"));
    assert_null(ptie_safetensors_tensor(file, 3));
    assert_int_equal(ptie_safetensors_notes(file, &found), 2);
    assert_string_equal(found[0].key, "format");
    assert_string_equal(ptie_safetensors_note(file, "title"), "naïve \"µm\"\n");
    assert_null(ptie_safetensors_note(file, "other"));
    ptie_safetensors_free(file);
    ptie_safetensors_free(NULL);
}

static void bytes_are_those_of_the_format(void **state) {
    (void)state;
    const char *path = support_temporary("bytes.safetensors");
    const char header[] =
        "{\"scale\":{\"dtype\":\"F32\",\"shape\":[],\"data_offsets\":[0,4]}}       ";
    const ptie_tensor_view scale = {.name = "scale", .data = step};
    size_t bytes;
    assert_ok(ptie_safetensors_write(path, &scale, 1, NULL, 0, false));
    unsigned char *data = support_read(path, &bytes);
    assert_int_equal(sizeof header - 1, 64);
    assert_int_equal(bytes, 8 + sizeof header - 1 + 4);
    assert_memory_equal(data, "\x40\0\0\0\0\0\0\0", 8);
    assert_memory_equal(data + 8, header, sizeof header - 1);
    assert_memory_equal(data + bytes - 4, "\0\0\xe0\x40", 4);
    free(data);
    assert_fails(ptie_safetensors_write(path, tensors, 3, NULL, 0, false), PTIE_EEXIST, "bytes");
}

static void numpy_reads_it(void **state) {
    (void)state;
    support_python(
        "import json, sys, numpy as np\n"
        "b = open(sys.argv[1], 'rb').read()\n"
        "n = int.from_bytes(b[:8], 'little')\n"
        "h = json.loads(b[8:8+n])\n"
        "assert n % 8 == 0 and h.pop('__metadata__') == {'format': 'ptie', 'title': 'naïve "
        "\"µm\"\\n'}\n"
        "e = h['enc1.conv1.weight']\n"
        "w = np.frombuffer(b[8+n:], '<f4')[e['data_offsets'][0]//4:e['data_offsets'][1]//4]\n"
        "want = np.float32([[1, -2.5, 3e-38], [.1, 1e30, -0.]])\n"
        "assert e['dtype'] == 'F32' and (w.reshape(e['shape']) == want).all()\n",
        example("numpy.safetensors"));
}

static ptie_status read_and_free(const char *path) {
    ptie_safetensors *file;
    ptie_status status = ptie_safetensors_read(&file, path);
    ptie_safetensors_free(file);
    return status;
}

static void every_truncation_is_refused(void **state) {
    (void)state;
    support_check_truncations(example("whole.safetensors"), read_and_free, 0);
}

static void a_full_disk_is_reported(void **state) {
    (void)state;
    support_check_full_disk(support_temporary("full.safetensors"), write_example);
}

/* Header, number of data bytes, and what is said about it. */
typedef struct damage {
    const char *header;
    size_t data_bytes;
    ptie_status status;
    const char *fragment;
} damage;

#define T(name, dtype, shape, offsets)                                                             \
    "\"" name "\":{\"dtype\":\"" dtype "\",\"shape\":" shape ",\"data_offsets\":" offsets "}"

static void damage_is_named(void **state) {
    (void)state;
    static const damage cases[] = {
        {"{" T("a", "F32", "[1]", "[0,4]") "," T("b", "F32", "[2]", "[4,12]") "}", 12, PTIE_OK, ""},
        {"{" T("b", "F32", "[2]", "[4,12]") "," T("a", "F32", "[1]", "[0,4]") "}", 12, PTIE_OK, ""},
        {"{}", 0, PTIE_OK, ""},
        {"", 0, PTIE_EFORMAT, "bad header"},
        {"[]", 0, PTIE_EFORMAT, "not a JSON object"},
        {"{\"a\":", 0, PTIE_EFORMAT, "bad header"},
        {"{" T("a", "F32", "[1]", "[0,4]") "," T("a", "F32", "[1]", "[4,8]") "}", 8, PTIE_EFORMAT,
         "duplicate"},
        {"{" T("a", "F32", "[1]", "[0,4]") "," T("b", "F32", "[1]", "[2,6]") "}", 6, PTIE_EFORMAT,
         "overlaps"},
        {"{" T("a", "F32", "[1]", "[0,4]") "," T("b", "F32", "[1]", "[0,4]") "}", 4, PTIE_EFORMAT,
         "overlaps"},
        {"{" T("a", "F32", "[1]", "[0,4]") "," T("b", "F32", "[1]", "[8,12]") "}", 12, PTIE_EFORMAT,
         "hole"},
        {"{" T("a", "F32", "[1]", "[4,8]") "}", 8, PTIE_EFORMAT, "hole"},
        {"{" T("a", "F32", "[1]", "[0,4]") "}", 8, PTIE_EFORMAT, "no tensor"},
        {"{" T("a", "F32", "[1]", "[0,4]") "}", 3, PTIE_EFORMAT, "outside"},
        {"{" T("a", "F32", "[1]", "[4,0]") "}", 4, PTIE_EFORMAT, "outside"},
        {"{" T("a", "F32", "[1]", "[-4,0]") "}", 4, PTIE_EFORMAT, "data_offsets"},
        {"{" T("a", "F32", "[1]", "[0]") "}", 4, PTIE_EFORMAT, "data_offsets"},
        {"{" T("a", "F32", "[2]", "[0,4]") "}", 4, PTIE_EFORMAT, "larger than the file"},
        {"{" T("a", "F32", "[1]", "[0,8]") "}", 8, PTIE_EFORMAT, "expected 4 bytes, found 8"},
        {"{" T("a", "F32", "[4294967296,4294967296,1]", "[0,0]") "}", 0, PTIE_EFORMAT,
         "larger than the file"},
        {"{" T("a", "F32", "[9223372036854775807,2,2]", "[0,4]") "}", 4, PTIE_EFORMAT,
         "larger than"},
        {"{" T("a", "F32", "[-1]", "[0,4]") "}", 4, PTIE_EFORMAT, "bad shape"},
        {"{" T("a", "F32", "[1,1,1,1,1]", "[0,4]") "}", 4, PTIE_EFORMAT, "bad shape"},
        {"{" T("a", "F32", "[1.5]", "[0,4]") "}", 4, PTIE_EFORMAT, "bad shape"},
        {"{" T("a", "F32", "7", "[0,4]") "}", 4, PTIE_EFORMAT, "bad shape"},
        {"{" T("a", "BF16", "[2]", "[0,4]") "}", 4, PTIE_EUNSUPPORTED, "expected F32, found BF16"},
        {"{\"a\":{\"shape\":[1],\"data_offsets\":[0,4]}}", 4, PTIE_EFORMAT, "no dtype"},
        {"{\"a\":5}", 0, PTIE_EFORMAT, "no dtype"},
        {"{\"__metadata__\":5}", 0, PTIE_EFORMAT, "not an object"},
        {"{\"__metadata__\":{\"a\":1}}", 0, PTIE_EFORMAT, "not a string"},
    };
    const char *path = support_temporary("damaged.safetensors");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        unsigned char file[400] = {0};
        size_t length = strlen(cases[i].header);
        file[0] = (unsigned char)length;
        memcpy(file + 8, cases[i].header, length);
        support_write(path, file, 8 + length + cases[i].data_bytes);
        print_message("# %s\n", cases[i].header);
        if (cases[i].status == PTIE_OK)
            assert_ok(read_and_free(path));
        else
            assert_fails(read_and_free(path), cases[i].status, cases[i].fragment);
    }
}

static void header_length_is_checked(void **state) {
    (void)state;
    const char *path = support_temporary("length.safetensors");
    support_write(path, "\x03\0\0\0\0\0\0\0{}", 10);
    assert_fails(read_and_free(path), PTIE_EFORMAT, "expected a header within 10 bytes, found 3");
    support_write(path, "\xff\xff\xff\xff\xff\xff\xff\xff{}", 10);
    assert_fails(read_and_free(path), PTIE_EFORMAT, "not a safetensors file");
    assert_fails(read_and_free(support_temporary("none.safetensors")), PTIE_EIO, "No such file");
    assert_fails(read_and_free(support_temporary(".")), PTIE_EIO, "directory");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_is_read),  cmocka_unit_test(bytes_are_those_of_the_format),
        cmocka_unit_test(numpy_reads_it),           cmocka_unit_test(every_truncation_is_refused),
        cmocka_unit_test(a_full_disk_is_reported),  cmocka_unit_test(damage_is_named),
        cmocka_unit_test(header_length_is_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
