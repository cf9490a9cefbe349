/* SPDX-License-Identifier: BSD-3-Clause */
/* Recordings of real cameras against what other programs decode of them (EXPECTED.json). */
#include "support/support.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>

#include "io/recording.h"
#include "sha256.h"

/* "pims/cine_781.cine[14]" -> path and frame. */
static int64_t split_key(const char *key, char path[200]) {
    const char *slash = strrchr(key, '/'), *bracket = strchr(key, '[');
    const char *name = slash ? slash + 1 : key;
    assert_non_null(bracket);
    snprintf(path, 200, "cameras/%.*s", (int)(bracket - name), name);
    return atoll(bracket + 1);
}

static void check_hash(const float *data, size_t count, const char *expected) {
    char hex[65];
    unsigned char *bytes = malloc(2 * count);
    for (size_t i = 0; i < count; i++) {
        bytes[2 * i] = (unsigned char)((unsigned)data[i] & 0xff);
        bytes[2 * i + 1] = (unsigned char)((unsigned)data[i] >> 8);
    }
    sha256_hex(hex, bytes, 2 * count);
    free(bytes);
    assert_string_equal(hex, expected);
}

static void check_some(const json_t *values, const float *data) {
    for (size_t i = 0; i < json_array_size(values); i++)
        assert_true((double)data[i] == json_number_value(json_array_get(values, i)));
}

static int by_value(const void *a, const void *b) {
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static double number(const json_t *object, const char *key) {
    const json_t *value = json_object_get(object, key);
    assert_true(json_is_number(value));
    return json_number_value(value);
}

static void check_frame(const json_t *expected, float *data, size_t count) {
    double sum = 0;
    for (size_t i = 0; i < count; i++) sum += (double)data[i];
    assert_true(sum == number(expected, "sum"));
    check_some(json_object_get(expected, "first8"), data);
    check_some(json_object_get(expected, "last4"), data + count - 4);
    check_hash(data, count, json_string_value(json_object_get(expected, "sha256_le16")));
    qsort(data, count, sizeof *data, by_value);
    assert_true((double)data[0] == number(expected, "min"));
    assert_true((double)data[count - 1] == number(expected, "max"));
    /* NumPy's median of an even number of values, cut to an integer */
    assert_true(floor((double)(data[count / 2 - 1] + data[count / 2]) / 2) ==
                number(expected, "median"));
}

static void check_key(const char *key, const json_t *expected) {
    char name[200], path[4096];
    const int64_t frame = split_key(key, name);
    const char *found = support_data(name);
    ptie_recording *recording;
    print_message("# %s\n", key);
    assert_non_null(found);
    /* A 10-bit cine holds compressed counts; the expectations are the codes. */
    snprintf(path, sizeof path, "%s%s", found, strstr(name, "chart1") ? ":/codes" : "");
    assert_ok(ptie_recording_open(&recording, path));
    const ptie_recording_info *info = ptie_recording_get_info(recording);
    assert_true(info->width_px == number(expected, "w") &&
                info->height_px == number(expected, "h"));
    const size_t count = (size_t)info->width_px * (size_t)info->height_px;
    float *data = malloc(count * sizeof *data);
    assert_ok(ptie_recording_read(recording, frame, data));
    check_frame(expected, data, count);
    free(data);
    ptie_recording_close(recording);
}

static void frames_as_others_decode_them(void **state) {
    (void)state;
    const char *path = support_data("cameras/EXPECTED.json");
    if (!path) skip();
    json_t *all = json_load_file(path, 0, NULL), *expected;
    const char *key;
    assert_true(json_object_size(all) >= 8);
    json_object_foreach(all, key, expected) check_key(key, expected);
    json_decref(all);
}

static void sha256_of_the_standard(void **state) {
    (void)state;
    char hex[65];
    sha256_hex(hex, (const unsigned char *)"abc", 3);
    assert_string_equal(hex, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sha256_of_the_standard),
        cmocka_unit_test(frames_as_others_decode_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
