/* SPDX-License-Identifier: BSD-3-Clause */
/* The base layer: random numbers, threads, text, INI files, atomic output. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "base/file.h"
#include "base/ini.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/random.h"

/* Known answers of Philox4x32-10 from the Random123 distribution (kat_vectors). */
static void philox_matches_random123(void **state) {
    (void)state;
    static const uint32_t cases[][10] = {
        {0, 0, 0, 0, 0, 0, 0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8},
        {~0u, ~0u, ~0u, ~0u, ~0u, ~0u, 0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd},
        {0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344, 0xa4093822, 0x299f31d0, 0xd16cfe09, 0x94fdcceb,
         0x5001e420, 0x24126ea1},
    };
    for (size_t i = 0; i < 3; i++) {
        uint32_t out[4];
        ptie_philox(out, cases[i], cases[i] + 4);
        assert_memory_equal(out, cases[i] + 6, sizeof out);
    }
}

static void normals_have_unit_moments(void **state) {
    (void)state;
    enum { N = 1 << 18 };
    float *values = malloc(N * sizeof *values);
    ptie_random random;
    ptie_random_init(&random, 7, PTIE_STREAM_NOISE_PLUS, 3);
    ptie_random_normals(&random, values, N);
    double sum = 0, squares = 0, fourth = 0;
    for (int i = 0; i < N; i++) {
        double v = (double)values[i];
        sum += v, squares += v * v, fourth += v * v * v * v;
    }
    /* Standard errors: 1/sqrt(N), sqrt(2/N), sqrt(96/N); five of each. */
    assert_near(sum / N, 0, 5 / sqrt(N));
    assert_near(squares / N, 1, 5 * sqrt(2.0 / N));
    assert_near(fourth / N, 3, 5 * sqrt(96.0 / N));
    float part[8];
    ptie_random_init(&random, 7, PTIE_STREAM_NOISE_PLUS, 3);
    ptie_random_normals(&random, part, 4);
    ptie_random_normals(&random, part + 4, 4);
    assert_memory_equal(part, values, sizeof part);
    free(values);
}

static ptie_status square(void *context, size_t index, int32_t worker) {
    (void)worker;
    ((size_t *)context)[index] = index * index;
    return PTIE_OK;
}

static ptie_status fail_from_seven(void *context, size_t index, int32_t worker) {
    (void)context, (void)worker;
    if (index < 7) return PTIE_OK;
    return ptie_fail(PTIE_ENUMERIC, "task %zu failed", index);
}

static void pool_runs_every_index_and_reports_the_lowest_failure(void **state) {
    (void)state;
    for (int32_t threads = 1; threads <= 7; threads += 2) {
        ptie_pool *pool;
        size_t done[101] = {0};
        assert_ok(ptie_pool_create(&pool, threads));
        assert_ok(ptie_pool_run(pool, 101, square, done));
        for (size_t i = 0; i < 101; i++) assert_int_equal(done[i], i * i);
        assert_fails(ptie_pool_run(pool, 101, fail_from_seven, NULL), PTIE_ENUMERIC, "task 7 failed");
        ptie_pool_free(pool);
    }
    ptie_pool *pool;
    assert_fails(ptie_pool_create(&pool, 257), PTIE_EINVAL, "expected 0..256, found 257");
}

static void quantities_need_their_unit(void **state) {
    (void)state;
    double value;
    assert_null(ptie_parse_quantity("532 nm", PTIE_LENGTH, &value));
    assert_near(value, 532e-9, 1e-22);
    assert_null(ptie_parse_quantity("-1.5e1mm ", PTIE_LENGTH, &value));
    assert_near(value, -15e-3, 1e-17);
    assert_null(ptie_parse_quantity("0", PTIE_LENGTH, &value));
    assert_null(ptie_parse_quantity("2.5 %", PTIE_NUMBER, &value));
    assert_near(value, 0.025, 1e-17);
    assert_null(ptie_parse_quantity("1.5 h", PTIE_TIME, &value));
    assert_near(value, 5400, 1e-9);
    assert_non_null(ptie_parse_quantity("532", PTIE_LENGTH, &value));
    assert_non_null(ptie_parse_quantity("532 s", PTIE_LENGTH, &value));
    assert_non_null(ptie_parse_quantity("nan m", PTIE_LENGTH, &value));
    assert_non_null(ptie_parse_quantity("", PTIE_NUMBER, &value));
}

static void quantities_print_as_people_write_them(void **state) {
    (void)state;
    char text[48];
    assert_string_equal(ptie_print_quantity(text, 532e-9, PTIE_LENGTH), "532 nm");
    assert_string_equal(ptie_print_quantity(text, 10e-3, PTIE_LENGTH), "10 mm");
    assert_string_equal(ptie_print_quantity(text, -20e-6, PTIE_LENGTH), "-20 um");
    assert_string_equal(ptie_print_quantity(text, 0, PTIE_LENGTH), "0 nm");
    assert_string_equal(ptie_print_quantity(text, 0.6, PTIE_NUMBER), "0.6");
    assert_string_equal(ptie_print_quantity(text, 25000, PTIE_RATE), "25 kHz");
    assert_string_equal(ptie_print_rounded(text, 4.65e-6 / 20, PTIE_LENGTH), "232.5 nm");
    assert_string_equal(ptie_print_rounded(text, 0.571428571, PTIE_TIME), "571.43 ms");
    assert_string_equal(ptie_print_rounded(text, -1e-3 * (1 - 1e-15), PTIE_LENGTH), "-1 mm");
    assert_string_equal(ptie_print_rounded(text, 0, PTIE_RATE), "0 Hz");
    ptie_random random;
    ptie_random_init(&random, 1, PTIE_STREAM_FLOW, 0);
    for (int i = 0; i < 1000; i++) {
        double value = ptie_random_log_uniform(&random, 1e-12, 1e3), back;
        assert_null(ptie_parse_quantity(ptie_print_quantity(text, value, PTIE_LENGTH), PTIE_LENGTH, &back));
        assert_true(back == value);
    }
}

typedef struct settings {
    double length_m;
    ptie_range noise;
    int32_t size;
    bool on;
    int kind;
    char name[16];
} settings;

static const char *const kinds[] = {"pair", "triple", NULL};
static const ptie_ini_key keys[] = {
    {.section = "optics", .name = "wavelength", .kind = PTIE_INI_QUANTITY, .quantity = PTIE_LENGTH,
     .offset = offsetof(settings, length_m), .low = 1e-9, .high = 1, .required = true},
    {.section = "optics", .name = "noise", .kind = PTIE_INI_RANGE, .quantity = PTIE_NUMBER,
     .offset = offsetof(settings, noise), .low = 0, .high = 1},
    {.section = "frame", .name = "size", .kind = PTIE_INI_INTEGER, .offset = offsetof(settings, size),
     .low = 1, .high = 100},
    {.section = "frame", .name = "on", .kind = PTIE_INI_BOOLEAN, .offset = offsetof(settings, on)},
    {.section = "frame", .name = "kind", .kind = PTIE_INI_CHOICE, .offset = offsetof(settings, kind),
     .choices = kinds},
    {.section = "frame", .name = "name", .kind = PTIE_INI_TEXT, .offset = offsetof(settings, name),
     .text_bytes = 16},
};
enum { KEYS = sizeof keys / sizeof *keys };

static void ini_reads_and_prints_a_table(void **state) {
    (void)state;
    settings s = {0}, back = {0};
    assert_ok(ptie_ini_read(&s, keys, KEYS,
                            "; a comment\n[optics]\nwavelength = 532 nm ; green\nnoise = 1 .. 5 %\n"
                            "[frame]\nsize = 64\non = yes\nkind = triple\nname = jet\n",
                            "x.ini"));
    assert_near(s.length_m, 532e-9, 1e-22);
    assert_near(s.noise.low, 0.01, 1e-17);
    assert_near(s.noise.high, 0.05, 1e-17);
    assert_int_equal(s.size, 64);
    assert_true(s.on && s.kind == 1 && strcmp(s.name, "jet") == 0);
    ptie_text text = {0};
    ptie_ini_print(&text, &s, keys, KEYS);
    assert_false(text.failed);
    assert_ok(ptie_ini_read(&back, keys, KEYS, text.data, "printed"));
    assert_true(back.length_m == s.length_m && back.noise.low == s.noise.low && back.kind == s.kind);
    ptie_text_free(&text);
}

static void ini_says_line_key_and_nearest_name(void **state) {
    (void)state;
    settings s = {0};
    assert_fails(ptie_ini_read(&s, keys, KEYS, "[optics]\nwavelenght = 1 m\n", "x.ini"), PTIE_ENAME,
                 "x.ini:2: unknown key 'wavelenght' in [optics] (did you mean 'wavelength'?)");
    assert_fails(ptie_ini_read(&s, keys, KEYS, "[optic]\nwavelength = 1 m\n", "x.ini"), PTIE_ENAME,
                 "did you mean [optics]?");
    assert_fails(ptie_ini_read(&s, keys, KEYS, "[optics]\nwavelength = 532\n", "x.ini"), PTIE_EFORMAT,
                 "x.ini:2: wavelength: expected a length such as 532 nm or 10 mm, found '532'");
    assert_fails(ptie_ini_read(&s, keys, KEYS, "[frame]\nsize = 0\n", "x.ini"), PTIE_EFORMAT,
                 "out of range (expected 1 to 100");
    assert_fails(ptie_ini_read(&s, keys, KEYS, "[frame]\nsize = 3\n", "x.ini"), PTIE_EINVAL,
                 "missing key 'wavelength' in [optics]");
    assert_fails(ptie_ini_read(&s, keys, KEYS, "[frame]\nkind = tripel\n", "x.ini"), PTIE_ENAME,
                 "did you mean 'triple'?");
    assert_fails(ptie_ini_read(&s, keys, KEYS, "garbage\n", "x.ini"), PTIE_EFORMAT, "x.ini:1:");
}

static void ini_lines_may_be_indented_and_long(void **state) {
    (void)state;
    settings s = {0};
    char text[2000];
    snprintf(text, sizeof text,
             "\xef\xbb\xbf[optics] ; a comment\r\n\t wavelength : 532 nm\r\n    noise = 2 %%\n  # another\n"
             "  [frame]\n  name = a;b # c ; d\n  size = %1000d ; %700d\n  kind=pair", 64, 0);
    assert_ok(ptie_ini_read(&s, keys, KEYS, text, "x.ini"));
    assert_near(s.length_m, 532e-9, 1e-22);
    assert_near(s.noise.high, 0.02, 1e-17);
    assert_int_equal(s.size, 64);
    assert_string_equal(s.name, "a;b # c");
    snprintf(text, sizeof text, "[optics]\n  wavelength = 532 nm\n  nose = 2 %%\n");
    assert_fails(ptie_ini_read(&s, keys, KEYS, text, "x.ini"), PTIE_ENAME, "x.ini:3: unknown key 'nose'");
    snprintf(text, sizeof text, "; %0300d\n[optics]\nwavelength = 532 nm ; %0300d\nnoise = %0300d\n", 0, 0, 2);
    assert_fails(ptie_ini_read(&s, keys, KEYS, text, "x.ini"), PTIE_EFORMAT, "x.ini:4: noise: out of range");
    assert_fails(ptie_ini_read(&s, keys, KEYS, "[optics\n", "x.ini"), PTIE_EFORMAT, "x.ini:1: expected '[section]'");
}

static void output_appears_whole_or_not_at_all(void **state) {
    (void)state;
    const char *path = support_temporary("out.txt");
    ptie_output_file file;
    assert_ok(ptie_output_open(&file, path, false));
    assert_false(support_exists(path));
    ptie_output_discard(&file);
    assert_false(support_exists(support_temporary("out.txt.part")));
    assert_ok(ptie_write_file(path, "abc", 3, false));
    assert_fails(ptie_write_file(path, "def", 3, false), PTIE_EEXIST, "exists already");
    assert_ok(ptie_write_file(path, "def", 3, true));
    char *data;
    size_t bytes;
    assert_ok(ptie_read_file(&data, &bytes, path, 3));
    assert_string_equal(data, "def");
    ptie_free(data);
    assert_fails(ptie_read_file(&data, &bytes, path, 2), PTIE_EFORMAT, "at most 2 bytes");
    assert_fails(ptie_read_file(&data, &bytes, support_temporary("none"), 9), PTIE_EIO, "No such file");
    mkdir(support_temporary("folder"), 0777);
    assert_fails(ptie_read_file(&data, &bytes, support_temporary("folder"), 9), PTIE_EIO, "directory");
    assert_fails(ptie_write_file(support_temporary("folder"), "x", 1, true), PTIE_EIO, "directory");
    assert_fails(ptie_write_file("/dev/null", "x", 1, true), PTIE_EIO, "device");
    assert_fails(ptie_write_file(support_temporary("no/such"), "x", 1, true), PTIE_EIO, "No such file");
    if (support_exists("/dev/full"))
        assert_fails(ptie_read_file(&data, &bytes, "/dev/full", 1 << 17), PTIE_EFORMAT, "too large");
}

static void one_writer_at_a_time(void **state) {
    (void)state;
    const char *path = support_temporary("shared.txt"), *part = support_temporary("shared.txt.part");
    ptie_output_file first, second;
    support_write(part, "left by a crash", 15);
    assert_ok(ptie_output_open(&first, path, false));
    assert_fails(ptie_output_open(&second, path, false), PTIE_EIO, "shared.txt: is being written by someone else");
    assert_null(second.path);
    ptie_output_discard(&second);
    FILE *stream;
    assert_ok(ptie_output_stream(&first, &stream));
    fputs("abc", stream);
    assert_ok(ptie_close_written(stream, path));
    assert_fails(ptie_write_file(path, "def", 3, true), PTIE_EIO, "is being written by someone else");
    assert_ok(ptie_output_commit(&first));
    size_t bytes;
    unsigned char *data = support_read(path, &bytes);
    assert_int_equal(bytes, 3);
    assert_memory_equal(data, "abc", 3);
    free(data);
    assert_ok(ptie_write_file(path, "def", 3, true));
    assert_ok(ptie_output_open(&first, path, true));
    ptie_output_unlock(&first);
    assert_ok(ptie_write_file(path, "ghi", 3, true));
    ptie_output_discard(&first);
    assert_true(support_exists(path));
}

static void allocation_refuses_products_that_overflow(void **state) {
    (void)state;
    assert_null(ptie_alloc(SIZE_MAX / 2, 4));
    unsigned char *p = ptie_alloc(100, 1);
    assert_int_equal((uintptr_t)p % PTIE_ALIGNMENT, 0);
    for (int i = 0; i < 100; i++) assert_int_equal(p[i], 0);
    ptie_free(p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(philox_matches_random123),
        cmocka_unit_test(normals_have_unit_moments),
        cmocka_unit_test(pool_runs_every_index_and_reports_the_lowest_failure),
        cmocka_unit_test(quantities_need_their_unit),
        cmocka_unit_test(quantities_print_as_people_write_them),
        cmocka_unit_test(ini_reads_and_prints_a_table),
        cmocka_unit_test(ini_says_line_key_and_nearest_name),
        cmocka_unit_test(ini_lines_may_be_indented_and_long),
        cmocka_unit_test(output_appears_whole_or_not_at_all),
        cmocka_unit_test(one_writer_at_a_time),
        cmocka_unit_test(allocation_refuses_products_that_overflow),
    };
    return cmocka_run_group_tests_name("base", tests, NULL, NULL);
}
